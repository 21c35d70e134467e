// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// A fit compares a step's sum of squares with the best one so far. The short way must say what the residuals say.
#include "../../catch.hpp"
#include "../fixture.hpp"
#include "../plants.hpp"

#include <thermopower/gap/fit/fit_problem.hpp>

#include <algorithm>
#include <set>
#include <string>

using namespace engine_fixture;

namespace {

/// Residuals of every segment, squared and added by the long way.
std::vector<double> squares_by_segment(const FitProblem& problem, const Explanation& explanation,
                                       const std::vector<Coordinate>& list, const Eigen::VectorXd& at,
                                       const std::vector<Start>& starts) {
  std::vector<double> sums;
  problem.evaluate(explanation, list, at, starts, false,
                   [&](std::size_t, const FitProblem::Residuals& residuals) {
                     double sum = 0.0;
                     for (double one : residuals.value) sum += one * one;
                     sums.push_back(sum);
                   });
  return sums;
}

/// The windows of some recordings, as a fit is asked about them. @param model, inputs  must outlive it
FitProblem posed(const Model& model, const std::vector<Inputs>& inputs) {
  FitProblem problem = problem_of(model, inputs);
  problem.sigma = thermopower::plant::for_each_signal(0.1);
  problem.segments = cut(inputs, 0.5, plant_of(model));
  return problem;
}

Explanation explanation_of(const std::vector<std::string>& ids) {
  Explanation explanation;
  for (const std::string& id : ids) explanation.effects.push_back(standard_catalogue().find(id));
  return explanation;
}

/// Beside where coordinates start. @param by  as far, within their bounds
Eigen::VectorXd beside_starts(const std::vector<Coordinate>& list, double by = 0.0) {
  Eigen::VectorXd at(static_cast<Eigen::Index>(list.size()));
  for (std::size_t i = 0; i < list.size(); ++i)
    at[static_cast<Eigen::Index>(i)] = std::clamp(list[i].start + by, list[i].lower, list[i].upper);
  return at;
}

}  // namespace

TEST_CASE("a sum of squares is that of the residuals, and ends early only above its limit") {
  const bool moving = GENERATE(false, true);
  const char* const id =
      moving ? "compliance" : "radiation";  // one that carries its state from window to window
  const Model model = moving ? axis_model() : bench_model();
  const Recording recording =
      moving ? test::axis_recording({0.02, 0.0, 1.0, 0}, 1500, 7) : test::bench_recording({}, 1500, 7);
  std::vector<Inputs> inputs{prepare(model, recording)};
  inputs.front().repeats = Eigen::VectorXd::LinSpaced(inputs.front().rows(), 1.0, 4.0);
  const FitProblem problem = posed(model, inputs);
  const Explanation explanation = explanation_of({id});
  const std::vector<Coordinate> list = coordinates(model, explanation, standard_catalogue());
  const Eigen::VectorXd at = beside_starts(list);
  std::vector<Start> starts = problem.measured_starts();
  for (std::size_t i = 0; i < starts.size(); ++i) starts[i].setConstant(0.01 * static_cast<double>(i % 3));
  const std::vector<double> parts = squares_by_segment(problem, explanation, list, at, starts);
  double whole = 0.0;
  for (double one : parts) whole += one;
  REQUIRE(whole > 0.0);
  CHECK(problem.squares(explanation, list, at, starts, 1e300) == Approx(whole).epsilon(1e-12));
  CHECK(problem.squares(explanation, list, at, starts, 1.000001 * whole) == Approx(whole).epsilon(1e-12));
  for (double share : {0.0, 0.3, 0.9}) {
    const double sum = problem.squares(explanation, list, at, starts, share * whole);
    CHECK(sum > share * whole);
    CHECK(sum <= whole * (1.0 + 1e-12));
  }
  if (parts.size() > 10) CHECK(problem.squares(explanation, list, at, starts, 0.3 * whole) < 0.7 * whole);
}

TEST_CASE(
    "residuals with their derivatives are those without, and what comes after a refusal is not looked at") {
  const Model model = axis_model();
  std::vector<Inputs> inputs{prepare(model, test::axis_recording({0.02, 0.0, 1.0, 0}, 1500, 7))};
  const FitProblem problem = posed(model, inputs);
  REQUIRE(problem.segments.size() > 4);
  // More coordinates than one pass of derivatives carries.
  const Explanation explanation = explanation_of({"compliance", "stribeck_friction", "cogging"});
  const std::vector<Coordinate> list = coordinates(model, explanation, standard_catalogue());
  const Eigen::VectorXd at = beside_starts(list);
  const std::vector<Start> starts = problem.measured_starts();
  const std::vector<double> parts = squares_by_segment(problem, explanation, list, at, starts);
  for (const std::size_t most : {std::size_t{1}, std::size_t{3}, parts.size()}) {
    std::vector<double> seen;
    problem.evaluate_while(explanation, list, at, starts, true,
                           [&](std::size_t index, const FitProblem::Residuals& one) {
                             CHECK(index == seen.size());
                             CHECK(one.jacobian.rows() == one.value.size());
                             CHECK(one.jacobian.cols() > static_cast<Eigen::Index>(list.size()));
                             seen.push_back(one.value.squaredNorm());
                             return seen.size() < most;
                           });
    REQUIRE(seen.size() == most);
    for (std::size_t i = 0; i < most; ++i) CHECK(seen[i] == Approx(parts[i]).epsilon(1e-6));
  }
}

TEST_CASE("a derivative is the same whatever other directions are asked for with it") {
  const Model model = axis_model();
  std::vector<Inputs> inputs{prepare(model, test::axis_recording({0.02, 0.0, 1.0, 0}, 600, 7))};
  const FitProblem problem = posed(model, inputs);
  const std::vector<Start> starts = problem.measured_starts();
  using Ids = std::vector<std::string>;
  std::set<bool> seen_wide;
  for (const Ids& ids : {Ids{"imbalance"}, Ids{"imbalance", "stribeck_friction"},
                         Ids{"imbalance", "stribeck_friction", "cogging"},
                         Ids{"compliance", "stribeck_friction", "cogging", "drive_lag", "torque_ripple"}}) {
    const Explanation explanation = explanation_of(ids);
    const std::vector<Coordinate> list = coordinates(model, explanation, standard_catalogue());
    const Eigen::VectorXd at = beside_starts(list, 0.01);
    const auto jacobian = [&](const std::vector<Coordinate>& asked) {
      std::vector<Eigen::MatrixXd> parts;
      problem.evaluate(explanation, asked, at, starts, true,
                       [&](std::size_t, const FitProblem::Residuals& one) { parts.push_back(one.jacobian); });
      return parts;
    };
    const std::vector<Eigen::MatrixXd> all = jacobian(list);
    const auto n = static_cast<Eigen::Index>(list.size());
    const auto free = std::count_if(list.begin(), list.end(), [](const auto& one) { return !one.still; });
    seen_wide.insert(free + 2 > thermopower::plant::dual_width);
    for (Eigen::Index k = 0; k < n + 2; ++k) {
      std::vector<Coordinate> alone = list;
      for (Eigen::Index i = 0; i < n; ++i)
        alone[static_cast<std::size_t>(i)].still = alone[static_cast<std::size_t>(i)].still || i != k;
      const std::vector<Eigen::MatrixXd> one = jacobian(alone);
      for (std::size_t i = 0; i < one.size(); ++i)
        CHECK((one[i].col(k) - all[i].col(k)).norm() <= 1e-5 * all[i].col(k).norm());
    }
  }
  CHECK(seen_wide.size() == 2);
}
