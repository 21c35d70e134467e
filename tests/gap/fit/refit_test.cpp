// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// A smaller explanation loses to a larger one only after it has been where that one is.
#include "../../catch.hpp"
#include "../plants.hpp"
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

TEST_CASE("the squares that a fit says it leaves are those of its residuals where it ended") {
  const Model model = axis_model();
  const std::vector<Inputs> inputs{prepare(model, swinging(1.4e-3, 13))};
  const FitProblem problem = problem_of(model, inputs);
  const Attribution attribution(problem);
  FitOptions options;
  options.iterations = GENERATE(1, 2, 5, 25);
  options.relative_decrease = GENERATE(1e-1, 1e-5);
  options.curvature = GENERATE(false, true);
  for (const char* const id : {"coulomb_friction", "stribeck_friction", "compliance"}) {
    Candidate one = attribution.fit({{standard_catalogue().find(id)}, {}}, options);
    for (int times = 0; times < 2; ++times) {
      const SignalSums sums = Attribution::sums(one, problem, one.fit.starts);
      INFO(id << ", " << options.iterations << " steps");
      for (std::size_t i = 0; i < signal_count; ++i) {
        CHECK(one.train.samples[i] == sums.samples[i]);
        CHECK(one.train.squares[i] == Approx(sums.squares[i]).epsilon(1e-9));
        for (std::size_t k = 0; k < SignalSums::block_count; ++k)
          CHECK(one.train.block_squares[i][k] == Approx(sums.block_squares[i][k]).epsilon(1e-9));
      }
      attribution.polish(one, options);
    }
  }
}

TEST_CASE("a sum of squares in another unit is that of residuals in that unit") {
  const std::vector<double> residuals{1.0, -2.0, 0.5, 3.0}, doubled{2.0, -4.0, 1.0, 6.0};
  SignalSums one, other;
  one.set(2, residuals, 1.0);
  one.scale(2, 2.0);
  other.set(2, doubled, 1.0);
  CHECK(one.squares == other.squares);
  CHECK(one.samples == other.samples);
  CHECK(one.block_squares == other.block_squares);
  CHECK(one.block_samples == other.block_samples);
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

TEST_CASE("friction that rises near standstill is found outside its transition, from inside it, too") {
  const Model model = axis_model();
  const std::vector<Inputs> inputs{
      prepare(model, joint_in_fine_steps(
                         [](double rate) {
                           const double rise = 0.005 * std::exp(-std::pow(rate / 0.12, 2.0));
                           return 1e-3 * rate + (0.006 + rise) * std::tanh(rate / 0.002);
                         },
                         13))};
  const FitProblem problem = problem_of(model, inputs);
  const Attribution attribution(problem);
  const Explanation stribeck{{standard_catalogue().find("stribeck_friction")}, {}};
  // A film as wide as the knee and a rise several times as large make nearly the same curve.
  const std::vector<Coordinate> list = coordinates(model, stribeck, standard_catalogue());
  Eigen::VectorXd inside(static_cast<Eigen::Index>(list.size()));
  const auto start_of = [](const std::string& name, double otherwise) {
    if (name == "stribeck_friction.Nm") return 0.006;
    if (name == "stribeck_friction.rise_Nm") return 0.035;
    if (name == "stribeck_friction.knee_rad_per_s") return 0.0635;
    if (name == "stribeck_friction.transition_rad_per_s") return 0.0948;
    return otherwise;
  };
  for (std::size_t i = 0; i < list.size(); ++i)
    inside[static_cast<Eigen::Index>(i)] =
        list[i].coordinate_of(start_of(list[i].name, list[i].value_of(list[i].start)));
  const Candidate found = attribution.fit_from(stribeck, {inside}, {});
  const auto value = [&](const char* parameter) {
    return found.value(found.place_of(*stribeck.effects.front(), parameter));
  };
  CHECK(found.train.mean(2) < 3.0);  // 174 inside; a film of another form leaves some
  CHECK(value("knee_rad_per_s") > value("transition_rad_per_s"));
  CHECK(value("knee_rad_per_s") == Approx(0.12).epsilon(0.2));
  CHECK(value("rise_Nm") == Approx(0.005).epsilon(0.2));
}

TEST_CASE(
    "a load off the axis is found wherever it hangs, though two of the phases that a fit starts from lead nowhere") {
  const Model model = axis_model();
  constexpr double weight_Nm = 4e-3;
  for (const int turned_deg : {0, 45, 90, 135, 180, 225, 270, 315}) {
    CAPTURE(turned_deg);
    test::AxisFault fault;
    fault.weight_Nm = weight_Nm;
    Recording r = test::axis_recording(fault, 2000, 12);
    r.set("angle_deg", r.column("angle_deg").array() + turned_deg);
    const std::vector<Inputs> inputs{prepare(model, r)};
    FitProblem problem = problem_of(model, inputs);
    problem.segments = cut(inputs, 0.2, plant_of(model));
    const Candidate found = Attribution(problem).fit({{standard_catalogue().find("imbalance")}, {}}, {});
    const auto size = static_cast<Eigen::Index>(model.calibrated().size());
    CHECK(found.list[static_cast<std::size_t>(size)].value_of(found.fit.point[size]) ==
          Approx(weight_Nm).epsilon(0.1));
  }
}
