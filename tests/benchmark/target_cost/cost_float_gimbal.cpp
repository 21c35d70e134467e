// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The cost of a gimbal in floating point: alone, because on the smallest target its RAM is a third of all.
#include "cost.hpp"

using namespace cost;

template <class Motor>
using AxisOf = tp::AxisController<Motor, tp::StepPowerLaw<>, tp::SafetyLimiter<tp::PerCycle>,
                                  tp::GainScheduler<tp::TruncatedGain> >;
typedef AxisOf<Small> Axis;

extern "C" void float_gimbal_step() {
  static tp::GimbalController<Axis, Axis, AxisOf<Large> > gimbal(
      tp::GimbalConfig::standard(), Axis::Config::with_gain({24.0f, 4.0f}),
      Axis::Config::with_gain({180.0f, 105.0f}), AxisOf<Large>::Config::with_gain({40.0f, 2.0f}));
  const Telemetry telemetry = Telemetry();
  small_sink = gimbal.step(telemetry, given.elapsed_s).power[2];
}

extern "C" void measure_all() { thermopower_cost(float_gimbal_step); }
