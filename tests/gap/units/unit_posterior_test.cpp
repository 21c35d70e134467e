// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The posterior of units: a unit competes with constants that moved, and holds in every recording of a source.
#include "../../catch.hpp"
#include "../data/rough_recordings.hpp"

#include <thermopower/gap/check.hpp>
#include <thermopower/gap/units/posterior.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

#include <cmath>
#include <random>
#include <string>
#include <vector>

using namespace thermopower::gap;
using namespace thermopower::gap::engine;

namespace {

/// A joint whose command moves it `moves` times as much as its model says.
UnitEvidence joint(double moves, double forwards_nats = 0.0) {
  UnitEvidence one;
  one.columns = {"t_s", "drive_A", "angle_deg", "rate_dps"};
  one.is_axis = true;
  one.interval_s = 5e-3;
  one[UnitMeasure::slope].value = 1.0;
  one[UnitMeasure::drive].value = moves;
  one[UnitMeasure::drive].forwards_nats = forwards_nats;
  return one;
}

/// The likeliest line of the table for all recordings; empty where none is sure.
std::string likeliest(const std::vector<UnitEvidence>& parts) {
  const std::vector<UnitHypothesis> table =
      unit_hypotheses([&](const std::string& column) { return parts.front().has(column); });
  const UnitPosterior posterior(parts, 0.0);
  const auto all = [&](const UnitHypothesis& one) { return UnitPosterior::Assignment(parts.size(), &one); };
  const UnitHypothesis* best = &table.front();
  double most = posterior.of(all(*best), *best) + UnitThresholds().sure;
  for (const UnitHypothesis& one : table) {
    if (one.exchanges()) continue;
    if (const double now = posterior.of(all(one), one);
        now > most && posterior.holds_everywhere(one, all(one)))
      most = now, best = &one;
  }
  return best->is_none() ? "" : best->mend();
}

std::vector<Finding> findings(const Model& model, const Recording& r) {
  return engine::check(model, {r}, {}, {}, standard_catalogue()).findings;
}

bool has(const std::vector<Finding>& list, FindingKind kind, Severity severity) {
  for (const Finding& one : list)
    if (one.kind == kind && one.severity == severity) return true;
  return false;
}

}  // namespace

TEST_CASE("a factor that units have is a unit, and one that they do not have is not") {
  CHECK(likeliest({joint(1.0)}).empty());
  CHECK(likeliest({joint(1e-3)}) == "--column drive_A=drive_A:mA");
  for (const double moves : {32.5, 425.0, 27000.0, 0.1, 10.0}) CHECK(likeliest({joint(moves)}).empty());
}

TEST_CASE("a unit or a sign holds in every recording of a source") {
  CHECK(likeliest({joint(1e-3), joint(1e-3)}) == "--column drive_A=drive_A:mA");
  CHECK(likeliest({joint(1e-3), joint(1.0), joint(1.0)}).empty());
  const UnitEvidence forwards = joint(1.0, 12.0), backwards = joint(1.0, -12.0);
  CHECK(likeliest({backwards, backwards}) == "--column drive_A=drive_A:-A");
  CHECK(likeliest({backwards, forwards}).empty());
}

TEST_CASE(
    "a bed that is hot where its log begins, and warms half as fast again as one mass, is in degrees Celsius") {
  UnitEvidence bed;
  bed.columns = {"t_s", "power_param", "ambient_C", "motor_C"};
  bed.is_bench = true;
  bed.heated_by = "power_param";
  bed.interval_s = 1.0;
  bed.most_power = 255.0;
  bed.air.low = bed.air.typical = bed.air.high = 25.0;
  bed.motor.low = 66.0;
  bed.motor.typical = bed.motor.high = 105.0;
  bed[UnitMeasure::heating].tell(1.5, 0.1);
  bed[UnitMeasure::cooling].tell(2.9, 0.1);  // of the mass beside it, to which it loses heat at first
  bed.air_offset_K = 38.0;
  CHECK(likeliest({bed}).empty());
}

TEST_CASE("one factor of several constants is said, and stops nothing") {
  Recording slow = test::recorded(test::RubbingAxis{1, 1.0, 0.0});
  slow.t_s *= 0.5;
  CHECK(has(findings(test::rubbing_model(), slow), FindingKind::common_factor, Severity::warning));
  CHECK(deciding(findings(test::rubbing_model(), slow)) == nullptr);
  const Recording sound = test::recorded(test::RubbingAxis{1, 1.0, 0.0});
  CHECK_FALSE(has(findings(test::rubbing_model(), sound), FindingKind::common_factor, Severity::warning));
}

TEST_CASE("a thermometer that only follows the air is not attached") {
  Recording r = test::recorded(test::CasedMotor{});
  CHECK_FALSE(has(findings(test::cased_model(), r), FindingKind::detached_sensor, Severity::error));
  std::mt19937 numbers(3);
  std::normal_distribution<double> noise;
  double drift_K = 0.0;
  Eigen::VectorXd motor = r.column("ambient_C");
  for (double& one : motor) one += drift_K += 0.0005, one += 0.05 * noise(numbers);
  r.set("motor_C", motor);
  CHECK(has(findings(test::cased_model(), r), FindingKind::detached_sensor, Severity::error));
}

TEST_CASE("an axis that never moves under its drive says so, and one that turns at one rate does not") {
  Recording still = test::recorded(test::RubbingAxis{1, 1.0, 0.0});
  std::mt19937 numbers(5);
  std::normal_distribution<double> noise;
  Recording cruise = still;
  for (const char* column : {"angle_deg", "rate_dps"}) {
    Eigen::VectorXd values = still.column(column);
    for (double& one : values) one = 12.0 * (column[0] == 'a') + 0.05 * noise(numbers);
    still.set(column, values);
  }
  CHECK(has(findings(test::rubbing_model(), still), FindingKind::detached_sensor, Severity::error));
  Eigen::VectorXd rates = cruise.column("rate_dps");
  for (double& one : rates) one = 90.0 + 0.05 * noise(numbers);
  cruise.remove("angle_deg");
  cruise.set("rate_dps", rates);
  CHECK_FALSE(has(findings(test::rubbing_model(), cruise), FindingKind::detached_sensor, Severity::error));
}
