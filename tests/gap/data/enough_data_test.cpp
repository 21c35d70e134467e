// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// How little data is too little: few rows, short runs, nothing that can be judged.
#include "../../catch.hpp"

#include "../plants.hpp"

#include <thermopower/gap/check_data.hpp>
#include <thermopower/gap/diagnose.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

#include <algorithm>
#include <string>

using namespace thermopower::gap;

namespace {

/// The same rows in runs of some rows each.
Recording in_runs(Recording recording, Eigen::Index rows) {
  recording.runs.clear();
  for (Eigen::Index row = 0; row < recording.rows(); row += rows)
    recording.runs.push_back(
        {row, std::min(row + rows, recording.rows()), std::to_string(recording.runs.size() + 1)});
  return recording;
}

Recording named(Recording recording, const char* name) {
  recording.name = name;
  return recording;
}

Recording bench(int rows, std::uint64_t seed) { return test::bench_recording({}, rows, seed); }
Recording axis(int rows, std::uint64_t seed) { return test::axis_recording({}, rows, seed); }

void refused(const Model& model, const Recording& train, const Recording& held_out, const char* reason,
             const char* next) {
  const Diagnosis diagnosis = diagnose(model, {named(train, "a.csv")}, {named(held_out, "b.csv")});
  CHECK(diagnosis.verdict == Verdict::insufficient);
  CHECK_THAT(diagnosis.reason, ContainsSubstring(reason));
  CHECK_THAT(diagnosis.next_experiment, ContainsSubstring(next));
}

}  // namespace

TEST_CASE("few rows are too few, and it is said of which part, how many there are and what to do") {
  const char* const longer = "record for longer: at least 12 rows to train on and 12 held out";
  refused(test::bench_model(), bench(1, 1), bench(900, 2),
          "the training rows of a.csv hold 0 readings of the motor current", longer);
  refused(test::bench_model(), bench(12, 1), bench(900, 2),
          "the training rows of a.csv hold 11 readings of the motor current that a simulation can be "
          "held against, fewer than 12",
          longer);
  refused(test::bench_model(), bench(900, 1), bench(10, 2),
          "the held-out rows of b.csv hold 9 readings of the motor current", "12 held out");
  refused(test::axis_model(), axis(8, 1), axis(3000, 2), "the training rows of a.csv hold 7 readings",
          longer);
}

TEST_CASE("some ten readings tell that there is a gap, and name no effect") {
  test::BenchFault fault;
  fault.sensor_offset_A = 0.05;
  for (const int rows : {16, 20, 28}) {
    CAPTURE(rows);
    const Diagnosis diagnosis = diagnose(test::bench_model(), {test::bench_recording(fault, rows, 1)},
                                         {test::bench_recording(fault, 40, 2)});
    // Constants may be off; no effect is named.
    for (const Cause& cause : diagnosis.cause) CHECK(cause.effect.rfind("calibration.", 0) == 0);
    CHECK(diagnosis.verdict != Verdict::insufficient);
  }
  const Diagnosis more = diagnose(test::bench_model(), {test::bench_recording(fault, 400, 1)},
                                  {test::bench_recording(fault, 300, 2)});
  REQUIRE(more.cause.size() == 1);
  CHECK(more.cause.front().effect == "current_sensor_offset");
}

TEST_CASE("a handful of readings of one signal is no gap beside another one that has none") {
  Recording held_out = bench(900, 2);
  Eigen::VectorXd motor_C = held_out.column("motor_C");
  for (Eigen::Index i = 0; i < motor_C.size(); ++i)
    if (i % 90 != 0) motor_C[i] = missing;
  held_out.set("motor_C", motor_C);
  const Diagnosis diagnosis =
      diagnose(test::bench_model(), {named(bench(1500, 1), "a.csv")}, {named(held_out, "b.csv")});
  CHECK(diagnosis.verdict == Verdict::no_gap);
  for (const GapScore& gap : diagnosis.gap) CHECK(gap.noise_floor > 0.0);
}

TEST_CASE("an axis that is recorded for less than two windows is too short, however many rows there are") {
  refused(test::axis_model(), axis(3000, 2), axis(80, 1),
          "the held-out rows of b.csv last 0.79 s, less than two windows of 0.5 s", "several seconds");
}

TEST_CASE("runs of a few rows only start simulations") {
  for (const Eigen::Index rows : {1, 2}) {
    CAPTURE(rows);
    refused(test::bench_model(), in_runs(bench(900, 1), rows), bench(900, 2),
            "runs of fewer than 3 rows tell little else", "one label in the column run");
    refused(test::bench_model(), bench(900, 1), in_runs(bench(900, 2), rows),
            "the held-out rows of b.csv hold 0 readings", "one label in the column run");
  }
}

TEST_CASE("where nothing can be judged the columns are named that were recorded, and those that lack") {
  Recording other = bench(900, 1);
  other.remove("motor_C");
  other.set("Winding", Eigen::VectorXd::Ones(other.rows()));
  refused(test::bench_model(), other, bench(900, 2), "has no column motor_C", "--column NAME=HEADER");
  refused(test::bench_model(), other, bench(900, 2), "in the training rows of a.csv", "columns FILE");
  refused(test::bench_model(), other, bench(900, 2), "Winding", "columns FILE");
}

TEST_CASE("the check says the same before anything is diagnosed") {
  const DataReport few = check_data(test::bench_model(), {named(bench(12, 1), "a.csv")});
  CHECK_THAT(few.too_little, ContainsSubstring("the training rows of a.csv hold 11 readings"));
  CHECK_THAT(few.next_experiment, ContainsSubstring("record for longer"));
  CHECK_THAT(check_data(test::bench_model(), {bench(900, 1)}, {named(bench(10, 2), "b.csv")}).too_little,
             ContainsSubstring("the held-out rows of b.csv hold 9 readings"));
  CHECK(check_data(test::bench_model(), {bench(900, 1)}).too_little.empty());
}

TEST_CASE("what is just enough is diagnosed") {
  CHECK(diagnose(test::bench_model(), {bench(13, 1)}, {bench(13, 2)}).verdict != Verdict::insufficient);
  CHECK(diagnose(test::bench_model(), {in_runs(bench(200, 1), 3)}, {bench(100, 2)}).verdict !=
        Verdict::insufficient);
}
