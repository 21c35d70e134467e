// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/thermopower.hpp>

#include "report.hpp"

/// Input vectors for what is done about the actuator: powers, gains, ceilings and reasons are the same
/// everywhere, to the count.
namespace on_target {

template <class Rule>
void run_power_law(Report& report) {
  thermopower::StepPowerLaw<Rule> law;
  // Rises and falls, off every level's edge by more than rounding.
  for (int16_t step = 0; step < 80; ++step)
    report.integer(law.step(0.017f + 0.037f * static_cast<float>(step < 40 ? step : 79 - step)));
  report.integer(law.step(-0.55f));
  report.integer(law.step(1e9f));
  report.integer(law.step(thermopower::detail::not_a_number()));
}

template <class Rule>
void run_gain(Report& report) {
  const thermopower::GainConfig config = {180.0f, 105.0f};
  const thermopower::GainScheduler<Rule> gain(config);
  for (uint16_t power = 0; power < 256; power = static_cast<uint16_t>(power + 5))
    report.integer(gain.step(static_cast<uint8_t>(power)));
}

template <class Rule>
void run_limiter(Report& report) {
  thermopower::SafetyLimiter<Rule> limiter;
  for (uint16_t step = 0; step < 200; ++step) {
    const float motor_C = step < 100 ? 30.0f + 0.31f * static_cast<float>(step)
                                     : 61.0f - 0.17f * static_cast<float>(step - 100);
    const typename thermopower::SafetyLimiter<Rule>::Inputs inputs = {
        static_cast<uint8_t>(25 * (1 + step % 10u)), thermopower::GuardedCelsius::unchecked(motor_C),
        step < 100 ? 0.52f : -0.03f};
    const thermopower::LimitedPower granted = limiter.step(inputs, 0.016f);
    report.integer(granted.power);
    report.integer(static_cast<uint8_t>(granted.reason));
    report.integer(limiter.ceiling());
  }
}

inline void run_control(Report& report) {
  namespace tp = thermopower;
  report.section("position error");
  for (int32_t units = -32768; units < 32768; units += 1311) {
    report.integer(tp::position_error_units(static_cast<int16_t>(units), 1234));
    report.real(tp::wrap_deg(tp::deg_from_units(static_cast<int16_t>(units)) * 3.7f), 3e-4f);
  }
  report.section("power laws");
  run_power_law<tp::ProgrammedLevels>(report);
  run_power_law<tp::PrintedLevels>(report);
  run_power_law<tp::HysteresisLevels>(report);
  run_power_law<tp::ContinuousPower>(report);
  report.section("gains");
  run_gain<tp::TruncatedGain>(report);
  run_gain<tp::RoundedGain>(report);
  report.section("limiters");
  run_limiter<tp::PerCycle>(report);
  run_limiter<tp::PerSecond>(report);
}

}  // namespace on_target
