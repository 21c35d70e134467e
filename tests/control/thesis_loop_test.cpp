// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/actuator/energy_meter.hpp>
#include <thermopower/control/axis_controller.hpp>

#include "../actuator/thesis.hpp"

namespace tp = thermopower;
using namespace thesis;
using tp::LimitReason;

namespace {
template <class Motor, class Rule>
using ThesisAxis = tp::AxisController<Motor, tp::StepPowerLaw<>, tp::SafetyLimiter<Rule>,
                                      tp::GainScheduler<tp::TruncatedGain>>;

/// Temperatures each minute of an axis that asks for one power level all the time, limited as in section 4.2.
template <class Motor, class Rule>
std::vector<double> protect(int power_param, double start_C, double dt_s, double air_C = 26.0) {
  using Axis = ThesisAxis<Motor, Rule>;
  Axis axis(Axis::Config::with_gain({24.0f, 4.0f}));
  axis.start(static_cast<float>(start_C));
  // The middle of the level whose power this is.
  const float error_deg = (static_cast<float>(power_param / 25) + 0.5f) / 10.0f;
  std::vector<double> temperatures = {start_C};
  for (int minute = 0; minute < 5; ++minute) {
    for (int i = 0; i < static_cast<int>(60.0 / dt_s + 0.5); ++i)
      axis.step({error_deg, 13.0f, static_cast<float>(air_C), LimitReason::none}, static_cast<float>(dt_s));
    REQUIRE(axis.state().demand == power_param);
    temperatures.push_back(static_cast<double>(axis.state().motor_C));
  }
  return temperatures;
}
}  // namespace

TEST_CASE("Table 5.4: the protected BGM2606 warms as calculated, in a closed loop of 30 ms cycles") {
  const Table source = table("5_4");
  for (const auto& [power_param, tolerance_K] :
       {std::pair(150, 0.3), std::pair(200, 0.1), std::pair(250, 0.1)}) {
    std::vector<double> calculated, measured;
    for (size_t i = 0; i < source.rows(); ++i) {
      if (static_cast<int>(source.number(i, "power_param")) != power_param) continue;
      calculated.push_back(source.number(i, "T_calculated_C"));
      measured.push_back(source.number(i, "T_measured_C"));
    }
    REQUIRE(calculated.size() == 6);
    const auto model =
        protect<tp::motors::Bgm2606_90t::AsProgrammed, tp::PerCycle>(power_param, calculated[0], 0.03);
    for (size_t minute = 3; minute <= 5; ++minute) {
      CAPTURE(power_param, minute, model[minute]);
      // The printed figure is rounded to 0.1, so that much again cannot be told apart.
      CHECK(std::abs(model[minute] - calculated[minute]) <= tolerance_K + 0.05);
    }
    // What the protection is for: the motor itself stayed below 60 degC.
    for (const double motor_C : measured) CHECK(motor_C < 60.0);
    for (const double motor_C : model) CHECK(motor_C < 60.05);
  }
}

TEST_CASE("the corrected motor, limited per second, is kept below 60 degC at any loop rate") {
  for (const double dt_s : {0.005, 0.01, 0.03, 0.1}) {
    const auto model = protect<tp::motors::Bgm2606_90t, tp::PerSecond>(250, 33.0, dt_s);
    CAPTURE(dt_s);
    CHECK(model[5] == Near(60.0).margin(0.3));
    for (const double motor_C : model) CHECK(motor_C < 60.05);
  }
}

TEST_CASE("like for like, the published savings of 22.2 and 61.1 % are other figures") {
  const auto law = tp::motors::Bgm2606_90t::AsProgrammed::current_law<double>();
  const double current_A = law.current_A(7.7, 60.0);
  // As published: the fixed power at the supply, 1.8 W, against the dynamic runs' V_rms I, 1.4 and 0.7 W.
  CHECK(tp::difference_percent(1.8, 1.4) == Near(22.2).margin(0.05));
  CHECK(tp::difference_percent(1.8, 0.7) == Near(61.1).margin(0.05));

  // In V_rms I both times.
  tp::EnergyMeter<tp::AtWinding, double> fixed, roll, pitch;
  fixed.step(7.7, 13.0, current_A, 60.0);
  roll.step(1.0, 13.0, 1.4, 60.0);
  pitch.step(1.0, 13.0, 0.7, 60.0);
  CHECK(tp::saving_percent(fixed, roll) == Near(-29.0).margin(0.5));
  CHECK(tp::saving_percent(fixed, pitch) == Near(36.0).margin(0.5));

  // At the supply both times, if the dynamic runs alternated between power 25 and 250 (the logs are not in
  // the text).
  const double low_V = tp::v_rms_from_power(13.0, 25.0), high_V = tp::v_rms_from_power(13.0, 250.0),
               motor_C = 26.0;
  const double low_A = law.current_A(low_V, motor_C), high_A = law.current_A(high_V, motor_C);
  for (const auto& [winding_W, saving] : {std::pair(1.4, 16.0), std::pair(0.7, 54.0)}) {
    const double share = (winding_W - low_V * low_A) / (high_V * high_A - low_V * low_A);
    tp::EnergyMeter<tp::AtSupply, double> constant, alternating;
    constant.step(7.7, 13.0, current_A, 60.0);
    alternating.step(low_V, 13.0, low_A, 60.0 * (1.0 - share));
    alternating.step(high_V, 13.0, high_A, 60.0 * share);
    CHECK(tp::saving_percent(constant, alternating) == Near(saving).margin(0.5));
  }
}
