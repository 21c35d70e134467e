// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/actuator/current_model.hpp>
#include <thermopower/actuator/ohmic_current.hpp>
#include <thermopower/actuator/thesis_current.hpp>
#include <thermopower/motors/bgm2606_90t.hpp>
#include <thermopower/motors/bgm5208_200_12.hpp>

#include "near.hpp"

#include <limits>

namespace tp = thermopower;

TEST_CASE("a winding follows Ohm's law and gains resistance with temperature") {
  const tp::OhmicCurrent<double> copper = {12.5, 0.00393, 20.0};
  CHECK(copper.current_A(10.0, 20.0) == Near(0.8));
  CHECK(copper.resistance_at(70.0) == Near(12.5 * (1.0 + 0.00393 * 50.0)));
  CHECK(copper.current_A(10.0, 70.0) < copper.current_A(10.0, 20.0));
}

TEST_CASE("a winding's resistance never falls to zero, however cold the reading") {
  const tp::OhmicCurrent<float> law = {10.0f, 0.02f, 25.0f};
  CHECK(law.resistance_at(-273.0f) == Near(1.0));
  CHECK(law.resistance_at(-20.0f) == Near(1.0));
  CHECK(law.resistance_at(0.0f) == Near(5.0));
}

TEST_CASE("the thesis's current law is eq 4.1 to 4.5, in ampere") {
  const auto law = tp::motors::Bgm2606_90t::AsProgrammed::current_law<double>();
  const double volt = 9.97, motor_C = 46.3;
  const double slope = -0.0134 * volt * volt + 0.0156 * volt + 0.0167,
               intercept = 0.1551 * std::pow(volt, 3.4591);
  CHECK(law.slope_A_per_K(volt) == Near(slope / 1000.0));
  CHECK(law.intercept_A(volt) == Near(intercept / 1000.0));
  CHECK(law.current_A(volt, motor_C) == Near((slope * motor_C + intercept) / 1000.0));
}

TEST_CASE("a thesis motor draws nothing at or below one volt, and never a negative current") {
  const auto small = tp::motors::Bgm2606_90t::current_law<double>();
  CHECK(small.current_A(0.0, 40.0) == 0.0);
  CHECK(small.current_A(1.0, 40.0) == 0.0);
  CHECK(small.current_A(5.0, 40.0) > 0.0);
  const auto large = tp::motors::Bgm5208_200_12::current_law<double>();
  CHECK(large.slope_A_per_K(3.0) * 40.0 + large.intercept_A(3.0) < 0.0);
  CHECK(large.current_A(3.0, 40.0) == 0.0);
}

TEST_CASE("a broken voltage or temperature stays visible in the current") {
  const auto law = tp::motors::Bgm2606_90t::current_law<float>();
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              infinity = std::numeric_limits<float>::infinity();
  CHECK(std::isnan(law.current_A(nan, 40.0f)));
  CHECK(std::isnan(law.current_A(8.0f, nan)));
  CHECK_FALSE(std::isfinite(law.current_A(infinity, 40.0f)));
  CHECK(law.current_A(-8.0f, 40.0f) == 0.0f);
  const tp::OhmicCurrent<float> copper = {12.5f, 0.00393f, 20.0f};
  CHECK(std::isnan(copper.current_A(nan, 40.0f)));
  CHECK(std::isnan(copper.current_A(8.0f, nan)));
}

TEST_CASE("the current model reports voltage, current and V_rms I") {
  const tp::CurrentModel<tp::OhmicCurrent<double>> model(tp::OhmicCurrent<double>{10.0, 0.0, 20.0});
  const auto state = model.at_power(63.75, 12.0, 25.0);
  CHECK(state.v_rms_V == Near(6.0));
  CHECK(state.current_A == Near(0.6));
  CHECK(state.winding_power_W == Near(3.6));
  CHECK(model.at_voltage(6.0, 25.0).winding_power_W == Near(3.6));
  CHECK(std::isnan(model.at_power(-1.0, 12.0, 25.0).winding_power_W));
}
