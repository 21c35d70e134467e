// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// What a command did between the rows, found from the motion of axes whose loop is known: one that sets its command 1000
// times a second and logs some of them, and one that logs each.
#include "../../catch.hpp"

#include "sampled_axis.hpp"

#include <thermopower/gap/check.hpp>
#include <thermopower/gap/data/command_between_rows.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

#include <random>

using namespace thermopower::gap;
using namespace thermopower::gap::engine;

namespace {

/// How much of the command's next step the motion shows; none where it held.
double share_of(const Recording& r) {
  const Inputs inputs = prepare(test::SampledAxis::model(), r);
  CommandBetweenRows between;
  between.add(inputs, inputs.drive_A);
  const auto share = between.steady();
  return share ? share->value : 0.0;
}

/// A minute of an axis, a hundred rows a second.
struct Log {
  static constexpr Eigen::Index rows = 6000;
  static constexpr double step_s = 0.01;
  Eigen::VectorXd t_s{rows}, drive_A{rows}, angle_deg{rows}, rate_dps{rows};

  Log() {
    for (Eigen::Index k = 0; k < rows; ++k) t_s[k] = step_s * static_cast<double>(k);
  }

  Recording recording(const char* name) const {
    Recording r;
    r.name = name;
    r.t_s = t_s;
    r.set("drive_A", drive_A);
    r.set("angle_deg", angle_deg);
    r.set("rate_dps", rate_dps);
    return r;
  }
};

/// An axis in a loop that is closed anew at each row and follows steps, through a drive that gives nothing for small commands and
/// no more than so much for large ones, and gears that rub a share of it; in steps of 0.1 ms.
Recording in_a_loop(double dead_A, double most_A, double rubbed, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  constexpr int inner = 100;
  constexpr double step_s = Log::step_s;
  Log log;
  double rad = 0.0, radps = 0.0, target_rad = 0.0;
  for (Eigen::Index k = 0; k < Log::rows; ++k) {
    if (k % 40 == 0) target_rad = 0.2 * normal(random);
    log.angle_deg[k] = 57.29578 * rad + 0.01 * normal(random);
    log.rate_dps[k] = 57.29578 * radps + 0.1 * normal(random);
    log.drive_A[k] = 1.5 * (target_rad - log.angle_deg[k] / 57.29578) - 0.2 * log.rate_dps[k] / 57.29578;
    const double beyond_A = std::max(0.0, std::min(std::abs(log.drive_A[k]), most_A) - dead_A);
    for (int i = 0; i < inner; ++i) {
      const double geared_A =
          std::copysign(beyond_A, log.drive_A[k]) - rubbed * beyond_A * std::tanh(radps / 0.01);
      radps += (0.09 * geared_A - 0.002 * radps) / 0.002 * step_s / inner;
      rad += radps * step_s / inner;
    }
  }
  return log.recording("in a loop");
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
    for (const auto effect : {test::SampledAxis::Effect::none, test::SampledAxis::Effect::friction}) {
      const Recording r = test::SampledAxis(effect, 30.0, 11).logged_each(kept);
      CHECK(share_of(r) == Approx(expected).margin(0.05));
    }
  }
  const Recording r = test::SampledAxis(test::SampledAxis::Effect::friction, 30.0, 12).logged_each(20);
  CHECK(share_of(without(r, "angle_deg")) == Approx(0.475).margin(0.05));
  CHECK(share_of(without(r, "rate_dps")) == Approx(0.475).margin(0.05));
}

TEST_CASE("a command that holds from row to row is left as it is, and one that comes late, too") {
  for (const auto effect : {test::SampledAxis::Effect::none, test::SampledAxis::Effect::friction,
                            test::SampledAxis::Effect::cogging}) {
    const Recording r = test::SampledAxis(effect, 60.0, 13, 20).logged_each(20);
    CHECK(share_of(r) == 0.0);
  }
  Recording late = test::SampledAxis(test::SampledAxis::Effect::none, 60.0, 14, 20).logged_each(20);
  Eigen::VectorXd early = late.column("drive_A");
  for (Eigen::Index i = 0; i + 2 < early.size(); ++i) early[i] = early[i + 2];
  late.set("drive_A", early);  // logged two rows before it acts
  CHECK(share_of(late) == 0.0);
  const CheckedRecordings checked =
      check(test::SampledAxis::model(), {late}, {}, {}, thermopower::plant::standard_catalogue());
  CHECK(checked.train.front().recording().column("drive_A") == early);
}

TEST_CASE("a command that holds in a loop did not go on for what a dead band, a limit or gears take of it") {
  constexpr double no_limit_A = 1e3;
  for (const std::uint64_t seed : {45, 46, 47}) {
    CAPTURE(seed);
    for (const double dead_A : {0.0, 0.01, 0.02, 0.03})
      CHECK(share_of(in_a_loop(dead_A, no_limit_A, 0.0, seed)) == 0.0);
    CHECK(share_of(in_a_loop(0.0, 0.25, 0.0, seed)) == 0.0);
    CHECK(share_of(in_a_loop(0.0, no_limit_A, 0.3, seed)) == 0.0);
  }
}

}  // namespace
