// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Problem:  a robot joint overheats its winding in lifts that its housing's thermistor does not notice in time.
// Model:    two nodes (winding 120 J/K, housing 900 J/K), heat I^2 R(T); the thermistor corrects the housing's temperature.
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
        thermal_({120.0f, 900.0f, 1.9f, {0.8f}}, 25.0f),
        limiter_({110.0f, 20.0f, 60.0f}) {}

  /// @return the share of the wanted torque that the winding can bear, in counts, and why
  tp::LimitedPower step(float current_A, float thermistor_C, float air_C, float dt_s) {
    const float heat_W = current_A * current_A * copper_.resistance_at(thermal_.state().winding_C);
    thermal_.step({heat_W, 0.0f, {air_C, 0.0f}}, dt_s);
    // The housing is measured: the winding keeps its modelled rise above it. A broken wire reads NaN, which the limiter takes as hot.
    const float rise_K = thermal_.state().winding_C - thermal_.state().body_C;
    const float rate_K_per_s = thermal_.hottest_rate_K_per_s();
    thermal_.start(thermistor_C + rise_K, thermistor_C);
    return limiter_.step({255, thermal_.hottest_C(), rate_K_per_s}, dt_s);
  }
  float winding_C() const { return thermal_.hottest_C(); }

private:
  tp::OhmicCurrent<> copper_;
  tp::TwoNodeThermalModel<> thermal_;
  tp::SafetyLimiter<> limiter_;
};
//! [joint]

int main() {
  JointGuard guard;
  float share = 1.0f, housing_C = 25.0f;
  printf("  time  housing  winding  torque  reason\n");
  for (int second = 0; second <= 300; ++second) {
    const bool is_broken = second > 270;
    const tp::LimitedPower granted = guard.step(22.0f * share, is_broken ? NAN : housing_C, 25.0f, 1.0f);
    share = static_cast<float>(granted.power) / 255.0f;
    housing_C += 0.002f * (guard.winding_C() - housing_C);  // stands in for the real housing
    if (second % 30 == 0) {
      printf("%4d s %6.1f C %6.1f C %5.0f %%  %d\n", second, static_cast<double>(housing_C),
             static_cast<double>(guard.winding_C()), static_cast<double>(100.0f * share),
             static_cast<int>(granted.reason));
    }
    if (is_broken)
      return granted.reason == tp::LimitReason::temperature_not_finite && granted.power == tp::least_power()
                 ? 0
                 : 1;
    if (guard.winding_C() > 112.0f) return 1;
  }
  return 1;
}
