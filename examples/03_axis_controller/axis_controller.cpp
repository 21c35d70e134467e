// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Problem:  keep a motor of one's own below 60 degC without a thermometer, and give it all the power it can
//           bear.
// Model:    temperature estimate -> power law -> limiter (eq 4.23) -> gain (eq 4.27), once a cycle.
// Notation: error in degrees, temperatures in degC, power parameter 0 .. 255.
#include <thermopower/thermopower.hpp>

#include <stdio.h>

namespace tp = thermopower;

//! [motor]
struct MyMotor {
  typedef tp::CurrentModel<tp::OhmicCurrent<> > Current;
  typedef tp::ThermalModel<tp::HeatCapacityHeating<>, tp::NewtonCooling<> > Thermal;
  static Current::Config current() { return {12.0f, 0.00393f, 20.0f}; }  // 12 ohm at 20 degC, copper
  static tp::SupplyRange supply() { return {11.0f, 13.0f}; }
  static Thermal::Config thermal() { return {{18.0f}, {0.05f}}; }  // 18 J/K, 0.05 W/K to the air
};
//! [motor]

int main() {
  //! [axis]
  typedef tp::AxisController<MyMotor> Axis;
  Axis axis(Axis::Config::with_gain({24.0f, 4.0f}));  // P at the least and at full power
  if (tp::is_error(axis.validate())) return 1;        // names the first wrong field

  const auto cycle = [&](float error_deg, float supply_V, float air_C, float dt_s) {
    const Axis::State& state = axis.step({error_deg, supply_V, air_C, tp::LimitReason::none}, dt_s);
    return state.power;  // send state.power and state.p_gain; log state.reason
  };
  //! [axis]

  printf("  minute   motor/degC   demand   power   P gain   reason\n");
  float hottest_C = 0.0f;
  for (int i = 0; i <= 10 * 60 * 33; ++i) {
    cycle(i < 6 * 60 * 33 ? 2.0f : 0.1f, 13.0f, 25.0f, 1.0f / 33.0f);
    const Axis::State& state = axis.state();
    if (state.motor_C > hottest_C) hottest_C = state.motor_C;
    if (i % (60 * 33) == 0)
      printf("  %6d   %10.1f   %6d   %5d   %6d   %d\n", i / (60 * 33), static_cast<double>(state.motor_C),
             state.demand, state.power, state.p_gain, static_cast<int>(state.reason));
  }
  printf("  hottest: %.2f degC\n", static_cast<double>(hottest_C));
  return hottest_C < 60.1f ? 0 : 1;
}
