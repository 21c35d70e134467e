// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/motors/bgm2606_90t.hpp>
#include <thermopower/motors/bgm5208_200_12.hpp>
#include <thermopower/simulation/rig_run.hpp>

/// @file rig_policies.hpp
/// The controllers that are compared on the rig: the very types that firmware runs.

namespace thermopower::simulation {

/// Auto-tuned P gains of the thesis, section 4.2: roll, pitch, yaw.
inline GainConfig thesis_gain(std::size_t axis) noexcept {
  constexpr float low[3] = {24.0f, 180.0f, 40.0f}, high[3] = {4.0f, 105.0f, 2.0f};
  GainConfig config = {low[axis], high[axis]};
  return config;
}

/// POWER of standard operation in section 5.3: 7.7 V of 13 V, which a motor bears for ever.
constexpr std::uint8_t standard_power = 89;

/// Constant power as in section 5.3, gains by eq 4.27.
inline ConstantPower constant_power(std::uint8_t power = standard_power) noexcept {
  return ConstantPower({power, power, power},
                       {RoundedGain::gain(power, thesis_gain(0)), RoundedGain::gain(power, thesis_gain(1)),
                        RoundedGain::gain(power, thesis_gain(2))});
}

/// An axis as the thesis's program has it.
template <class Motor>
using ThesisAxis = AxisController<typename Motor::AsProgrammed, StepPowerLaw<ProgrammedLevels>,
                                  SafetyLimiter<PerCycle>, GainScheduler<TruncatedGain>>;
/// The gimbal as the thesis's program has it.
using ThesisGimbal = GimbalController<ThesisAxis<motors::Bgm2606_90t>, ThesisAxis<motors::Bgm2606_90t>,
                                      ThesisAxis<motors::Bgm5208_200_12>>;

/// An axis with the corrected constants and the library's standard policies.
template <class Motor>
using CorrectedAxis = AxisController<Motor>;
/// The gimbal with these.
using CorrectedGimbal =
    GimbalController<CorrectedAxis<motors::Bgm2606_90t>, CorrectedAxis<motors::Bgm2606_90t>,
                     CorrectedAxis<motors::Bgm5208_200_12>>;

/// A gimbal of these axes with the thesis's gains and every policy's standard.
template <class Gimbal, class Small, class Large>
Gimbal gimbal_with_thesis_gains() {
  return Gimbal(GimbalConfig::believing(), Small::Config::with_gain(thesis_gain(0)),
                Small::Config::with_gain(thesis_gain(1)), Large::Config::with_gain(thesis_gain(2)));
}

/// The thesis's controller.
inline ThesisGimbal thesis_gimbal() {
  return gimbal_with_thesis_gains<ThesisGimbal, ThesisAxis<motors::Bgm2606_90t>,
                                  ThesisAxis<motors::Bgm5208_200_12>>();
}
/// The corrected controller.
inline CorrectedGimbal corrected_gimbal() {
  return gimbal_with_thesis_gains<CorrectedGimbal, CorrectedAxis<motors::Bgm2606_90t>,
                                  CorrectedAxis<motors::Bgm5208_200_12>>();
}

}  // namespace thermopower::simulation
