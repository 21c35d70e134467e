// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#include "../../catch.hpp"

#include <thermopower/gap/compare/bootstrap_weights.hpp>
#include <thermopower/gap/compare/verdict_table.hpp>

#include <cmath>
#include <string>
#include <vector>

using namespace thermopower::gap;
using namespace thermopower::gap::engine;

namespace {

/// A signal of the printed table, in units of its floor.
GapScore row(double before, double recalibrated, double after) {
  GapScore gap;
  gap.before = before;
  gap.recalibrated = recalibrated;
  gap.after = after;
  gap.noise_floor = 1.0;
  gap.shrunk_by = 1.0 - after / before;
  gap.ci95 = {gap.shrunk_by - 0.02, gap.shrunk_by + 0.02};
  return gap;
}

Verdict verdict_of(const std::vector<GapScore>& table, double probability, bool only_constants = false,
                   int beyond_known = 0, double together = 1.0) {
  DecisionNumbers numbers = numbers_of(table, probability);
  numbers.together = together;
  return decide(numbers, only_constants, beyond_known, true).verdict;
}

}  // namespace

TEST_CASE("no gap is said only where the table as configured shows none") {
  CHECK(verdict_of({row(1.0, 1.0, 1.0), row(1.1, 1.0, 1.0)}, 0.99) == Verdict::no_gap);
  // Constants within what is known suffice, and the configured model does not: the constants are the answer.
  CHECK(verdict_of({row(46.0, 1.0, 1.0)}, 0.9, true, 0) == Verdict::explained);
  CHECK(verdict_of({row(1.0, 1.0, 1.0), row(5.0, 1.0, 1.0)}, 0.9, true, 0) == Verdict::explained);
  // Windows twice as long show a gap that the printed ones do not.
  DecisionNumbers numbers = numbers_of({row(1.1, 1.0, 1.0)}, 0.3);
  numbers.twice_horizon = 3.0;
  CHECK(decide(numbers, false, 0, true).verdict != Verdict::no_gap);
}

TEST_CASE("beside a rest, a cause that spares the constants need not beat constants that move far") {
  const DecisionNumbers numbers = numbers_of({row(60.0, 2.5, 2.5)}, 0.99),
                        small = numbers_of({row(60.0, 40.0, 40.0)}, 0.99);
  CHECK(decide(numbers, false, 3, true).verdict == Verdict::partial);
  CHECK(decide(numbers, false, 3, false).verdict == Verdict::unexplained);  // it moves them as well
  CHECK(decide(numbers, false, 0, true).verdict == Verdict::unexplained);   // they need not move far
  CHECK(decide(small, false, 3, true).verdict == Verdict::unexplained);     // neither closes half
}

TEST_CASE("constants that close most of a gap are a part of the answer, however well they were known") {
  for (const int beyond_known : {0, 1, 2}) {
    CHECK(verdict_of({row(46.0, 8.0, 8.0)}, 1.0, true, beyond_known) == Verdict::partial);
    CHECK(verdict_of({row(46.0, 30.0, 30.0)}, 1.0, true, beyond_known) == Verdict::unexplained);
  }
  GapScore unsure = row(46.0, 8.0, 8.0);
  unsure.ci95.low = 0.2;
  CHECK(verdict_of({unsure}, 1.0, true, 1) == Verdict::unexplained);
}

TEST_CASE("constants that leave a gap explain nothing") {
  // A gap that shows in windows twice as long only, and that no constant closes.
  GapScore unproven = row(1.4, 1.3, 1.3);
  unproven.ci95.low = -0.1;
  DecisionNumbers numbers = numbers_of({unproven}, 1.0);
  numbers.twice_horizon = 6.0;
  CHECK(decide(numbers, true, 0, true).verdict == Verdict::unexplained);
  numbers.twice_horizon = 1.2;
  CHECK(decide(numbers, true, 0, true).verdict == Verdict::no_gap);
}

TEST_CASE(
    "where one factor is common to several constants, nothing is explained; a constant that may be that factor is one of "
    "several answers") {
  DecisionNumbers numbers = numbers_of({row(20.0, 1.0, 1.0)}, 1.0);
  numbers.common_factor = CommonFactor::of_no_constant;
  CHECK(decide(numbers, true, 2, true).reason == Reason::common_factor);
  CHECK(decide(numbers, false, 2, true).verdict == Verdict::unexplained);
  numbers.common_factor = CommonFactor::may_be_constant;
  CHECK(decide(numbers, true, 2, true).verdict == Verdict::ambiguous);
  CHECK(decide(numbers, true, 0, true).reason == Reason::constants_within_known);
}

TEST_CASE("a cause near the floor explains, if it is sure") {
  CHECK(verdict_of({row(20.0, 15.0, 1.1)}, 0.95) == Verdict::explained);
  CHECK(verdict_of({row(20.0, 15.0, 1.1)}, 0.85) == Verdict::ambiguous);
  // Refitted constants within what is known do as well, and the cause is not sure: the constants are the answer.
  DecisionNumbers numbers = numbers_of({row(20.0, 1.0, 1.0)}, 0.7);
  CHECK(decide(numbers, false, 0, true).reason == Reason::constants_within_known);
  CHECK(decide(numbers, false, 2, true).verdict == Verdict::ambiguous);
}

TEST_CASE(
    "a cause beside which constants move as far as without it is not told from them where it adds nothing") {
  const DecisionNumbers adds_nothing = numbers_of({row(20.0, 1.2, 1.1)}, 0.99);
  CHECK(decide(adds_nothing, false, false, false).reason == Reason::cause_or_constants);
  CHECK(decide(adds_nothing, false, false, true).verdict == Verdict::explained);
  // It brings the data to the floor, and constants alone do not.
  CHECK(decide(numbers_of({row(20.0, 5.0, 1.1)}, 0.99), false, 2, false).verdict == Verdict::explained);
  // Constants leave a little more than the floor, and it hardly less.
  CHECK(decide(numbers_of({row(20.0, 1.7, 1.4)}, 0.99), false, 2, false).verdict == Verdict::unexplained);
}

TEST_CASE("a cause beside a rest is named where it closes a material part, beyond what constants do") {
  CHECK(verdict_of({row(20.0, 18.0, 6.0)}, 0.95) == Verdict::partial);
  CHECK(verdict_of({row(20.0, 18.0, 6.0)}, 0.6, false, 0, 0.7) == Verdict::partial);
  // Another class has the rest of the probability: one name would say too much.
  CHECK(verdict_of({row(20.0, 18.0, 6.0)}, 0.6) == Verdict::ambiguous);
  CHECK(verdict_of({row(20.0, 18.0, 6.0)}, 0.4) == Verdict::ambiguous);
  CHECK(verdict_of({row(20.0, 18.0, 6.0)}, 0.4, false, 0, 0.5) == Verdict::unexplained);
  CHECK(verdict_of({row(20.0, 7.0, 6.0)}, 1.0) == Verdict::unexplained);  // constants do nearly as well
  GapScore unsure = row(20.0, 18.0, 6.0);
  unsure.ci95.low = -0.5;  // the interval holds "nothing"
  CHECK(verdict_of({unsure}, 1.0) == Verdict::unexplained);
  CHECK(verdict_of({row(20.0, 20.0, 19.5)}, 1.0) == Verdict::unexplained);  // seen, and closes nothing
}

TEST_CASE("the share left is the mean over signals that have a gap, and counts nothing below a floor") {
  const ShareLeft one = share_left({row(16.0, 16.0, 4.0), row(1.2, 1.2, 1.2)});
  CHECK(one.of_configured == Approx(0.25));
  const ShareLeft both = share_left({row(16.0, 8.0, 4.0), row(100.0, 100.0, 100.0)});
  CHECK(both.of_configured == Approx(0.5));
  CHECK(both.of_refitted_constants == Approx(std::sqrt(0.5)));
  CHECK(share_left({row(10.0, 10.0, 0.1)}).of_configured == Approx(0.1));
}

TEST_CASE("every reason has a sentence and a code of its own") {
  std::vector<std::string> seen;
  for (int i = 0; i <= static_cast<int>(Reason::simulation_runs_away); ++i) {
    const Reason reason = static_cast<Reason>(i);
    CHECK(std::string(to_string(reason)).size() > 20);
    for (const std::string& other : seen) CHECK(other != code_of(reason));
    seen.push_back(code_of(reason));
  }
}

TEST_CASE("what is better in every block is certain, and what is better in one block alone is not") {
  Eigen::MatrixXd density(2, 8);
  density.row(0).setZero();
  density.row(1).setConstant(3.0);
  const Eigen::VectorXd prior = Eigen::VectorXd::Zero(2);
  CHECK(bootstrap_weights(density, prior)[1] > 0.999);
  density.row(1).setConstant(-3.0);
  density(1, 3) = 45.0;  // as much in sum
  const double weight = bootstrap_weights(density, prior)[1];
  CHECK(weight > 0.3);
  CHECK(weight < 0.9);
}

TEST_CASE("without data the prior says how likely explanations are") {
  const Eigen::Vector2d prior(0.0, std::log(3.0));
  CHECK(bootstrap_weights(Eigen::MatrixXd::Zero(2, 4), prior)[1] == Approx(0.75));
}
