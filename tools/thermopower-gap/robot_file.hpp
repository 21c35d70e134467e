// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <optional>
#include <string>
#include <vector>

/// What a robot's description says of one joint, all joints behind it held at 0.
struct RobotJoint {
  std::string name;                  ///< as in the file
  double inertia_kgm2 = 0.0;         ///< about the axis, of all that the joint carries, and the rotor
  double viscous_Nms_per_rad = 0.0;  ///< damping
  double coulomb_Nm = 0.0;           ///< dry friction
  double gravity_Nm = 0.0;  ///< largest torque of gravity; 0: the axis is upright, or the mass is on it
  double gravity_phase_rad = 0.0;        ///< the torque is -gravity_Nm sin(angle + this)
  std::optional<double> Nm_per_command;  ///< of a motor: its gear
  std::optional<double> kp_Nm_per_rad;   ///< of a position servo
  double kd_Nms_per_rad = 0.0;           ///< of a position servo
  std::optional<double> limit_Nm;        ///< largest torque of the drive
  double step_s = 0.002;                 ///< of the simulation
  std::vector<std::string> remarks;      ///< what was assumed, or could not be read
};

/// @brief Reads a joint of an MJCF or URDF file.
/// @param joint  its name; empty: the only one that turns
/// @throws thermopower::io::InputError with file and line, and the joints that there are
RobotJoint read_robot_joint(const std::string& path, const std::string& joint);
