// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Problem:  a heated plate must reach 55 degC quickly; its element, buried and without a sensor, must stay below 150 degC.
// Model:    element 40 J/K and plate 600 J/K, 2.2 W/K between them, 1.1 W/K to the air; 240 W at full duty.
// Notation: duty in counts of 255; temperatures in degC.
#include <thermopower/thermopower.hpp>

#include <stdio.h>

namespace tp = thermopower;

//! [heater]
class Heater {
public:
  Heater()
      : thermal_({40.0f, 600.0f, 2.2f, {1.1f}}, 20.0f),
        law_({20.0f, 25, 0.0f}),
        limiter_({150.0f, 5.0f, 100.0f}) {}

  tp::LimitedPower step(float target_C, float air_C, float dt_s) {
    const float heat_W = 240.0f * tp::duty_from_power<float>(power_);
    thermal_.step({heat_W, 0.0f, {air_C, 0.0f}}, dt_s);
    const float missing_K = target_C - thermal_.state().body_C;
    const tp::LimitedPower granted = limiter_.step({law_.step(missing_K > 0.0f ? missing_K : 0.0f),
                                                    thermal_.hottest_C(), thermal_.hottest_rate_K_per_s()},
                                                   dt_s);
    power_ = granted.power;
    return granted;
  }
  const tp::TwoNodeThermalModel<>::State& state() const { return thermal_.state(); }

private:
  tp::TwoNodeThermalModel<> thermal_;
  tp::StepPowerLaw<tp::ContinuousPower> law_;
  tp::SafetyLimiter<> limiter_;
  float power_ = tp::least_power();
};
//! [heater]

int main() {
  Heater heater;
  float hottest_C = 0.0f;
  printf("  time   plate  element  power  reason\n");
  for (int second = 0; second <= 900; ++second) {
    const tp::LimitedPower granted = heater.step(55.0f, 20.0f, 1.0f);
    if (heater.state().winding_C > hottest_C) hottest_C = heater.state().winding_C;
    if (second % 60 == 0) {
      printf("%4d s %6.1f C %6.1f C %5d  %d\n", second, static_cast<double>(heater.state().body_C),
             static_cast<double>(heater.state().winding_C), granted.power, static_cast<int>(granted.reason));
    }
  }
  printf("element at most %.1f degC\n", static_cast<double>(hottest_C));
  return hottest_C < 150.5f && heater.state().body_C > 45.0f ? 0 : 1;
}
