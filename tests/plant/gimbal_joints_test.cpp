// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#include "../catch.hpp"
#include "gimbal_of_masses.hpp"

#include <cmath>
#include <vector>

// Three coupled joints against point masses on nested frames, which know of no moment of inertia.

namespace {

using namespace thermopower;
using Vector = PointMassGimbal::Vector;

PointMassGimbal skewed() {
  PointMassGimbal gimbal;
  gimbal.masses.push_back({2, 0.03, {0.04, 0.02, -0.03}});  // products and an imbalance
  gimbal.masses.push_back({1, 0.02, {-0.06, 0.05, 0.02}});  // of the arm, too
  gimbal.masses.push_back({0, 0.01, {-0.02, 0.05, 0.02}});
  gimbal.gravity_mps2 = {0.8, -1.1, 9.6};  // the frame stands askew
  gimbal.cable_Nm_per_rad = {0.02, 0.0, 0.01};
  return gimbal;
}

}  // namespace

TEST_CASE("the point masses that the gimbal is compared with keep their energy") {
  PointMassGimbal gimbal = skewed();
  gimbal.viscous_Nms_per_rad = gimbal.cable_Nm_per_rad = {0.0, 0.0, 0.0};
  Vector angle(0.3, 0.5, -0.7), rate(2.0, -1.5, 3.0);
  const double before = gimbal.energy(angle, rate);
  double least = 1e300, most = 0.0;
  for (int i = 0; i < 4000; ++i) {
    gimbal.step(angle, rate, Vector::Zero(), 0.001);
    const double moving = 0.5 * rate.dot(gimbal.inertia(angle) * rate);
    least = std::fmin(least, moving), most = std::fmax(most, moving);
  }
  CHECK(gimbal.energy(angle, rate) == Approx(before).margin(1e-6));
  CHECK(most - least > 1e-3);  // it did turn into the one and the other form
}

TEST_CASE("coupled joints move as the point masses do") {
  const PointMassGimbal gimbal = skewed();
  const plant::Model model = test::model_of(gimbal);
  plant::Inputs inputs;
  const Eigen::Index rows = 201;
  inputs.own = true;
  inputs.t_s = Eigen::VectorXd::LinSpaced(rows, 0.0, 2.0);
  inputs.runs = {{0, rows, ""}};
  inputs.own_inputs.assign(6, Eigen::VectorXd(rows));
  Vector angle(0.3, 0.4, -0.6), rate(1.0, -0.5, 1.5);
  std::vector<Vector> angles, rates;
  for (Eigen::Index row = 0; row < rows; ++row) {
    const double t = inputs.t_s[row];
    const Vector drive(0.2 * std::sin(7.0 * t), 0.15 * std::cos(5.0 * t), 0.1 * std::sin(11.0 * t));
    for (int i = 0; i < 3; ++i) {
      inputs.own_inputs[static_cast<std::size_t>(i)][row] = drive[i];
      inputs.own_inputs[static_cast<std::size_t>(3 + i)][row] = gimbal.gravity_mps2[i];
    }
    angles.push_back(angle), rates.push_back(rate);
    for (int k = 0; k < 10; ++k) gimbal.step(angle, rate, drive, 0.001);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    inputs.measured[i] = Eigen::VectorXd::Constant(rows, angles[0][static_cast<int>(i)] * 57.29577951308232);
    inputs.measured[3 + i] =
        Eigen::VectorXd::Constant(rows, rates[0][static_cast<int>(i)] * 57.29577951308232);
  }
  const auto worst_deg = [&](const plant::Model& one) {
    const plant::Plant& plant = plant::plant_of(one);
    const auto rollout = plant.rollout(one, *plant.effects(), {}, {}, plant::SimulationMode::free_running);
    plant::Readings readings;
    rollout->roll({&inputs, inputs.runs[0], 0, rows, false, false, false}, plant::Start::Zero(6), readings);
    double worst = 0.0;
    for (Eigen::Index row = 0; row < rows; ++row)
      for (int i = 0; i < 3; ++i)
        worst = std::fmax(worst, std::fabs(readings.value(row, i) -
                                           angles[static_cast<std::size_t>(row)][i] * 57.29577951308232));
    return worst;
  };
  CHECK(worst_deg(model) < 0.01);
  // Each of its terms is seen by this motion: without it, the joints go elsewhere.
  for (const char* effect : {"coupling", "camera_products", "arm_products", "camera_imbalance",
                             "arm_imbalance", "yaw_imbalance", "yaw_cable_spring"}) {
    plant::Model without = model;
    without.effects.erase(effect);
    INFO(effect);
    CHECK(worst_deg(without) > 0.3);
  }
}
