// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// What a command did between the rows, found from the motion of axes whose loop is known: one that sets its command 1000
// times a second and logs some of them, and one that logs each.
#include "../../catch.hpp"

#include "sampled_axis.hpp"

#include <thermopower/gap/check.hpp>
#include <thermopower/gap/data/command_between_rows.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

using namespace thermopower::gap;
using namespace thermopower::gap::engine;

namespace {

/// How much of the command's next step the motion shows.
std::optional<double> share_of(const Recording& r) {
  const Inputs inputs = prepare(test::SampledAxis::model(), r);
  CommandBetweenRows between;
  between.add(inputs, inputs.drive_A);
  return between.share();
}

/// Without one of its columns.
Recording without(Recording r, const char* column) {
  r.remove(column);
  return r;
}

TEST_CASE("what is felt of a command's next step is counted in the loop's own steps") {
  // A command that is held for 1 of N steps and set anew N times a row has its mean (N - 1) / 2N of the way to the next row.
  for (const int kept : {2, 5, 20}) {
    CAPTURE(kept);
    const double expected = (kept - 1.0) / (2.0 * kept);
    for (const auto effect : {test::SampledAxis::Effect::none, test::SampledAxis::Effect::friction,
                              test::SampledAxis::Effect::cogging}) {
      const Recording r = test::SampledAxis(effect, 30.0, 11).logged_each(kept);
      REQUIRE(share_of(r));
      CHECK(*share_of(r) == Approx(expected).margin(0.05));
    }
  }
  const Recording r = test::SampledAxis(test::SampledAxis::Effect::friction, 30.0, 12).logged_each(20);
  CHECK(*share_of(without(r, "angle_deg")) == Approx(0.475).margin(0.05));
  CHECK(*share_of(without(r, "rate_dps")) == Approx(0.475).margin(0.05));
}

TEST_CASE("a command that holds from row to row is left as it is, and one that comes late, too") {
  for (const auto effect : {test::SampledAxis::Effect::none, test::SampledAxis::Effect::friction,
                            test::SampledAxis::Effect::cogging}) {
    const Recording r = test::SampledAxis(effect, 60.0, 13, 20).logged_each(20);
    REQUIRE(share_of(r));
    CHECK(std::abs(*share_of(r)) < 0.1);
  }
  Recording late = test::SampledAxis(test::SampledAxis::Effect::none, 60.0, 14, 20).logged_each(20);
  Eigen::VectorXd early = late.column("drive_A");
  for (Eigen::Index i = 0; i + 2 < early.size(); ++i) early[i] = early[i + 2];
  late.set("drive_A", early);  // logged two rows before it acts
  CHECK(*share_of(late) < -1.0);
  const CheckedRecordings checked =
      check(test::SampledAxis::model(), {late}, {}, {}, thermopower::plant::standard_catalogue());
  CHECK(checked.train.front().recording().column("drive_A") == early);
}

}  // namespace
