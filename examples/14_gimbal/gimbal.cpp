// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

/// @file gimbal.cpp
/// Problem: a camera gimbal of three joints does not move as its simulation says.
/// Model: plant::GimbalJoints, three joints that are simulated apart or coupled.
/// Here the "real" gimbal is point_masses.hpp, which shares no equation with the model. First its joints carry each
/// other, which the simulation leaves out; then the simulation knows that, and the camera is mounted off its balance.

#include "../print_diagnosis.hpp"
#include "point_masses.hpp"

#include <thermopower/gap.hpp>
#include <thermopower/plant/gimbal_joints.hpp>

#include <cstdio>

namespace tp = thermopower;

namespace {

//! [gimbal model]
/// The joints by themselves: what each moves where all angles are 0, and its motor.
tp::gap::Model joints_apart() {
  tp::gap::Model model = tp::plant::gimbal_model("gimbal");
  model.set("yaw_inertia_kgm2", 2.244e-3);
  model.set("roll_inertia_kgm2", 7.97e-4);
  model.set("pitch_inertia_kgm2", 1.171e-3);
  model.set("yaw_viscous_Nms_per_rad", 1.5e-3);
  model.set("roll_viscous_Nms_per_rad", 1e-3);
  model.set("pitch_viscous_Nms_per_rad", 8e-4);
  model.set("yaw_torque_constant_Nm_per_A", 0.12);
  model.set("roll_torque_constant_Nm_per_A", 0.1);
  model.set("pitch_torque_constant_Nm_per_A", 0.08);
  return model;
}
//! [gimbal model]

}  // namespace

int main() {
  const tp::gap::Model apart = joints_apart();
  const PointMassGimbal gimbal;
  const tp::gap::Diagnosis first =
      tp::gap::diagnose(apart, {gimbal.recorded(800, 1)}, {gimbal.recorded(500, 7)});
  std::puts("joints simulated apart");
  print(first);

  //! [coupled]
  tp::gap::Model coupled = apart;
  coupled.effects["coupling"] = {{"camera_z_less_x_kgm2", 8.77e-4}, {"rolled_yaw_kgm2", -2.03e-4}};
  //! [coupled]
  PointMassGimbal unbalanced;
  unbalanced.masses.push_back({2, 0.02, {0.03, 0.0, 0.0}});  // a filter on the lens
  const tp::gap::Diagnosis second =
      tp::gap::diagnose(coupled, {unbalanced.recorded(800, 1)}, {unbalanced.recorded(500, 7)});
  std::puts("coupled, a filter on the lens");
  print(second);
  return first.verdict == tp::gap::Verdict::explained && second.verdict == tp::gap::Verdict::explained ? 0
                                                                                                       : 1;
}
