// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include "program.hpp"

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

/// What `diagnose` is asked for where a whole robot is the simulation under test.
struct RobotArguments {
  std::vector<std::string> kp, kd;   ///< a number for all joints, or JOINT=NUMBER
  std::vector<std::string> renamed;  ///< LOG=MODEL
  bool in_air = false;               ///< nothing touches the robot
  std::string isaac, mjlab, newton;  ///< actuators as Python
  std::string ranges;                ///< ranges for domain randomisation
  std::string of;                    ///< of `impact`: what the user cares about
};

/// @brief Adds the options of a whole robot.
void add_robot_options(CLI::App& app, RobotArguments& arguments);

/// @brief Adds the files that `diagnose` writes for simulators in which policies are trained.
void add_training_outputs(CLI::App& app, RobotArguments& arguments);

/// @brief Whether the simulation under test is a robot: no model, and a robot's file.
inline bool is_robot(const Arguments& arguments) {
  return arguments.model.empty() && !(arguments.mjcf.empty() && arguments.urdf.empty());
}

/// @brief Diagnoses a whole robot. @return exit status of the program
/// @throws UsageError, also where the program was built without MuJoCo
int diagnose_robot(const Arguments& arguments, const RobotArguments& robot);

/// @brief Says what is wrong in the wiring of a robot's log; nothing is fitted. @return exit status of the program
/// @throws UsageError, also where the program was built without MuJoCo
int check_robot(const Arguments& arguments, const RobotArguments& robot);

/// @brief Ranks the causes of a robot's gap by what they are worth for the quantity that the user names. @return exit status
/// @throws UsageError, also where the program was built without MuJoCo
int rank_impact(const Arguments& arguments, const RobotArguments& robot);
