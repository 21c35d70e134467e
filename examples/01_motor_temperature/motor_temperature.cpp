// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Problem:  a motor has no thermometer. How warm is it, after five minutes of work and five of rest?
// Model:    C dT/dt = V_rms I(V_rms, T) - G (T - T_air), with I = V_rms / R(T); one node, stepped exactly.
// Notation: P power parameter 0 .. 255 of a motor driver, V_rms = V_supply sqrt(P / 255), T in degC, times in
//           s.
#include <thermopower/thermopower.hpp>

#include <math.h>
#include <stdio.h>

namespace tp = thermopower;

int main() {
  //! [models]
  // A winding of 12 ohm at 20 degC, copper; 18 J/K; 50 mW/K to the air.
  const tp::CurrentModel<tp::OhmicCurrent<> > current({12.0f, 0.00393f, 20.0f});
  tp::ThermalModel<tp::HeatCapacityHeating<>, tp::NewtonCooling<>, tp::ExactStep> motor({{18.0f}, {0.05f}},
                                                                                        25.0f);

  const auto advance = [&](float power_param, float dt_s) {
    const auto drawn = current.at_power(power_param, 13.0f, motor.hottest_C());
    motor.step({drawn.winding_power_W, drawn.v_rms_V, {25.0f, 0.0f}}, dt_s);
    return drawn;
  };
  //! [models]

  if (tp::is_error(current.validate()) || tp::is_error(motor.validate())) return 1;
  printf("  minute   power   V_rms/V   I/mA   P/W    motor/degC\n");
  for (int minute = 0; minute <= 10; ++minute) {
    const float power_param = minute < 5 ? 120.0f : 0.0f;
    const auto drawn = current.at_power(power_param, 13.0f, motor.hottest_C());
    printf("  %6d   %5.0f   %7.2f   %4.0f   %4.2f   %8.1f\n", minute, static_cast<double>(power_param),
           static_cast<double>(drawn.v_rms_V), 1000.0 * static_cast<double>(drawn.current_A),
           static_cast<double>(drawn.winding_power_W), static_cast<double>(motor.hottest_C()));
    for (int second = 0; second < 60; ++second) advance(power_param, 1.0f);
  }

  // The exact step does not mind how long it is: an hour at once ends where the settled state is.
  motor.step({2.0f, 0.0f, {25.0f, 0.0f}}, 36000.0f);
  const float settled_C = 25.0f + 2.0f / 0.05f;
  printf("  2 W for ever: %.1f degC; T_air + P/G = %.1f degC\n", static_cast<double>(motor.hottest_C()),
         static_cast<double>(settled_C));
  return fabsf(motor.hottest_C() - settled_C) < 0.01f ? 0 : 1;
}
