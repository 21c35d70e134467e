// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <stdint.h>

/// What people write against heat before they look for a library: compared with it in tests/monitor/protection_comparison.cpp,
/// and weighed on the chips here.
namespace rivals {

/// Eight lines of a model: one node, cut above the limit, back five kelvins below.
class EightLineModel {
public:
  EightLineModel(float heat_capacity_J_per_K, float conductance_W_per_K, float limit_C, float air_C)
      : capacity_(heat_capacity_J_per_K),
        conductance_(conductance_W_per_K),
        limit_(limit_C),
        air_(air_C),
        motor_(air_C) {}
  uint8_t step(float heat_W, uint8_t demand, float dt_s) {
    motor_ += dt_s * (heat_W - conductance_ * (motor_ - air_)) / capacity_;
    if (motor_ > limit_) is_cut_ = true;
    if (motor_ < limit_ - 5.0f) is_cut_ = false;
    return is_cut_ ? uint8_t(1) : demand;
  }

private:
  float capacity_, conductance_, limit_, air_, motor_;
  bool is_cut_ = false;
};

/// A thermistor, and power that falls in a straight line between two of its temperatures.
class LinearDerating {
public:
  LinearDerating(float from_C, float to_C) : to_(to_C), per_K_(255.0f / (to_C - from_C)) {}
  uint8_t step(float thermistor_C, uint8_t demand) const {
    const float most = (to_ - thermistor_C) * per_K_;
    if (!(most > 1.0f)) return 1;
    return most >= static_cast<float>(demand) ? demand : static_cast<uint8_t>(most);
  }

private:
  float to_, per_K_;
};

/// The square of the current above its continuous value, over time.
class CurrentSquareOverTime {
public:
  CurrentSquareOverTime(float continuous_A2, float peak_s)
      : continuous_(continuous_A2), most_(continuous_A2 * peak_s) {}
  uint8_t step(float current_A, uint8_t demand, float dt_s) {
    sum_ += dt_s * (current_A * current_A - continuous_);
    if (sum_ < 0.0f) sum_ = 0.0f;
    if (sum_ >= most_) is_limited_ = true;
    if (sum_ <= 0.0f) is_limited_ = false;
    return is_limited_ && demand > 1 ? uint8_t(1) : demand;
  }

private:
  float continuous_, most_, sum_ = 0.0f;
  bool is_limited_ = false;
};

}  // namespace rivals
