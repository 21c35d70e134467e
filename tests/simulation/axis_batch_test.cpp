// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/simulation/axis_batch.hpp>

#include <cmath>
#include <limits>

#include "../catch.hpp"
#include <thermopower/simulation/random.hpp>
#include <thermopower/simulation/thesis_gimbal.hpp>

using namespace thermopower::simulation;

namespace {

template <class Real>
std::vector<AxisCase<Real>> some_cases(std::size_t count) {
  Random random(7);
  const auto draw = [&](double from, double to) { return static_cast<Real>(random.between(from, to)); };
  std::vector<AxisCase<Real>> cases;
  for (std::size_t i = 0; i < count; ++i) {
    AxisCase<Real> one;
    one.config = i % 3 == 0 ? thesis_roll<Real>() : i % 3 == 1 ? thesis_pitch<Real>() : thesis_yaw<Real>();
    one.config.mechanics.imbalance_Nm *= draw(0.5, 1.5);
    one.start = {draw(-30.0, 30.0), draw(20.0, 50.0), draw(20.0, 50.0)};
    one.power = draw(40.0, 255.0);
    one.p_gain = draw(5.0, 15.0);
    one.supply_V = draw(10.0, 13.0);
    one.around = {Real(26), draw(0.0, 3.0)};
    one.sway_deg = draw(0.0, 10.0), one.sway_Hz = draw(0.1, 1.0), one.sway_turns = draw(0.0, 1.0);
    one.wind_Nm = draw(0.0, 0.002), one.wind_Hz = draw(0.1, 3.0), one.wind_turns = draw(0.0, 1.0);
    cases.push_back(one);
  }
  return cases;
}

template <class Real>
double difference(const AxisOutcome<Real>& one, const AxisOutcome<Real>& other) {
  const auto relative = [](Real a, Real b) {
    return static_cast<double>(std::fabs(a - b) / std::fmax(std::fabs(b), Real(1e-3)));
  };
  return std::fmax(
      std::fmax(relative(one.error_rms_deg, other.error_rms_deg),
                relative(one.error_peak_deg, other.error_peak_deg)),
      std::fmax(relative(one.energy_J, other.energy_J),
                std::fmax(relative(one.winding_C, other.winding_C), relative(one.body_C, other.body_C))));
}

}  // namespace

TEST_CASE("An axis in a batch does what it does alone") {
  const auto cases = some_cases<double>(37);
  const auto batch = run_batch<double, 8>(cases, 2.0);
  REQUIRE(batch.size() == cases.size());
  double moved = 0.0;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    INFO("case " << i);
    const auto alone = run_case(cases[i], 2.0);
    CHECK(difference(batch[i], alone) < 1e-9);
    moved = std::fmax(moved, alone.error_rms_deg);
  }
  CHECK(moved > 0.1);
}

TEST_CASE("Neither the number of lanes nor of threads shows in the outcome") {
  const auto cases = some_cases<double>(50);
  const auto one = run_batch<double, 8>(cases, 1.0, 1);
  const auto two = run_batch<double, 8>(cases, 1.0, 2);
  const auto wide = run_batch<double, 32>(cases, 1.0, 2);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    CHECK(difference(one[i], two[i]) == 0.0);
    CHECK(difference(one[i], wide[i]) < 1e-12);
  }
}

TEST_CASE("A lane that is not a number keeps to itself") {
  auto cases = some_cases<double>(8);
  const auto sound = run_batch<double, 8>(cases, 0.5);
  cases[3].config.mechanics.inertia_kg_m2 = std::numeric_limits<double>::quiet_NaN();
  const auto spoilt = run_batch<double, 8>(cases, 0.5);
  CHECK(std::isnan(spoilt[3].error_rms_deg));
  for (const std::size_t i : {0u, 1u, 2u, 4u, 5u, 6u, 7u}) CHECK(difference(spoilt[i], sound[i]) == 0.0);
}

TEST_CASE("Single precision tells the same story") {
  const auto fine = run_batch<double, 8>(some_cases<double>(48), 5.0);
  const auto coarse = run_batch<float, 16>(some_cases<float>(48), 5.0);
  for (std::size_t i = 0; i < fine.size(); ++i) {
    INFO("case " << i);
    CHECK(std::fabs(static_cast<double>(coarse[i].error_rms_deg) - fine[i].error_rms_deg) <
          1e-3 + 1e-3 * fine[i].error_rms_deg);
    CHECK(static_cast<double>(coarse[i].energy_J) == Approx(fine[i].energy_J).epsilon(1e-4));
    CHECK(std::fabs(static_cast<double>(coarse[i].winding_C) - fine[i].winding_C) < 0.01);
  }
}

TEST_CASE("No cases, no outcomes") { CHECK(run_batch<double, 8>({}, 1.0, 2).empty()); }
