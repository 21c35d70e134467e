// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/thermopower.hpp>

#include "report.hpp"

/// Input vectors for whole gimbal controllers: hot air, faults, a silent link, every reason on the way.
namespace on_target {

template <class Gimbal>
void run_gimbal(Report& report, Gimbal& gimbal) {
  for (uint16_t cycle = 0; cycle < 600; ++cycle) {
    typename Gimbal::Inputs inputs;
    const float swing = static_cast<float>(cycle % 97u) - 48.3f;
    inputs.error_deg[0] = cycle < 400 ? 2.07f : 0.011f * swing;
    inputs.error_deg[1] = 0.0234f * swing;
    inputs.error_deg[2] = 9.13f * swing;
    inputs.camera_C = cycle < 300 ? 38.0f : 45.0f;
    inputs.frame_C = cycle % 50u == 7u ? 0.0f : 39.0f;
    inputs.supply_V = cycle > 500 && cycle < 510 ? 2.0f : 12.6f;
    const typename Gimbal::Command& command =
        cycle % 211u == 200u ? gimbal.step_silent(0.6f) : gimbal.step(inputs, 0.04f);
    for (uint8_t axis = 0; axis < 3; ++axis) {
      report.integer(command.power[axis]);
      report.integer(command.p_gain[axis]);
      report.integer(static_cast<uint8_t>(command.reason[axis]));
    }
    if (cycle % 20u != 0) continue;
    report.real(gimbal.template axis<0>().state().motor_C, 5e-5f);
    report.real(gimbal.template axis<2>().state().motor_C, 5e-5f);
  }
}

// Not inlined, so that the controllers of both take turns in the same memory.
[[gnu::noinline]] inline void run_programmed_gimbal(Report& report) {
  namespace tp = thermopower;
  typedef tp::StepPowerLaw<tp::ProgrammedLevels> PowerLaw;
  typedef tp::SafetyLimiter<tp::PerCycle> Limiter;
  typedef tp::GainScheduler<tp::TruncatedGain> Gain;
  typedef tp::AxisController<tp::motors::Bgm2606_90t::AsProgrammed, PowerLaw, Limiter, Gain> Small;
  typedef tp::AxisController<tp::motors::Bgm5208_200_12::AsProgrammed, PowerLaw, Limiter, Gain> Large;
  report.section("gimbal as programmed");
  tp::GimbalController<Small, Small, Large> gimbal(
      tp::GimbalConfig::standard(), Small::Config::with_gain({24.0f, 4.0f}),
      Small::Config::with_gain({180.0f, 105.0f}), Large::Config::with_gain({40.0f, 2.0f}));
  run_gimbal(report, gimbal);
}

[[gnu::noinline]] inline void run_corrected_gimbal(Report& report) {
  namespace tp = thermopower;
  typedef tp::StepPowerLaw<tp::HysteresisLevels> PowerLaw;
  typedef tp::AxisController<tp::motors::Bgm2606_90t, PowerLaw> Small;
  typedef tp::AxisController<tp::motors::Bgm5208_200_12, PowerLaw> Large;
  report.section("gimbal with the corrected laws");
  tp::GimbalController<Small, Small, Large> gimbal(
      tp::GimbalConfig::standard(), Small::Config::with_gain({24.0f, 4.0f}),
      Small::Config::with_gain({180.0f, 105.0f}), Large::Config::with_gain({40.0f, 2.0f}));
  run_gimbal(report, gimbal);
}

}  // namespace on_target
