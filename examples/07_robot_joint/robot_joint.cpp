// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Problem:  a robot joint overheats its winding in lifts that its housing's thermistor does not notice in time.
// Model:    two nodes (winding 120 J/K, housing 900 J/K), heat I^2 R(T); the thermistor says how warm the housing is, once it is checked.
// Notation: torque limit in counts of 255; temperatures in degC.
#include <thermopower/thermopower.hpp>

#include <math.h>
#include <stdio.h>

namespace tp = thermopower;

//! [joint]
class JointGuard {
public:
  JointGuard()
      : copper_{0.35f, 0.00393f, 25.0f},
        model_({120.0f, 900.0f, 1.9f, {0.8f}}, 25.0f),
        limiter_({110.0f, 20.0f, 60.0f}) {}

  /// @return the share of the wanted torque that the winding can bear, in counts, and why
  tp::LimitedPower step(float current_A, float thermistor_C, float air_C, float dt_s) {
    const float heat_W = current_A * current_A * copper_.resistance_at(model_.state().winding_C);
    model_.step({heat_W, 0.0f, {air_C, 0.0f}}, dt_s);
    // The model runs by itself, so that it can judge the thermistor. A torn, shorted or stuck one has no temperature but a reason, which
    // the limiter answers with the least power.
    const tp::GuardedCelsius housing_C = guard_.step({thermistor_C, model_.state().body_C}, dt_s);
    winding_C_ = housing_C.warmer_by(model_.state().winding_C - model_.state().body_C);
    return limiter_.step({255, winding_C_, model_.hottest_rate_K_per_s()}, dt_s);
  }
  /// NaN while the thermistor is not believed.
  float winding_C() const { return winding_C_; }

private:
  tp::OhmicCurrent<> copper_;
  tp::TwoNodeThermalModel<> model_;
  tp::SensorGuard guard_;  // -20 to 150 degC, at most 20 K colder than the model
  tp::SafetyLimiter<> limiter_;
  tp::GuardedCelsius winding_C_;
};
//! [joint]

int main() {
  JointGuard guard;
  float share = 1.0f, housing_C = 25.0f;
  int broken_s = 0;
  printf("  time  housing  winding  torque  reason\n");
  for (int second = 0; second <= 300; ++second) {
    const bool is_broken = second > 270;
    const tp::LimitedPower granted = guard.step(22.0f * share, is_broken ? NAN : housing_C, 25.0f, 1.0f);
    share = static_cast<float>(granted.power) / 255.0f;
    if (!is_broken)
      housing_C +=
          (1.9f * (guard.winding_C() - housing_C) - 0.8f * (housing_C - 25.0f)) / 900.0f;  // the real housing
    if (second % 30 == 0) {
      printf("%4d s %6.1f C %6.1f C %5.0f %%  %d\n", second, static_cast<double>(housing_C),
             static_cast<double>(guard.winding_C()), static_cast<double>(100.0f * share),
             static_cast<int>(granted.reason));
    }
    if (is_broken) broken_s += 1;
    if (broken_s > 3)  // bridged for two seconds
      return granted.reason == tp::LimitReason::sensor_out_of_range && granted.power == tp::least_power() ? 0
                                                                                                          : 1;
    if (guard.winding_C() > 112.0f) return 1;
  }
  return 1;
}
