// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// A rate behind its own angle, made of recordings in which both belong together.
#include "../../catch.hpp"

#include "sampled_axis.hpp"

#include <thermopower/gap/check.hpp>
#include <thermopower/gap/observe/lagging_output.hpp>
#include <thermopower/gap/simulate.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

#include <algorithm>
#include <cmath>

using namespace thermopower::gap;
using namespace thermopower::gap::engine;

namespace {

std::optional<double> lag_of(const Recording& r) {
  RateLag lag;
  lag.add(prepare(test::SampledAxis::model(), r));
  return lag.found().lag_s;
}

Recording sound(std::uint64_t seed) {
  return test::SampledAxis(test::SampledAxis::Effect::friction, 40.0, seed, 10).logged_each(10);
}

Recording shifted(Recording r, const char* column, Eigen::Index rows) {
  const Eigen::VectorXd values = r.column(column);
  Eigen::VectorXd late = values;
  for (Eigen::Index i = rows; i < values.size(); ++i) late[i] = values[i - rows];
  r.set(column, late);
  return r;
}

TEST_CASE("rate and angle that belong together are both judged, whatever else is wrong with them") {
  for (std::uint64_t seed = 31; seed < 36; ++seed) {
    Recording r = sound(seed);
    CHECK_FALSE(lag_of(r));
    Recording scaled = r;
    scaled.set("angle_deg", Eigen::VectorXd(1.3 * r.column("angle_deg")));
    CHECK_FALSE(lag_of(scaled));
    Recording offset = r;
    offset.set("rate_dps", Eigen::VectorXd(r.column("rate_dps").array() + 5.0));
    CHECK_FALSE(lag_of(offset));
    Recording eccentric = r;
    eccentric.set("angle_deg",
                  Eigen::VectorXd(r.column("angle_deg").array() +
                                  2.0 * (r.column("angle_deg").array() * 0.017453292519943295).sin()));
    CHECK_FALSE(lag_of(eccentric));
  }
}

TEST_CASE("a rate that is filtered or read late is found with its delay, and so is an angle") {
  for (std::uint64_t seed = 31; seed < 34; ++seed) {
    const Recording r = sound(seed);  // a row each 10 ms
    const auto late = lag_of(shifted(r, "rate_dps", 2)), behind = lag_of(shifted(r, "angle_deg", 2)),
               slow = lag_of(test::filtered(r, "rate_dps", 0.05));
    REQUIRE(late);
    CHECK(*late == Approx(0.020).epsilon(0.05));
    REQUIRE(behind);
    CHECK(*behind == Approx(-0.020).epsilon(0.05));
    // y[i] = y[i-1] + a (x[i] - y[i-1]) comes (1 - a) / a rows late.
    const double a = 1.0 - std::exp(-0.01 / 0.05);
    REQUIRE(slow);
    CHECK(*slow == Approx(0.01 * (1.0 - a) / a).epsilon(0.05));
  }
}

TEST_CASE(
    "a rate that is filtered within half a row is read earlier, and one later only where it tells of more") {
  const auto checked = [](const Recording& r) {
    return check(test::SampledAxis::model(), {r}, {}, {}, thermopower::plant::standard_catalogue());
  };
  const Recording r = sound(33);  // a row each 10 ms
  const Recording quick =
      test::filtered(r, "rate_dps", 0.006);  // some 2 ms late, as differences of rows have it
  REQUIRE(lag_of(quick));
  const CheckedRecordings mended = checked(quick);
  REQUIRE(mended.train.front().inputs().judged(Signal::rate_dps));
  CHECK_FALSE(lag_of(mended.train.front().recording()));
  const Recording slow = test::filtered(r, "rate_dps", 0.05);
  CHECK_FALSE(checked(slow).train.front().inputs().judged(Signal::rate_dps));
  Recording scaled = slow;
  scaled.set("angle_deg", Eigen::VectorXd(4.0 * r.column("angle_deg")));
  CHECK(checked(scaled).train.front().inputs().judged(Signal::rate_dps));
}

TEST_CASE("what a model predicts for an axis restarts from what is believed of a late rate") {
  const Recording late = shifted(sound(34), "rate_dps", 3);
  const auto missed = [&](const std::vector<SimulatedSignal>& simulated) {
    double squares = 0.0, count = 0.0;
    for (const SimulatedSignal& one : simulated)
      for (Eigen::Index i = 0; to_string(one.signal) == "angle_deg" && i < late.rows(); ++i)
        if (std::isfinite(one.values[i]))
          squares += std::pow(one.values[i] - late.column("angle_deg")[i], 2.0), count += 1.0;
    REQUIRE(count > 0.9 * static_cast<double>(late.rows()));
    return std::sqrt(squares / count);
  };
  const Model model = test::SampledAxis::model();
  CHECK(missed(simulate_as_believed(model, late, 0.5)) <
        0.5 * missed(simulate(model, late, {SimulationMode::free_running, 0.5})));
}

TEST_CASE("what comes late is not judged, in every recording, and the reason is said once for each") {
  const CheckedRecordings checked =
      check(test::SampledAxis::model(), {shifted(sound(31), "rate_dps", 2)},
            {shifted(sound(32), "rate_dps", 2)}, {}, thermopower::plant::standard_catalogue());
  for (const auto* all : {&checked.train, &checked.held_out}) {
    const PreparedRecording& one = all->front();
    CHECK_FALSE(one.inputs().judged(Signal::rate_dps));
    CHECK(one.inputs().judged(Signal::angle_deg));
    REQUIRE(one.inputs().not_judged.size() == 1);
    CHECK(one.inputs().not_judged.front().sentence.find("the angular rate is not judged: it comes 0.02") ==
          0);
  }
  CHECK(std::count_if(checked.findings.begin(), checked.findings.end(), [](const Finding& one) {
          return one.kind == FindingKind::lagging_output && one.column == "rate_dps";
        }) == 2);
}

}  // namespace
