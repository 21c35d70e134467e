// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// When a power was switched, found from the temperature of motors that are switched at a row, at any time, or before it.
#include "../../catch.hpp"

#include "switched_bench.hpp"

#include <thermopower/gap/observe/heat_between_rows.hpp>
#include <thermopower/gap/data/inputs.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

using namespace thermopower::gap;
using namespace thermopower::gap::engine;
using Log = test::SwitchedBench::Log;

namespace {

/// What a recording of a bench tells.
HeatBetweenRows told_by(const test::SwitchedBench& bench, double lasts_s, unsigned seed) {
  const Model model = test::SwitchedBench::model();
  const Inputs inputs = prepare(model, bench.recording(lasts_s, seed));
  const thermopower::plant::BenchAtRows laws(model, thermopower::plant::standard_catalogue(), inputs, {});
  HeatBetweenRows between;
  between.add(inputs, laws.evaluate(thermopower::plant::HeatTold::by_law).heat_W);
  return between;
}

/// Part of an interval in which the next row's heat is in force; -1 where nothing is found.
double share_of(const test::SwitchedBench& bench, double lasts_s, unsigned seed) {
  return told_by(bench, lasts_s, seed).share().value_or(-1.0);
}

TEST_CASE("a power that is switched at any time is half an interval ahead, for one body and for two") {
  for (const bool has_winding : {false, true})
    for (const double rows_s : {1.0, 2.0, 10.0}) {
      CAPTURE(has_winding, rows_s);
      test::SwitchedBench bench;
      bench.has_winding = has_winding;
      bench.rows_s = rows_s;
      const double share = share_of(bench, 28800.0, 3);
      CHECK(share > 0.35);
      CHECK(share < 0.65);
    }
}

TEST_CASE("a power that is logged after its interval is an interval ahead") {
  test::SwitchedBench bench;
  bench.log = Log::afterwards;
  for (const double rows_s : {1.0, 5.0}) {
    bench.rows_s = rows_s;
    CHECK(share_of(bench, 28800.0, 4) == 1.0);
  }
}

TEST_CASE("a power that holds from row to row is not ahead, however the body stores heat") {
  test::SwitchedBench bench;
  bench.log = Log::at_rows;
  for (const bool has_winding : {false, true})
    for (const double rows_s : {1.0, 2.0, 10.0, 30.0})
      for (const unsigned seed : {5u, 6u, 7u}) {
        CAPTURE(has_winding, rows_s, seed);
        bench.has_winding = has_winding;
        bench.rows_s = rows_s;
        CHECK(share_of(bench, 28800.0, seed) == -1.0);
      }
}

TEST_CASE("one logger writes all recordings: what others deny is no way of writing them") {
  test::SwitchedBench at_rows, anytime;
  at_rows.log = Log::at_rows;
  anytime.log = Log::anytime;
  const HeatBetweenRows ahead = told_by(anytime, 28800.0, 8);
  CHECK(ahead.differs_from(told_by(at_rows, 28800.0, 9)));
  CHECK_FALSE(ahead.differs_from(told_by(anytime, 28800.0, 9)));
  // A minute tells nothing, and denies nothing.
  CHECK_FALSE(ahead.differs_from(told_by(at_rows, 60.0, 9)));
}

}  // namespace
