// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// What drove an axis before its first row, told from what its motion makes of earlier commands. The plant is stepped here.
#include "../../catch.hpp"
#include "late_axis.hpp"

#include <thermopower/gap/check.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

using namespace thermopower::gap;

namespace {

/// Whether the first command is taken to have been there before the first row.
bool was_driven(const test::LateAxis& axis, std::uint64_t seed = 1) {
  const engine::CheckedRecordings checked = engine::check(
      test::LateAxis::model(), {axis.recording(seed)}, {axis.recording(seed + 1)}, {}, standard_catalogue());
  const bool train = checked.train.front().inputs().runs.front().was_driven,
             held_out = checked.held_out.front().inputs().runs.front().was_driven;
  CHECK(train == held_out);
  CHECK(checked.train.front().recording().spans().front().was_driven == train);
  return train;
}

TEST_CASE("a late drive that was commanded before the first row is told from one that was idle") {
  for (const double row_s : {0.01, 0.02, 0.04})
    for (const double rows_late : {0.25, 0.75, 1.0, 1.5, 2.5})
      for (const bool with_rate : {true, false}) {
        CAPTURE(row_s, rows_late, with_rate);
        test::LateAxis axis;
        axis.row_s = row_s;
        axis.delay_s = rows_late * row_s;
        axis.with_rate = with_rate;
        axis.commanded_before = true;
        // Of an angle alone the rate that an axis starts with is fitted: there it is hardly a gap, and hardly seen.
        if (with_rate) CHECK(was_driven(axis));
        axis.commanded_before = false;
        CHECK_FALSE(was_driven(axis));
      }
}

TEST_CASE("a late drive under dry friction that was idle is not taken for one that was commanded") {
  test::LateAxis axis;
  axis.delay_s = 0.03;
  axis.coulomb_Nm = 0.006;
  CHECK_FALSE(was_driven(axis));
  axis.commanded_before = true;
  CHECK(was_driven(axis));
}

TEST_CASE("a smooth command, of which no row is told from the next, does not say that it was there before") {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    CAPTURE(seed);
    test::LateAxis axis;
    axis.row_s = 0.004;
    axis.delay_s = 0.008;
    axis.smooth = true;
    CHECK_FALSE(was_driven(axis, seed));
  }
}

TEST_CASE(
    "of an axis that remembers no command, and of a drive that takes its time from rest on, nothing is said") {
  test::LateAxis axis;
  CHECK_FALSE(was_driven(axis));
  axis.coulomb_Nm = 0.006;
  CHECK_FALSE(was_driven(axis));
  axis.lag_s = 0.03;
  CHECK_FALSE(was_driven(axis));
}

}  // namespace
