// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/robot/diagnosis.hpp>

#include <string>
#include <vector>

namespace thermopower::robot {

/// A file for another program, and what its format cannot express.
struct AmendedFile {
  std::string text;                   ///< the file
  std::vector<std::string> left_out;  ///< one sentence each, with the numbers
};

/// @brief The user's MJCF with what was found: only the attributes that changed, each joint with a comment that says from what to what.
/// @param text  of the file that was diagnosed
AmendedFile amended_mjcf(const std::string& text, const RobotDiagnosis& robot);

/// @brief The same for URDF, which has damping and friction and nothing else.
AmendedFile amended_urdf(const std::string& text, const RobotDiagnosis& robot);

/// @brief The diagnosis for machines.
std::string robot_json(const RobotDiagnosis& robot);

}  // namespace thermopower::robot
