// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The cost of controllers in whole numbers: apart from the policies, so that the compiler inlines as in a
// firmware.
#include "cost.hpp"

using namespace cost;

template <class Motor, class Gain>
using AxisOf =
    fixed::AxisController<fixed::ThermalModel<fixed::ThesisMotor<Motor> >, fixed::ProgrammedLevels<>,
                          fixed::SafetyLimiter<fixed::ThesisLimit, fixed::PerCycle>, Gain>;
typedef AxisOf<Small, fixed::TruncatedGain<24, 4> > Axis;
typedef fixed::GimbalController<Axis, AxisOf<Small, fixed::TruncatedGain<180, 105> >,
                                AxisOf<Large, fixed::TruncatedGain<40, 2> > >
    Gimbal;

static Axis& axis() {
  static Axis controller;
  return controller;
}
static Gimbal& gimbal() {
  static Gimbal controller;
  return controller;
}

extern "C" void fixed_axis_set() { axis().start(static_cast<fixed::Temperature>(given.warm) * 65536); }
extern "C" void fixed_axis_step() {
  const fixed::AxisInputs inputs = {given.error_units, given.air, given.fault};
  axis().step(inputs, given.ticks);
  small_sink = axis().p_gain();
}
extern "C" void fixed_axis_whole() {
  fixed_axis_step();
  axis().prepare();
}
// Every level of the power law at every temperature at which it is granted.
static void search_axis(uint16_t round) {
  const uint32_t at = static_cast<uint32_t>(round) * (47u * 14080u / counter::searches + 1u);
  given.error_units = static_cast<uint16_t>(at % 47u);
  given.warm = static_cast<fixed::CoarseTemperature>(-6400 + static_cast<int16_t>(at % 14080u));
  given.air = static_cast<fixed::CoarseTemperature>(given.warm - 128);
  given.fault = tp::LimitReason::none;
  given.ticks = 0;
}
extern "C" void fixed_gimbal_step() {
  const Telemetry telemetry = Telemetry();
  small_sink = gimbal().step(telemetry, given.ticks).power[2];
}
extern "C" void fixed_gimbal_prepare() { gimbal().prepare(); }
extern "C" void fixed_gimbal_silent() { small_sink = gimbal().step_silent(given.ticks).power[2]; }
extern "C" void fixed_gimbal_whole() {
  fixed_gimbal_step();
  gimbal().prepare();
}

// From a state and an input, a step takes as long after a thousand others as it took before them.
static Gimbal before;
extern "C" void remember() {
  fixed_gimbal_whole();
  before = gimbal();
}
extern "C" void restore() { gimbal() = before; }
extern "C" void live() {
  const Given now = given;
  for (uint16_t round = 0; round < 1000; ++round) {
    give(round & 127u);
    fixed_gimbal_whole();
  }
  given = now;
}
static void same_after_a_thousand() {
  for (uint16_t round = 0; round < 8; ++round) {
    give(static_cast<uint16_t>(60 + round));
    remember();
    const uint32_t first = counter::once(fixed_gimbal_whole, restore);
    live();
    const uint32_t second = counter::once(fixed_gimbal_whole, restore);
    const uint32_t difference = first > second ? first - second : second - first;
    if (difference > counter::resolution)
      cost::row("time_depends_on_history", fixed_gimbal_whole, cost_nothing);
  }
}

extern "C" void measure_all() {
  thermopower_cost_after(fixed_axis_step, fixed_axis_set);
  thermopower_cost_searched(fixed_axis_whole, fixed_axis_set, search_axis, counter::searches);
  thermopower_cost_after(fixed_gimbal_step, fixed_gimbal_prepare);
  thermopower_cost_after(fixed_gimbal_prepare, fixed_gimbal_step);
  thermopower_cost(fixed_gimbal_whole);
  thermopower_cost_after(fixed_gimbal_silent, fixed_gimbal_prepare);
  same_after_a_thousand();
}
