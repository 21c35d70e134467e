// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Problem:  how much energy does dynamic power save? The answer depends on which power is meant.
// Model:    E = sum P dt (eq 4.24), P at the winding (V_rms I) or at the supply (V_supply I); saving by eq
//           4.26.
// Notation: a fixed V_rms of 7.7 V against power that alternates between 25 and 250, a tenth of the time at
//           250.
#include <thermopower/thermopower.hpp>

#include <math.h>
#include <stdio.h>

namespace tp = thermopower;

int main() {
  const auto motor = tp::motors::Bgm2606_90t::current_law<float>();
  const float supply_V = 13.0f, motor_C = 45.0f, dt_s = 0.03f;

  //! [meters]
  tp::EnergyMeter<tp::AtWinding> fixed_winding, dynamic_winding;
  tp::EnergyMeter<tp::AtSupply> fixed_supply, dynamic_supply;
  for (int i = 0; i < 120000; ++i) {  // an hour
    const float fixed_V = 7.7f, dynamic_V = tp::v_rms_from_power(supply_V, i % 10 == 0 ? 250.0f : 25.0f);
    fixed_winding.step(fixed_V, supply_V, motor.current_A(fixed_V, motor_C), dt_s);
    fixed_supply.step(fixed_V, supply_V, motor.current_A(fixed_V, motor_C), dt_s);
    dynamic_winding.step(dynamic_V, supply_V, motor.current_A(dynamic_V, motor_C), dt_s);
    dynamic_supply.step(dynamic_V, supply_V, motor.current_A(dynamic_V, motor_C), dt_s);
  }
  const float at_winding = tp::saving_percent(fixed_winding, dynamic_winding);
  const float at_supply = tp::saving_percent(fixed_supply, dynamic_supply);
  // tp::saving_percent(fixed_supply, dynamic_winding) does not compile: it would compare different powers.
  //! [meters]

  printf("              fixed/W   dynamic/W   fixed/J   dynamic/J   saving/%%\n");
  printf("  winding     %7.3f   %9.3f   %7.0f   %9.0f   %8.1f\n",
         static_cast<double>(fixed_winding.average_W()), static_cast<double>(dynamic_winding.average_W()),
         static_cast<double>(fixed_winding.state().energy_J),
         static_cast<double>(dynamic_winding.state().energy_J), static_cast<double>(at_winding));
  printf("  supply      %7.3f   %9.3f   %7.0f   %9.0f   %8.1f\n",
         static_cast<double>(fixed_supply.average_W()), static_cast<double>(dynamic_supply.average_W()),
         static_cast<double>(fixed_supply.state().energy_J),
         static_cast<double>(dynamic_supply.state().energy_J), static_cast<double>(at_supply));
  const bool is_hour = fabsf(fixed_winding.state().time_s - 3600.0f) < 0.01f;
  return is_hour && at_supply > at_winding ? 0 : 1;
}
