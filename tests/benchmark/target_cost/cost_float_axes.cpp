// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The cost of controllers in floating point: apart from the policies, so that the compiler inlines as in a
// firmware.
#include "cost.hpp"

using namespace cost;

template <class Motor>
using AxisOf = tp::AxisController<Motor, tp::StepPowerLaw<>, tp::SafetyLimiter<tp::PerCycle>,
                                  tp::GainScheduler<tp::TruncatedGain> >;
typedef AxisOf<Small> Axis;
typedef tp::AxisController<tp::motors::Bgm2606_90t, tp::StepPowerLaw<tp::HysteresisLevels> > Corrected;

static Axis& axis() {
  static Axis controller(Axis::Config::with_gain({24.0f, 4.0f}));
  return controller;
}
static Corrected& corrected() {
  static Corrected controller(Corrected::Config::with_gain({24.0f, 4.0f}));
  return controller;
}

extern "C" void float_axis_set() { axis().start(given.warm_C); }
extern "C" void float_axis_step() {
  const Axis::Inputs inputs = {given.error_deg, 13.0f, given.air_C, given.fault};
  small_sink = axis().step(inputs, given.elapsed_s).power;
}
extern "C" void corrected_axis_set() { corrected().start(given.warm_C); }
extern "C" void corrected_axis_step() {
  const Corrected::Inputs inputs = {given.error_deg, 13.0f, given.air_C, given.fault};
  small_sink = corrected().step(inputs, given.elapsed_s).power;
}
extern "C" void measure_all() {
  thermopower_cost_after(float_axis_step, float_axis_set);
  thermopower_cost_after(corrected_axis_step, corrected_axis_set);
}
