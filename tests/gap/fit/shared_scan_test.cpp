// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Starts that are one simulation are looked at in one. It must promise of each what a look at it alone promises.
#include "../../catch.hpp"
#include "../fixture.hpp"
#include "../plants.hpp"

#include <thermopower/gap/fit/attribution.hpp>
#include <thermopower/gap/fit/shared_scan.hpp>

#include <cmath>
#include <string>
#include <vector>

using namespace engine_fixture;

namespace {

/// Every combination of the starts of an explanation's parameters.
std::vector<Eigen::VectorXd> all_starts(const Model& model, const Explanation& explanation,
                                        const std::vector<Coordinate>& list) {
  Eigen::VectorXd base(static_cast<Eigen::Index>(list.size()));
  for (std::size_t i = 0; i < list.size(); ++i) base[static_cast<Eigen::Index>(i)] = list[i].start;
  std::vector<Eigen::VectorXd> points{base};
  Eigen::Index at = static_cast<Eigen::Index>(model.calibrated().size());
  for (const CatalogueEntry* entry : explanation.effects)
    for (const thermopower::plant::Parameter& parameter : entry->info.parameters) {
      std::vector<Eigen::VectorXd> wider;
      for (const Eigen::VectorXd& point : points)
        for (const double start : parameter.starts) {
          wider.push_back(point);
          wider.back()[at] = list[static_cast<std::size_t>(at)].coordinate_of(start);
        }
      points = wider;
      ++at;
    }
  return points;
}

/// Compares what is promised of every start with what a look at it alone promises.
/// @return how many starts there are
std::size_t compare(const Model& model, const Recording& recording, const std::vector<std::string>& ids,
                    double horizon_s) {
  const std::vector<Inputs> inputs{prepare(model, recording)};
  FitProblem problem;
  problem.model = &model;
  problem.catalogue = &standard_catalogue();
  problem.sigma = thermopower::plant::for_each_signal(0.1);
  problem.segments = cut(inputs, horizon_s, plant_of(model));
  Explanation explanation;
  for (const std::string& id : ids) explanation.effects.push_back(standard_catalogue().find(id));
  const std::vector<Coordinate> list = coordinates(model, explanation, standard_catalogue());
  const std::vector<Eigen::VectorXd> points = all_starts(model, explanation, list);
  const std::vector<double> shared = SharedScan(problem, explanation, list).costs(points);
  REQUIRE(shared.size() == points.size());
  Fitter alone(problem, explanation, list);
  for (std::size_t i = 0; i < points.size(); ++i) {
    CAPTURE(ids, i, points[i].transpose());
    const double cost = alone.scan(points[i]);
    // An effect may need what these recordings have not.
    if (std::isnan(cost)) CHECK(std::isnan(shared[i]));
    else CHECK(shared[i] == Approx(cost).epsilon(1e-9));
  }
  return points.size();
}

}  // namespace

TEST_CASE("starts that share a simulation promise what each of them does alone, of every effect") {
  const Model axis = axis_model(), bench = bench_model();
  const Recording moving = test::axis_recording({0.02, 0.0, 1.0, 0}, 600, 7);
  const Recording warming = test::bench_recording({}, 600, 7);
  for (const CatalogueEntry& entry : standard_catalogue().entries()) {
    const bool is_axis = entry.hooks.drive || entry.hooks.axis || entry.hooks.friction ||
                         entry.hooks.axis_readings || entry.hooks.axis_structure;
    compare(is_axis ? axis : bench, is_axis ? moving : warming, {entry.info.id}, is_axis ? 0.5 : 60.0);
  }
}

TEST_CASE("a torque that repeats in a turn is looked at beside another cause, before it and behind it") {
  const Model axis = axis_model();
  const Recording moving = test::axis_recording({0.02, 0.0, 1.0, 0}, 600, 7);
  CHECK(compare(axis, moving, {"cogging", "coulomb_friction"}, 0.5) > 40);
  CHECK(compare(axis, moving, {"coulomb_friction", "cogging"}, 0.5) > 40);
  CHECK(compare(axis, moving, {"imbalance", "torque_ripple"}, 0.5) > 40);
  compare(axis, moving, {"compliance", "cogging"}, 0.5);  // carries its state from window to window
}

TEST_CASE("the widest transition among frictions holds for all of them, of one that is not there yet, too") {
  const Model axis = axis_model();
  const Recording moving = test::axis_recording({0.02, 0.0, 1.0, 0}, 600, 7);
  CHECK(compare(axis, moving, {"stribeck_friction", "asymmetric_friction"}, 0.5) > 40);
  CHECK(compare(axis, moving, {"coulomb_friction", "stribeck_friction"}, 0.5) > 40);
  Model rubbing = axis;
  rubbing.effects["coulomb_friction"] = {{"Nm", 0.01}, {"transition_rad_per_s", 0.3}};
  CHECK(compare(rubbing, moving, {"stribeck_friction"}, 0.5) > 10);
}
