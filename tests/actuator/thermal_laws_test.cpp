// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "near.hpp"
#include "samples.hpp"

#include <limits>
#include <random>

namespace tp = thermopower;

TEMPLATE_LIST_TEST_CASE("heat in less heat lost is what warms the actuator", "[law]", samples::Every) {
  // With a heat capacity this is the energy balance in joule; with the thesis's r it is the same balance in
  // kelvin, eq 3.9.
  for (const double start_C : {25.0, 60.0, 90.0}) {
    for (const double power_W : {0.0, 2.0, 4.0}) {
      auto model = TestType::model(start_C);
      const auto inputs = TestType::inputs(power_W);
      const double dt_s = 0.05;
      double gained_K = 0.0, first_rate = 0.0, last_rate = 0.0;
      for (int i = 0; i < 12000; ++i) {
        const double before = TestType::rate(model.state().motor_C, inputs);
        model.step(inputs, dt_s);
        const double after = TestType::rate(model.state().motor_C, inputs);
        gained_K += dt_s * 0.5 * (before + after);
        if (i == 0) first_rate = before;
        last_rate = after;
      }
      // The trapezoid rule is exact to second order; Euler's own error is first order: half a step's change
      // of rate.
      const double tolerance_K =
          1e-5 + (TestType::is_euler ? 0.51 * dt_s * std::abs(last_rate - first_rate) : 0.0);
      CAPTURE(start_C, power_W);
      CHECK(std::abs(model.state().motor_C - start_C - gained_K) < tolerance_K);
    }
  }
}

TEMPLATE_LIST_TEST_CASE("the state shows heating, cooling and their difference at the start of the step",
                        "[law]", samples::Every) {
  auto model = TestType::model(50.0);
  const auto inputs = TestType::inputs(3.0);
  const double rate = TestType::rate(50.0, inputs);
  const auto& state = model.step(inputs, 0.03);
  CHECK(state.rate_K_per_s == Near(rate).epsilon(1e-14));
  CHECK(state.heating_K_per_s - state.cooling_K_per_s == Near(rate).epsilon(1e-14));
  CHECK(state.heating_K_per_s > 0.0);
  CHECK(state.cooling_K_per_s > 0.0);
  CHECK(model.hottest_C() == state.motor_C);
  CHECK(model.hottest_rate_K_per_s() == state.rate_K_per_s);
}

TEMPLATE_LIST_TEST_CASE("constant power settles where the loss equals the power", "[law]", samples::Every) {
  for (const double power_W : {0.0, 0.5, 2.0}) {
    auto model = TestType::model(40.0);
    const auto inputs = TestType::inputs(power_W);
    for (int i = 0; i < 20000; ++i) model.step(inputs, 3.0);
    CAPTURE(power_W, model.state().motor_C);
    CHECK(std::abs(TestType::rate(model.state().motor_C, inputs)) < 1e-9);
    CHECK(model.state().motor_C >= 25.0 - 1e-9);
  }
}

TEST_CASE("Newton's cooling settles at air temperature plus P over G", "[law]") {
  using Model = tp::ThermalModel<tp::HeatCapacityHeating<double>, tp::NewtonCooling<double>>;
  for (const double conductance : {0.01, 0.05, 1.0}) {
    Model model({{18.0}, {conductance}}, -10.0);
    model.step({3.0, 0.0, {21.0, 0.0}}, 1e9);
    CHECK(model.state().motor_C == Near(21.0 + 3.0 / conductance).epsilon(1e-14));
  }
}

TEMPLATE_LIST_TEST_CASE("without power an actuator cools, never to below the air, at any step size", "[law]",
                        samples::Unconditional) {
  for (const double dt_s : {0.001, 0.03, 1.0, 60.0, 3600.0, 1e6}) {
    auto model = TestType::model(95.0);
    double last_C = 95.0;
    for (int i = 0; i < 200; ++i) {
      const double now_C = model.step(TestType::inputs(0.0), dt_s).motor_C;
      CAPTURE(dt_s, i, last_C, now_C);
      REQUIRE((now_C < last_C || last_C < 25.0 + 1e-6));
      REQUIRE(now_C >= 25.0 - 1e-9);
      last_C = now_C;
    }
  }
}

TEMPLATE_LIST_TEST_CASE("Euler cools towards the air while the step is below the time constant", "[law]",
                        samples::Eulers) {
  auto model = TestType::model(95.0);
  double last_C = 95.0;
  for (int i = 0; i < 20000; ++i) {
    const double now_C = model.step(TestType::inputs(0.0), 0.03).motor_C;
    REQUIRE(now_C < last_C);
    REQUIRE(now_C > 25.0);
    last_C = now_C;
  }
}

TEMPLATE_LIST_TEST_CASE("what is hotter stays hotter, and more power never makes colder", "[law]",
                        samples::Every) {
  for (const double dt_s : {0.03, 5.0}) {
    auto cold = TestType::model(40.0), hot = TestType::model(41.0), driven = TestType::model(40.0);
    for (int i = 0; i < 300; ++i) {
      cold.step(TestType::inputs(1.0), dt_s);
      hot.step(TestType::inputs(1.0), dt_s);
      driven.step(TestType::inputs(1.5), dt_s);
      REQUIRE(hot.state().motor_C > cold.state().motor_C);
      REQUIRE(driven.state().motor_C > cold.state().motor_C);
    }
  }
}

TEMPLATE_LIST_TEST_CASE("the exact step does not depend on how the time is cut", "[law]", samples::Linear) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> exponent(-3.0, 5.0), fraction(0.0, 1.0), power(0.0, 6.0);
  for (int trial = 0; trial < 300; ++trial) {
    const double dt_s = std::pow(10.0, exponent(random));
    const auto inputs = TestType::inputs(power(random));
    auto whole = TestType::model(70.0), cut = TestType::model(70.0);
    whole.step(inputs, dt_s);
    const int pieces = 1 + trial % 20;
    double rest_s = dt_s;
    for (int i = 1; i < pieces; ++i) {
      const double piece_s = rest_s * fraction(random);
      cut.step(inputs, piece_s);
      rest_s -= piece_s;
    }
    cut.step(inputs, rest_s);
    CAPTURE(dt_s, pieces);
    REQUIRE(std::abs(whole.state().motor_C - cut.state().motor_C) < 1e-12 * 100.0);
  }
}

TEST_CASE("the exact step holds in single precision, to a float's rounding per step", "[law]") {
  using Model = tp::ThermalModel<tp::HeatCapacityHeating<float>, tp::NewtonCooling<float>>;
  const Model::Config config = {{18.0f}, {0.05f}};
  for (const float dt_s : {0.03f, 0.3f, 3.0f, 30.0f, 300.0f}) {
    Model model(config, 25.0f);
    const double power_W = 2.5, steps = 200;
    for (int i = 0; i < static_cast<int>(steps); ++i) model.step({2.5f, 0.0f, {25.0f, 0.0f}}, dt_s);
    const double expected =
        25.0 + power_W / 0.05 * (1.0 - std::exp(-0.05 / 18.0 * static_cast<double>(dt_s) * steps));
    CAPTURE(dt_s);
    CHECK(std::abs(static_cast<double>(model.state().motor_C) - expected) < steps * 75.0 * 6e-8);
  }
}

TEMPLATE_LIST_TEST_CASE("the exact step is the solution of the differential equation", "[law]",
                        samples::Linear) {
  for (const double time_s : {1.0, 60.0, 600.0}) {
    auto model = TestType::model(80.0);
    const auto inputs = TestType::inputs(1.5);
    model.step(inputs, time_s);
    CHECK(model.state().motor_C == Near(TestType::reference(80.0, inputs, time_s)).epsilon(1e-11));
  }
}

namespace {
template <class TestType>
double error_with(int steps, double time_s) {
  auto model = TestType::model(30.0);
  const auto inputs = TestType::inputs(4.0);
  for (int i = 0; i < steps; ++i) model.step(inputs, time_s / steps);
  return model.state().motor_C - TestType::reference(30.0, inputs, time_s, 20000);
}
}  // namespace

TEMPLATE_LIST_TEST_CASE("the linearized step is second order: half the step, a quarter of the error", "[law]",
                        samples::Bent) {
  const double ratio = error_with<TestType>(40, 300.0) / error_with<TestType>(80, 300.0);
  CHECK(ratio > 3.6);
  CHECK(ratio < 4.4);
}

TEMPLATE_LIST_TEST_CASE("Euler is first order: half the step, half the error", "[law]", samples::Eulers) {
  const double ratio = error_with<TestType>(200, 300.0) / error_with<TestType>(400, 300.0);
  CHECK(ratio > 1.85);
  CHECK(ratio < 2.15);
}

TEMPLATE_LIST_TEST_CASE("the stated slopes are the derivatives of the stated rates", "[law]",
                        samples::Every) {
  const auto laws = TestType::config();
  const double h = 1e-4;
  for (const double motor_C : {-20.0, 24.0, 26.0, 40.0, 75.0}) {
    for (const double volt : {4.0, 8.0, 12.0}) {
      const double rise = laws.heating.rise_K_per_J(volt, motor_C);
      const double cooling = (laws.cooling.rate_K_per_s(motor_C + h, {25.0, 2.0}, rise) -
                              laws.cooling.rate_K_per_s(motor_C - h, {25.0, 2.0}, rise)) /
                             (2.0 * h);
      CAPTURE(motor_C, volt);
      CHECK(laws.cooling.slope_per_s(motor_C, {25.0, 2.0}, rise) ==
            Near(cooling).epsilon(1e-6).margin(1e-12));
      const double heating =
          (laws.heating.rise_K_per_J(volt, motor_C + h) - laws.heating.rise_K_per_J(volt, motor_C - h)) /
          (2.0 * h);
      CHECK(laws.heating.rise_slope_per_J(volt, motor_C) == Near(heating).epsilon(1e-5).margin(1e-12));
    }
  }
}

TEST_CASE("natural convection equals Newton at its reference difference and grows as its exponent says",
          "[cooling]") {
  const tp::NaturalConvection<double> convection = {0.04, 0.25, 20.0};
  CHECK(convection.loss_W(45.0, {25.0, 0.0}) == Near(0.04 * 20.0));
  CHECK(convection.loss_W(65.0, {25.0, 0.0}) == Near(0.04 * 40.0 * std::pow(2.0, 0.25)));
  CHECK(convection.loss_W(5.0, {25.0, 0.0}) == Near(-0.04 * 20.0));
  CHECK(convection.loss_W(25.0, {25.0, 0.0}) == 0.0);
}

TEST_CASE("radiation follows Stefan and Boltzmann", "[cooling]") {
  const tp::RadiationCooling<double> black = {1.0, 1.0};
  CHECK(black.loss_W(0.0, {-273.15, 0.0}) == Near(5.670374419e-8 * std::pow(273.15, 4)));
  CHECK(black.loss_W(26.85, {26.85, 0.0}) == 0.0);
  CHECK(black.loss_W(126.85, {26.85, 0.0}) ==
        Near(5.670374419e-8 * (std::pow(400.0, 4) - std::pow(300.0, 4))));
}

TEMPLATE_TEST_CASE("airflow adds nothing in still air, whatever its exponent", "[cooling]", float, double) {
  for (const double exponent : {0.2, 0.5, 0.8, 1.0}) {
    const tp::ForcedAirflow<TestType> fan = {TestType(0.03), TestType(2), TestType(exponent)};
    CHECK(fan.loss_W(TestType(60), {TestType(20), TestType(0)}) == Near(1.2).epsilon(1e-6));
    CHECK(fan.loss_W(TestType(60), {TestType(20), TestType(-3)}) == Near(1.2).epsilon(1e-6));
    CHECK(fan.loss_W(TestType(60), {TestType(20), TestType(1)}) == Near(3.6).epsilon(1e-6));
  }
}

TEST_CASE("parallel paths add up", "[cooling]") {
  const auto sum = samples::Sample<samples::Sum>::law();
  const tp::Surroundings<double> air = {20.0, 0.0};
  CHECK(sum.loss_W(70.0, air) == Near(sum.first.loss_W(70.0, air) + sum.second.loss_W(70.0, air)));
  CHECK_FALSE(samples::Sum::is_linear());
  CHECK(samples::SumOfThree::is_linear());
}

TEST_CASE("a thesis motor is not heated at or below one volt, nor where the coefficient is not positive",
          "[heating]") {
  const auto law = samples::Sample<tp::ThesisHeating<double>>::law();
  CHECK(law.rise_K_per_J(1.0, 40.0) == 0.0);
  CHECK(law.rise_K_per_J(0.0, 40.0) == 0.0);
  CHECK(law.rise_K_per_J(1.5, 60.0) > 0.0);
  // At 2 V and 5 degC 1/r is negative: outside anything that was measured.
  CHECK(law.apparent_capacity_J_per_K(2.0, 5.0) < 0.0);
  CHECK(law.rise_K_per_J(2.0, 5.0) == 0.0);
  CHECK(law.rise_slope_per_J(2.0, 5.0) == 0.0);
}

TEST_CASE("minutes become seconds once", "[heating]") {
  const auto law = tp::ThesisHeating<double>::per_minute(0.0, 0.0, 0.2435, -0.4952, 1.0);
  CHECK(law.rise_K_per_J(10.0, 40.0) == Near(1.0 / (60.0 * (2.435 - 0.4952))));
  CHECK(tp::RateCooling<double>::per_minute(0.11).cooling_per_s == Near(0.11 / 60.0));
}

TEMPLATE_LIST_TEST_CASE("NaN or infinity in an input cannot hide: the temperature is no longer finite",
                        "[bad input]", samples::Every) {
  const double nan = std::numeric_limits<double>::quiet_NaN(),
               infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, infinity, -infinity}) {
    CAPTURE(bad);
    auto power = TestType::model(50.0), air = TestType::model(50.0), start = TestType::model(bad);
    CHECK_FALSE(std::isfinite(power.step(TestType::inputs(bad), 1.0).motor_C));
    CHECK_FALSE(std::isfinite(air.step(TestType::inputs(1.0, bad), 1.0).motor_C));
    CHECK_FALSE(std::isfinite(start.step(TestType::inputs(1.0), 1.0).motor_C));
  }
  auto time = TestType::model(50.0), voltage = TestType::model(50.0);
  CHECK_FALSE(std::isfinite(time.step(TestType::inputs(1.0), nan).motor_C));
  auto inputs = TestType::inputs(1.0);
  inputs.v_rms_V = nan;
  const bool reads_voltage = !TestType::Heating::is_heat_capacity();
  CHECK(std::isfinite(voltage.step(inputs, 1.0).motor_C) == !reads_voltage);
}
