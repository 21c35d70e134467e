// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// A smaller explanation loses to a larger one only after it has been where that one is.
#include "../../catch.hpp"
#include "joint_in_fine_steps.hpp"

#include <thermopower/gap/fit/attribution.hpp>

#include <cmath>
#include <cstdint>

using namespace engine_fixture;

namespace {

/// A joint with this viscous friction.
Recording swinging(double viscous_Nms_per_rad, std::uint64_t seed) {
  return joint_in_fine_steps([&](double rate) { return viscous_Nms_per_rad * rate; }, seed);
}

}  // namespace

TEST_CASE(
    "a fit made in units of a larger noise gives way to a better one found in those of the present noise") {
  const Model model = axis_model();
  const std::vector<Inputs> inputs{prepare(model, swinging(1.4e-3, 11))};
  const FitProblem problem = problem_of(model, inputs);
  const Attribution attribution(problem);
  const Candidate leader = attribution.fit({{standard_catalogue().find("coulomb_friction")}, {}}, {});
  REQUIRE(leader.train.mean(2) < 1.3);
  // As it is configured, in units of a noise that was thought to be far larger.
  FitOptions none;
  none.iterations = 0;
  Candidate stale = attribution.fit(leader.explanation, none);
  stale.fit.cost = 1e-3 * leader.fit.cost;
  REQUIRE(Attribution::sums(stale, problem, stale.fit.starts).mean(2) > 100.0);
  attribution.refit_from(stale, leader, {}, 0.5);
  INFO("mean square of the angle " << stale.train.mean(2) << ", of the rate " << stale.train.mean(3));
  CHECK(stale.train.mean(2) < 1.3);
  CHECK(stale.train.mean(3) < 1.3);
}

TEST_CASE("a fit that is better where it stands is kept") {
  const Model model = axis_model();
  const std::vector<Inputs> inputs{prepare(model, swinging(1e-3, 12))};
  const FitProblem problem = problem_of(model, inputs);
  const Attribution attribution(problem);
  Candidate right = attribution.fit({{standard_catalogue().find("coulomb_friction")}, {}}, {});
  const Eigen::VectorXd before = right.fit.point;
  Candidate far = attribution.fit({}, {});
  far.fit.point.setConstant(0.9);
  FitOptions a_step;
  a_step.iterations = 1;
  attribution.refit_from(right, far, a_step, 0.5);
  CHECK(right.fit.point == before);
}
