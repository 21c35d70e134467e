// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

/// @file gimbal.cpp
/// Problem: a camera gimbal of three joints does not move as its simulation says.
/// Model: plant::GimbalJoints, three joints that are simulated apart or coupled.
/// Here the "real" gimbal is point_masses.hpp, which shares no equation with the model. First its joints carry each
/// other, which the simulation leaves out; then the simulation knows that, and the camera is mounted off its balance.

#include "point_masses.hpp"

#include <thermopower/gap.hpp>
#include <thermopower/plant/gimbal_joints.hpp>

#include <cstdio>
#include <string>

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

void print(const char* title, const tp::gap::Diagnosis& diagnosis) {
  std::printf("%s\n", title);
  std::printf("verdict    %s: %s\n", to_string(diagnosis.verdict), diagnosis.reason.c_str());
  for (const auto& one : diagnosis.where)
    std::printf("where      %s, %s %.0f %%\n", to_string(one.signal).c_str(), to_string(one.submodel).c_str(),
                100.0 * one.share);
  for (const auto& one : diagnosis.cause) {
    std::printf("which      %s (%.0f %%):", one.effect.c_str(), 100.0 * one.probability);
    for (const auto& p : one.parameters)
      std::printf(" %s %.3g [%.3g, %.3g]", p.name.c_str(), p.value, p.ci95.low, p.ci95.high);
    std::printf("\n");
  }
  for (const auto& one : diagnosis.gap)
    std::printf("how far    %s: %.3g -> %.3g %s, noise %.3g\n", to_string(one.signal).c_str(), one.before,
                one.after, one.unit.c_str(), one.noise_floor);
}

}  // namespace

int main() {
  const tp::gap::Model apart = joints_apart();
  const PointMassGimbal gimbal;
  const tp::gap::Diagnosis first =
      tp::gap::diagnose(apart, {gimbal.recorded(800, 1)}, {gimbal.recorded(500, 7)});
  print("joints simulated apart", first);

  //! [coupled]
  tp::gap::Model coupled = apart;
  coupled.effects["coupling"] = {{"camera_z_less_x_kgm2", 8.77e-4}, {"rolled_yaw_kgm2", -2.03e-4}};
  //! [coupled]
  PointMassGimbal unbalanced;
  unbalanced.masses.push_back({2, 0.02, {0.03, 0.0, 0.0}});  // a filter on the lens
  const tp::gap::Diagnosis second =
      tp::gap::diagnose(coupled, {unbalanced.recorded(800, 1)}, {unbalanced.recorded(500, 7)});
  print("coupled, a filter on the lens", second);
  return first.verdict == tp::gap::Verdict::explained && second.verdict == tp::gap::Verdict::explained ? 0
                                                                                                       : 1;
}
