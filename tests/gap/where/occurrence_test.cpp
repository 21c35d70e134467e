// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "../../catch.hpp"

#include "../plants.hpp"

#include <thermopower/gap/where/occurrence.hpp>

using namespace thermopower::gap;
using namespace thermopower::gap::engine;

namespace {

Recording named(Recording recording, const char* name) {
  recording.name = name;
  return recording;
}

Localisation found(const Model& model, const std::vector<Recording>& train,
                   const std::vector<Recording>& held_out) {
  const Catalogue none;
  Localisation result = localise(model, train, none);
  add_occurrences(model, train, held_out, none, result);
  return result;
}

}  // namespace

TEST_CASE("a fault that all runs show is said of none in particular") {
  test::AxisFault fault;
  fault.spring_Nm_per_rad = 0.01;
  const Localisation all = found(test::axis_model(), {named(test::axis_recording(fault, 3000, 3), "one")},
                                 {named(test::axis_recording(fault, 3000, 4), "two")});
  REQUIRE_FALSE(all.where.empty());
  CHECK(all.where.front().only_in.empty());
  CHECK(found(test::axis_model(), {test::axis_recording({}, 3000, 3)}, {test::axis_recording({}, 3000, 4)})
            .where.empty());
}

TEST_CASE("a fault of the held-out data alone is placed, and said to be there alone") {
  test::AxisFault fault;
  fault.spring_Nm_per_rad = 0.01;
  const Localisation later = found(test::axis_model(), {named(test::axis_recording({}, 3000, 3), "one")},
                                   {named(test::axis_recording(fault, 3000, 4), "two")});
  REQUIRE(later.where.size() == 1);
  CHECK(later.where.front().submodel == thermopower::plant::Submodel::mechanical_load);
  REQUIRE(later.where.front().only_in.size() == 1);
  CHECK(later.where.front().only_in.front().recording == "two");
  CHECK(later.where.front().only_in.front().held_out);
}

TEST_CASE("a fault that begins in the middle of a run is said with its time") {
  test::AxisFault fault;
  fault.spring_Nm_per_rad = 0.02;
  const Recording before = test::axis_recording({}, 4000, 3), after = test::axis_recording(fault, 4000, 3);
  Recording joined = before;
  for (const char* name : {"angle_deg", "rate_dps"}) {
    Eigen::VectorXd values = before.column(name);
    values.tail(2000) = after.column(name).tail(2000);
    joined.set(name, values);
  }
  SECTION("in one piece") {}
  SECTION("in a run that was cut") {
    const std::string label = "a";
    joined.runs = {{0, 2700, label}, {2700, 3300, label}, {3300, 4000, label}};
  }
  const Localisation half =
      found(test::axis_model(), {named(joined, "one")}, {named(test::axis_recording({}, 3000, 4), "two")});
  REQUIRE_FALSE(half.where.empty());
  REQUIRE(half.where.front().only_in.size() == 1);
  CHECK(half.where.front().only_in.front().recording == "one");
  REQUIRE(half.where.front().only_in.front().from_s);
  CHECK(*half.where.front().only_in.front().from_s == Approx(20.0).margin(2.5));
}

TEST_CASE(
    "what shows from the first row of a short run on did not begin later, where fewer rows cannot tell") {
  const Eigen::Index rows = GENERATE(150, 170, 200, 230, 260, 300, 400);
  CAPTURE(rows);
  test::AxisFault fault;
  fault.spring_Nm_per_rad = 0.02;
  const Recording whole = test::axis_recording(fault, 3000, 3);
  Recording cut = named(whole, "one");
  cut.runs = {{0, rows, "a"}, {rows, 3000, "a"}};
  const Localisation all =
      found(test::axis_model(), {cut}, {named(test::axis_recording(fault, 3000, 4), "two")});
  REQUIRE_FALSE(all.where.empty());
  for (const Location& one : all.where)
    for (const Occurrence& run : one.only_in) CHECK_FALSE(run.from_s);
}
