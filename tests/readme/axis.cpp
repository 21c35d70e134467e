// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#include "axis.hpp"

// The comments in a column, as in README.md.
// clang-format off
#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

struct MyMotor {                                            // 12 ohm of copper, 18 J/K, 50 mW/K to the air
  typedef tp::CurrentModel<tp::OhmicCurrent<>> Current;
  typedef tp::ThermalModel<tp::HeatCapacityHeating<>, tp::NewtonCooling<>> Thermal;
  static Current::Config current() { return {12.0f, 0.00393f, 20.0f}; }
  static tp::SupplyRange supply() { return {11.0f, 13.0f}; }
  static tp::AirRange air() { return {0.0f, 40.0f}; }       // one thermometer may lie: the warmest counts
  static tp::StepTime step_time() { return {0.005f}; }      // no step is shorter: a time in a wrong unit is a fault
  static Thermal::Config thermal() { return {{18.0f}, {0.05f}}; }
};
typedef tp::AxisController<MyMotor> Axis;
Axis axis(Axis::Config::with_gain({24.0f, 4.0f}));          // P at no power and at full power

void control_cycle(float error_deg, float supply_V, float air_C, float dt_s) {
  const Axis::State& now = axis.step({error_deg, supply_V, air_C, tp::LimitReason::none}, dt_s);
  set_motor(now.power, now.p_gain);                         // now.reason: why not more; now.motor_C: how warm
}
// clang-format on
