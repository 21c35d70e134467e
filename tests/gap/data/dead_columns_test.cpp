// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Outputs that stand still over a whole recording, though what drives them moves: left out, and where nothing else is left,
// nothing is said.
#include "../../catch.hpp"

#include "../plants.hpp"

#include <thermopower/gap/check.hpp>
#include <thermopower/gap/diagnose.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

#include <algorithm>
#include <initializer_list>
#include <string>

using namespace thermopower::gap;

namespace {

Recording bench(std::uint64_t seed) { return test::bench_recording({}, 1200, seed); }
Recording axis(std::uint64_t seed) { return test::axis_recording({}, 3000, seed); }

/// With columns that stand still at some value.
Recording still(Recording recording, std::initializer_list<const char*> columns, double value) {
  for (const char* column : columns)
    recording.set(column, Eigen::VectorXd::Constant(recording.rows(), value));
  return recording;
}

/// What is said of columns that never change though something drives them, as `severity(column)`.
std::string said(const Model& model, const Recording& train, const Recording& held_out,
                 bool as_recorded = false) {
  std::string text;
  for (const Finding& one :
       engine::check(model, {train}, {held_out}, {0.5, as_recorded}, standard_catalogue()).findings)
    if (one.kind == FindingKind::constant_column && one.severity != Severity::note)
      text += std::string(to_string(one.severity)) + "(" + one.column + "," + to_string(one.action) + ") ";
  return text;
}

}  // namespace

TEST_CASE("an output that stands still where its input moves is left out, and the others are judged") {
  const Model model = test::axis_model();
  CHECK(said(model, axis(1), axis(2)).empty());
  CHECK(said(model, still(axis(1), {"angle_deg"}, 12.5), axis(2)) == "warning(angle_deg,masked) ");
  CHECK(said(model, still(axis(1), {"rate_dps"}, 0.0), axis(2)) == "warning(rate_dps,masked) ");
  CHECK(said(model, axis(1), still(axis(2), {"angle_deg"}, 0.0)) == "warning(angle_deg,masked) ");
  CHECK(said(model, still(axis(1), {"angle_deg"}, 0.0), axis(2), true) == "warning(angle_deg,none) ");
  CHECK(said(test::bench_model(), still(bench(1), {"current_A"}, 0.7), bench(2)) ==
        "warning(current_A,masked) ");
  const Diagnosis diagnosis =
      diagnose(model, {still(axis(1), {"angle_deg"}, 12.5)}, {still(axis(2), {"angle_deg"}, 12.5)});
  CHECK(diagnosis.verdict == Verdict::no_gap);  // and no angle_scale of 0
  CHECK(diagnosis.gap.size() == 1);
}

TEST_CASE("what stands still in every recording is left out where it is hardly driven, too") {
  Recording gentle = still(axis(2), {"angle_deg"}, 0.0);
  gentle.set("drive_A", 0.05 * gentle.column("drive_A"));
  CHECK(said(test::axis_model(), still(axis(1), {"angle_deg"}, 0.0), gentle) ==
        "warning(angle_deg,masked) warning(angle_deg,masked) ");
  CHECK(said(test::axis_model(), axis(1), gentle).empty());
}

TEST_CASE("an axis that never moves says nothing") {
  const Model model = test::axis_model();
  const char* const both = "error(angle_deg,masked) error(rate_dps,masked) ";
  CHECK(said(model, still(axis(1), {"angle_deg", "rate_dps"}, 0.0), axis(2)) == both);
  CHECK(said(model, axis(1), still(axis(2), {"angle_deg", "rate_dps"}, 0.0)) == both);
  CHECK(said(model, still(axis(1), {"angle_deg", "rate_dps"}, 0.0), axis(2), true) ==
        "error(angle_deg,none) error(rate_dps,none) ");
  const Diagnosis diagnosis = diagnose(model, {still(axis(1), {"angle_deg", "rate_dps"}, 0.0)}, {axis(2)});
  CHECK(diagnosis.verdict == Verdict::insufficient);
  CHECK_THAT(diagnosis.reason, ContainsSubstring("the axis never moves"));
  CHECK_THAT(diagnosis.next_experiment, ContainsSubstring("hard enough to move"));
}

TEST_CASE("an axis that stands still under less than what moves it elsewhere is held, and that is data") {
  Recording held = still(axis(2), {"angle_deg", "rate_dps"}, 0.0);
  held.set("drive_A", 0.6 * held.column("drive_A"));
  CHECK(said(test::axis_model(), axis(1), held).empty());
  // Not where one of its outputs moves: then the other is dead.
  Recording half = axis(2);
  half.set("drive_A", 0.6 * half.column("drive_A"));
  CHECK(said(test::axis_model(), axis(1), still(half, {"angle_deg"}, 0.0)) == "warning(angle_deg,masked) ");
}

TEST_CASE("an output may stand still where its input does") {
  CHECK(said(test::axis_model(), still(axis(1), {"drive_A", "angle_deg", "rate_dps"}, 0.0), axis(2)).empty());
  CHECK(said(test::bench_model(), still(bench(1), {"power_param", "current_A"}, 0.0), bench(2)).empty());
}
