// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace thermopower::robot {

/// A kind of cause in a joint. The ids of to_string() are those of the diagnosis of a single axis where it knows the cause.
enum class Family {
  armature,   ///< inertia of rotor and gear other than the model's
  damping,    ///< viscous friction other than the model's
  friction,   ///< dry friction other than the model's
  constant,   ///< a constant torque; in a joint that turns both ways also friction that differs by direction
  spring,     ///< a spring in the joint, such as a cable
  gravity,    ///< weight other than the model's
  imbalance,  ///< mass off the axis of the joint's link
  stribeck,   ///< friction that falls as the joint gets faster
  load_friction,      ///< friction that grows with the transmitted torque
  position_friction,  ///< friction that changes along the travel
  drag,               ///< torque that grows with the square of the rate
  effort_scale,       ///< effort that arrives with another factor: torque constant, gain or gear
  ripple,             ///< torque that repeats with the position: cogging, teeth
};

/// Number of families.
inline constexpr std::size_t family_count = 13;

/// The id of a family, as reports and options have it.
inline const char* to_string(Family family) {
  switch (family) {
    case Family::armature:
      return "calibration.armature";
    case Family::damping:
      return "calibration.damping";
    case Family::friction:
      return "coulomb_friction";
    case Family::constant:
      return "constant_torque";
    case Family::spring:
      return "cable_spring";
    case Family::gravity:
      return "calibration.gravity";
    case Family::imbalance:
      return "imbalance";
    case Family::stribeck:
      return "stribeck_friction";
    case Family::load_friction:
      return "load_friction";
    case Family::position_friction:
      return "position_friction";
    case Family::drag:
      return "quadratic_drag";
    case Family::effort_scale:
      return "calibration.effort";
    case Family::ripple:
      return "cogging";
  }
  return "";
}

/// One number of a term.
struct Coefficient {
  std::string name;    ///< such as `armature`
  std::string unit;    ///< such as `kg m2`
  double value = 0.0;  ///< what is added to the model's constant, where it has one
  double error = 0.0;  ///< standard error
};

/// @brief A family in a joint, with its numbers.
struct Term {
  Family family = Family::friction;  ///< which cause
  std::vector<Coefficient> numbers;  ///< in the order of JointProblem::columns_of()
  double kept = 1.0;  ///< held-out effort that is left with this cause, as a share of that without it
  std::vector<Family> predicts_alike =
      {};  ///< causes that predict within two percent of it: the data cannot tell
};

}  // namespace thermopower::robot
