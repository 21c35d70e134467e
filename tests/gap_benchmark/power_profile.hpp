// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "random.hpp"

namespace gap_benchmark {

/// How somebody exercises a motor on the bench. Every kind keeps an eye on the temperature, as one would:
/// above the limit the power goes off until it has cooled by 10 K.
class PowerProfile {
public:
  enum class Kind { staircase, steps, prbs, cycles, chirp, multisine, thermostat };

  static Kind any(Random& random) {
    return random.pick({Kind::staircase, Kind::steps, Kind::steps, Kind::prbs, Kind::cycles, Kind::chirp,
                        Kind::multisine, Kind::thermostat});
  }

  static const char* name(Kind kind) {
    static const char* const names[] = {"staircase",
                                        "steps",
                                        "prbs",
                                        "cycles with rests",
                                        "chirp",
                                        "multisine",
                                        "closed loop on temperature"};
    return names[static_cast<int>(kind)];
  }

  PowerProfile(Kind kind, double time_constant_s, double top, double limit_C, Random& random)
      : kind_(kind),
        tau_s_(time_constant_s),
        top_(top),
        limit_C_(limit_C),
        phase_(random.uniform(0.0, 6.28)) {
    for (auto& period : periods_s_) period = tau_s_ * random.log_uniform(0.15, 3.0);
    for (auto& phase : phases_) phase = random.uniform(0.0, 6.28);
    setpoint_C_ = limit_C_ - random.uniform(8.0, 25.0);
    low_ = std::round(top_ * random.uniform(0.0, 0.3));
    high_ = std::round(top_ * random.uniform(0.7, 1.0));
  }

  double next(Random& random, double t_s, double motor_C) {
    if (motor_C > limit_C_) resting_ = true;
    if (resting_ && motor_C < limit_C_ - 10.0) resting_ = false;
    const double wanted = wish(random, t_s, motor_C);
    return resting_ ? 0.0 : std::clamp(std::round(wanted), 0.0, 255.0);
  }

private:
  Kind kind_;
  double tau_s_, top_, limit_C_, phase_;
  double periods_s_[4] = {}, phases_[4] = {};
  double setpoint_C_ = 50.0, low_ = 0.0, high_ = 255.0;
  double level_ = 0.0, until_s_ = -1.0, integral_ = 0.3, next_control_s_ = -1.0;
  bool resting_ = false, high_now_ = false;

  double step_level(Random& random) const { return std::min(top_, 25.0 * random.integer(0, 10)); }

  double wish(Random& random, double t_s, double motor_C) {
    switch (kind_) {
      case Kind::staircase:
        if (t_s >= until_s_) {
          level_ = level_ + 25.0 * random.integer(1, 3) > top_ || random.chance(0.15)
                       ? 25.0 * random.integer(0, 2)
                       : level_ + 25.0 * random.integer(1, 3);
          until_s_ = t_s + tau_s_ * random.uniform(0.3, 0.9);
        }
        return std::min(level_, top_);
      case Kind::steps:
        if (t_s >= until_s_) {
          level_ = random.chance(0.2) ? random.pick({0.0, 1.0}) : step_level(random);
          until_s_ = t_s + tau_s_ * random.log_uniform(0.08, 1.2);
        }
        return level_;
      case Kind::prbs:
        if (t_s >= until_s_) {
          high_now_ = random.chance(0.5);
          until_s_ = t_s + 0.18 * tau_s_;
        }
        return high_now_ ? high_ : low_;
      case Kind::cycles:
        if (t_s >= until_s_) {
          high_now_ = !high_now_;
          level_ = high_now_ ? std::max(50.0, step_level(random)) : random.pick({0.0, 1.0});
          until_s_ = t_s + tau_s_ * (high_now_ ? random.uniform(0.25, 0.9) : random.uniform(0.2, 0.8));
        }
        return std::min(level_, top_);
      case Kind::chirp: {
        // The period falls from 3 time constants to 0.2, over and over.
        const double span_s = 6.0 * tau_s_, x = std::fmod(t_s, span_s) / span_s, ratio = std::log(15.0);
        const double angle =
            6.283185307 * span_s / (3.0 * tau_s_) * (std::exp(ratio * x) - 1.0) / ratio + phase_;
        return 0.5 * top_ * (1.0 + std::sin(angle));
      }
      case Kind::multisine: {
        double sum = 0.0;
        for (int i = 0; i < 4; ++i) sum += std::sin(6.283185307 * t_s / periods_s_[i] + phases_[i]);
        return top_ * std::clamp(0.5 + 0.28 * sum, 0.0, 1.0);
      }
      case Kind::thermostat:
        if (t_s >= until_s_) {
          setpoint_C_ = limit_C_ - random.uniform(6.0, 32.0);
          until_s_ = t_s + tau_s_ * random.uniform(0.8, 2.0);
        }
        if (t_s >= next_control_s_) {  // a PI controller, once in a while
          next_control_s_ = t_s + 0.02 * tau_s_;
          const double error = setpoint_C_ - motor_C;
          integral_ = std::clamp(integral_ + 0.0006 * error, 0.0, 1.0);
          level_ = top_ * std::clamp(integral_ + 0.06 * error, 0.0, 1.0);
        }
        return level_;
    }
    return 0.0;
  }
};

}  // namespace gap_benchmark
