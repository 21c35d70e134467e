// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/robot/diagnosis.hpp>
#include <thermopower/robot/impact.hpp>

#include <cstdio>
#include <string>
#include <vector>

namespace thermopower::robot {

/// A number as files for other programs have it; 0 has no sign.
inline std::string four_digits(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.4g", value == 0.0 ? 0.0 : value);
  return text;
}

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

/// @brief The ranking of causes for programs, as JSON. Errors have the unit that it names; shares are of 1.
std::string impact_json(const RobotDiagnosis& robot, const Impact& impact);

/// @brief The diagnosis as a page: the robot's joints as rows that link to each joint's report. It loads nothing.
std::string robot_html(const RobotDiagnosis& robot);

/// Programs that a robot's actuators are written for.
enum class TrainingFormat {
  isaac_lab,  ///< a dictionary of actuator configurations, for ArticulationCfg.actuators
  mjlab,      ///< a tuple of actuator configurations, for EntityArticulationInfoCfg
  newton,     ///< a function that sets the joints of a ModelBuilder
};

/// @brief Gains and constants of each joint as Python for a simulator in which policies are trained. What the simulator has no place
/// for stands in a comment.
AmendedFile training_file(const RobotDiagnosis& robot, TrainingFormat format);

/// @brief Ranges for domain randomisation (JSON): of each joint the numbers that moved, their standard errors, 95 % ranges and
/// covariance; of joints that are built alike the spread over them.
std::string ranges_json(const RobotDiagnosis& robot);

}  // namespace thermopower::robot
