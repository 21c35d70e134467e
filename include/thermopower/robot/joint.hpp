// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace thermopower::robot {

/// @brief One joint of a robot, as its model file describes it.
///
/// Units are rad and N m; for a sliding joint they are m and N. A number that the file does not give is NaN.
struct Joint {
  std::string name;                                      ///< in the model file
  bool slides = false;                                   ///< a sliding joint; else a hinge
  double armature = 0.0;                                 ///< reflected inertia of rotor and gear in kg m2
  double damping = 0.0;                                  ///< viscous friction in N m s/rad
  double friction = 0.0;                                 ///< dry friction in N m
  double stiffness = 0.0;                                ///< of a spring in the joint, in N m/rad
  double spring_rest = 0.0;                              ///< position at which that spring rests, in rad
  double kp = std::numeric_limits<double>::quiet_NaN();  ///< position gain of the actuator in N m/rad
  double kd = std::numeric_limits<double>::quiet_NaN();  ///< rate gain of the actuator in N m s/rad
  double effort_limit = std::numeric_limits<double>::infinity();  ///< largest effort in N m
  double lower = -std::numeric_limits<double>::infinity();        ///< end of the travel in rad
  double upper = std::numeric_limits<double>::infinity();         ///< end of the travel in rad
  std::vector<std::string> actuators = {};                        ///< names of the actuators that drive it
};

/// @brief A robot, as its model file describes it: the joints with one degree of freedom, in the order of the file.
struct Robot {
  std::string name;            ///< in the model file
  std::vector<Joint> joints;   ///< hinges and slides
  bool floating_base = false;  ///< the base is free to move
  double mass_kg = 0.0;        ///< of everything that moves
};

}  // namespace thermopower::robot
