// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/thermopower.hpp>

#include "report.hpp"

/// Input vectors for what the actuator does. Bounds are what single precision with another library's pow, exp
/// and sqrt may cost.
namespace on_target {

template <class Current>
void run_current(Report& report, const typename Current::Config& config) {
  const Current model(config);
  for (uint8_t power = 0; power < 250; power = static_cast<uint8_t>(power + 7)) {
    for (int16_t motor_C = -20; motor_C <= 80; motor_C = static_cast<int16_t>(motor_C + 25)) {
      const typename Current::State drawn =
          model.at_power(static_cast<float>(power), 13.0f, static_cast<float>(motor_C));
      report.real(drawn.v_rms_V, 2e-6f);
      report.real(drawn.current_A, 5e-6f);
      report.real(drawn.winding_power_W, 5e-5f);
    }
  }
}

template <class Motor>
void run_heating(Report& report) {
  for (int16_t tenth_V = 0; tenth_V <= 130; tenth_V = static_cast<int16_t>(tenth_V + 13))
    for (int16_t motor_C = 20; motor_C <= 80; motor_C = static_cast<int16_t>(motor_C + 15)) {
      const float rise =
          Motor::heating_law().rise_K_per_J(static_cast<float>(tenth_V) * 0.1f, static_cast<float>(motor_C));
      report.real(rise, 1e-5f * rise);
    }
}

template <class Cooling>
void run_cooling(Report& report, const Cooling& law) {
  for (int16_t motor_C = -10; motor_C <= 90; motor_C = static_cast<int16_t>(motor_C + 10)) {
    const thermopower::Surroundings<float> around = {25.0f, static_cast<float>(motor_C + 10) * 0.1f};
    const float rate = law.rate_K_per_s(static_cast<float>(motor_C), around, 0.03f);
    report.real(rate, 1e-6f + 2e-6f * (rate < 0 ? -rate : rate));
  }
}

template <class Thermal>
void run_thermal(Report& report, const typename Thermal::Config& config, float bound_K) {
  Thermal model(config, 25.0f);
  for (uint16_t step = 0; step < 200; ++step) {
    const float v_rms_V = static_cast<float>(step % 13u);
    const typename Thermal::Inputs inputs = {
        0.8f * v_rms_V, v_rms_V, {20.0f + static_cast<float>(step % 7u), 1.0f}};
    model.step(inputs, 0.02f * static_cast<float>(1u + step % 5u));
    report.real(model.hottest_C(), bound_K);
    report.real(model.hottest_rate_K_per_s(), bound_K);
  }
}

template <class Motor>
void run_current(Report& report) {
  run_current<typename Motor::Current>(report, Motor::current());
}

// A section for each law, so that bits.sh says which answers alike on every machine.
inline void run_actuator(Report& report) {
  namespace tp = thermopower;
  namespace motors = thermopower::motors;
  report.section("`OhmicCurrent`");
  const tp::OhmicCurrent<> copper = {8.7f, 0.00393f, 20.0f};
  run_current<tp::CurrentModel<tp::OhmicCurrent<> > >(report, copper);
  report.section("`ThesisCurrent`");
  run_current<motors::Bgm2606_90t>(report);
  run_current<motors::Bgm2606_90t::AsProgrammed>(report);
  run_current<motors::Bgm5208_200_12>(report);
  run_current<motors::Bgm5208_200_12::AsProgrammed>(report);
  report.section("`ThesisHeating`");
  run_heating<motors::Bgm2606_90t>(report);
  run_heating<motors::Bgm2606_90t::AsProgrammed>(report);
  run_heating<motors::Bgm5208_200_12>(report);
  run_heating<motors::Bgm5208_200_12::AsProgrammed>(report);
  report.section("`NewtonCooling`, `RateCooling`");
  const tp::NewtonCooling<> newton = {0.05f};
  run_cooling(report, newton);
  run_cooling(report, tp::RateCooling<>::per_minute(0.11f));
  report.section("`RadiationCooling`");
  const tp::RadiationCooling<> black = {0.01f, 0.9f};
  run_cooling(report, black);
  report.section("`NaturalConvection`");
  const tp::NaturalConvection<> plate = {0.05f, 0.25f, 20.0f};
  run_cooling(report, plate);
  report.section("`EulerStep`");
  run_thermal<motors::Bgm2606_90t::AsProgrammed::Thermal>(
      report, motors::Bgm2606_90t::AsProgrammed::thermal(), 2e-4f);
  report.section("`LinearizedStep`");
  run_thermal<motors::Bgm5208_200_12::Thermal>(report, motors::Bgm5208_200_12::thermal(), 2e-4f);
  report.section("`ExactStep`");
  const tp::ThermalModel<>::Config exact = {{30.0f}, {0.05f}};
  run_thermal<tp::ThermalModel<> >(report, exact, 2e-4f);
  report.section("`TwoNodeThermalModel`");
  const tp::TwoNodeThermalModel<>::Config two = {6.0f, 40.0f, 0.4f, {0.05f}};
  run_thermal<tp::TwoNodeThermalModel<> >(report, two, 2e-4f);
}

}  // namespace on_target
