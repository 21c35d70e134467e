// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// A smaller explanation loses to a larger one only after it has been where that one is.
#include "../../catch.hpp"
#include "../fixture.hpp"

#include <thermopower/gap/fit/attribution.hpp>

#include <cmath>
#include <cstdint>

using namespace engine_fixture;

namespace {

/// A joint of the fixture's constants but this viscous friction: semi-implicit steps of 10 us.
Recording swinging(double viscous_Nms_per_rad, std::uint64_t seed) {
  constexpr Eigen::Index rows = 2000;
  constexpr double dt_s = 0.01, step_s = 1e-5, angle_noise_deg = 0.02, rate_noise_dps = 0.15;
  Recording recording;
  recording.name = "swinging";
  recording.t_s = Eigen::VectorXd::LinSpaced(rows, 0.0, dt_s * static_cast<double>(rows - 1));
  Eigen::VectorXd drive(rows), angle(rows), rate(rows);
  Noise noise(seed);
  double position = 0.0, speed = 0.0;
  for (Eigen::Index i = 0; i < rows; ++i) {
    const double t_s = recording.t_s[i];
    drive[i] = 0.16 * std::sin(1.7 * t_s) * std::sin(0.31 * t_s) + 0.05 * std::sin(5.3 * t_s);
    angle[i] = position * 57.29577951308232 + angle_noise_deg * noise.normal();
    rate[i] = speed * 57.29577951308232 + rate_noise_dps * noise.normal();
    for (int k = 0; k < static_cast<int>(dt_s / step_s + 0.5); ++k) {
      speed += step_s / 1e-3 * (0.1 * drive[i] - viscous_Nms_per_rad * speed);
      position += step_s * speed;
    }
  }
  recording.set("drive_A", drive);
  recording.set("angle_deg", angle);
  recording.set("rate_dps", rate);
  return recording;
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
