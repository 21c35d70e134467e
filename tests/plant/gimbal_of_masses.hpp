// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../../examples/14_gimbal/point_masses.hpp"

#include <thermopower/plant/actuator_plant.hpp>
#include <thermopower/plant/gimbal_joints.hpp>

#include <string>

namespace test {

/// Integral of `value(at_m)` over the masses of a stage.
template <class Value>
inline double over(const PointMassGimbal& gimbal, int stage, Value&& value) {
  double sum = 0.0;
  for (const PointMassGimbal::Mass& mass : gimbal.masses)
    if (mass.stage == stage) sum += mass.kg * value(mass.at_m);
  return sum;
}

/// The library's gimbal with the constants and couplings that the masses have.
inline thermopower::plant::Model model_of(const PointMassGimbal& gimbal) {
  thermopower::plant::Model model = thermopower::plant::gimbal_model("gimbal");
  const Eigen::Matrix3d inertia = gimbal.inertia(PointMassGimbal::Vector::Zero());
  const char* names[] = {"yaw", "roll", "pitch"};
  for (int i = 0; i < 3; ++i) {
    const auto at = static_cast<std::size_t>(i);
    model.set(names[i] + std::string("_inertia_kgm2"), inertia(i, i));
    model.set(names[i] + std::string("_viscous_Nms_per_rad"), gimbal.viscous_Nms_per_rad[at]);
    model.set(names[i] + std::string("_torque_constant_Nm_per_A"), gimbal.torque_constant_Nm_per_A[at]);
    if (gimbal.cable_Nm_per_rad[at] > 0.0)
      model.effects[names[i] + std::string("_cable_spring")] = {{"Nm_per_rad", gimbal.cable_Nm_per_rad[at]},
                                                                {"at_0_Nm", 0.0}};
  }
  const auto moment = [](int plus, int minus) {
    return [=](const PointMassGimbal::Vector& r) { return r[plus] * r[plus] - r[minus] * r[minus]; };
  };
  model.effects["coupling"] = {
      {"camera_z_less_x_kgm2", over(gimbal, 2, moment(0, 2))},
      {"rolled_yaw_kgm2", over(gimbal, 1, moment(2, 1)) + over(gimbal, 2, moment(2, 1))}};
  const auto product = [&](int stage, int a, int b) {
    return over(gimbal, stage, [=](const PointMassGimbal::Vector& r) { return r[a] * r[b]; });
  };
  for (const int stage : {1, 2})
    model.effects[stage == 1 ? "arm_products" : "camera_products"] = {{"xy_kgm2", product(stage, 0, 1)},
                                                                      {"yz_kgm2", product(stage, 1, 2)},
                                                                      {"xz_kgm2", product(stage, 0, 2)}};
  const auto lever = [&](int stage, int axis) {
    return over(gimbal, stage, [=](const PointMassGimbal::Vector& r) { return r[axis]; });
  };
  model.effects["camera_imbalance"] = {
      {"ahead_kgm", lever(2, 0)}, {"right_kgm", lever(2, 1)}, {"below_kgm", lever(2, 2)}};
  model.effects["yaw_imbalance"] = {{"ahead_kgm", lever(0, 0) + lever(1, 0)}, {"right_kgm", lever(0, 1)}};
  model.effects["arm_imbalance"] = {{"right_kgm", lever(1, 1)}, {"below_kgm", lever(1, 2)}};
  return model;
}

}  // namespace test
