// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/robot/family.hpp>
#include <thermopower/robot/joint_problem.hpp>

#include <Eigen/Core>

#include <string>
#include <vector>

namespace thermopower::robot {

/// Unit of the number that a column is multiplied by.
inline std::string unit_of(int column, bool slides) {
  switch (static_cast<Regressor>(column)) {
    case Regressor::acceleration:
      return slides ? "kg" : "kg m2";
    case Regressor::velocity:
      return slides ? "N s/m" : "N m s/rad";
    case Regressor::position:
    case Regressor::sign_position:
      return slides ? "N/m" : "N m/rad";
    case Regressor::gravity:
    case Regressor::load:
    case Regressor::model:
      return "1";
    case Regressor::moment_a:
    case Regressor::moment_b:
      return slides ? "kg" : "kg m";
    case Regressor::drag:
      return slides ? "N s2/m2" : "N m s2/rad2";
    default:
      return slides ? "N" : "N m";
  }
}

/// Name of the number that a column is multiplied by.
inline std::string name_of(int column) {
  switch (static_cast<Regressor>(column)) {
    case Regressor::acceleration:
      return "armature";
    case Regressor::velocity:
      return "damping";
    case Regressor::sign:
      return "friction";
    case Regressor::one:
      return "constant";
    case Regressor::position:
      return "stiffness";
    case Regressor::gravity:
      return "gravity_share";
    case Regressor::moment_a:
      return "moment_a";
    case Regressor::moment_b:
      return "moment_b";
    case Regressor::stribeck_slow:
    case Regressor::stribeck_medium:
    case Regressor::stribeck_fast:
      return "stribeck";
    case Regressor::load:
      return "load_share";
    case Regressor::sign_position:
      return "friction_slope";
    case Regressor::drag:
      return "drag";
    case Regressor::model:
      return "effort_share";
    case Regressor::ripple_sine:
      return "sine";
    case Regressor::ripple_cosine:
      return "cosine";
    case Regressor::effort:
      break;
  }
  return "";
}

/// @brief When a cause is told.
struct FitOptions {
  int blocks = 12;           ///< of a log, for cross-validation
  double least_gain = 0.05;  ///< a cause must take at least this share of what is left of the held-out effort
  double standard_errors = 2.0;  ///< and its gain over the blocks must be so many standard errors above zero
  double price = 0.02;  ///< per column, as a share: of two causes that predict alike the simpler one wins
  double alike = 0.02;  ///< causes whose held-out effort differs by less are not told apart
  int most_terms = 6;   ///< in one joint
  double most_inflation =
      60.0;  ///< of a number's variance by the other numbers; above it they cancel each other
  double most_gravity = 1.0;  ///< share of the weight that a model may lack
  double most_effort = 1.0;   ///< share of the effort that a drive may lack or have too much
  int most_cycles = 120;      ///< of a ripple, per turn
};

/// @brief What was found in one joint.
struct JointFit {
  std::vector<Term> terms;  ///< causes, in the order in which they were found
  double effort_rms = 0.0;  ///< of the joint, in N m
  double before = 0.0;      ///< effort that the model as configured does not account for, in N m
  double after =
      0.0;  ///< effort that is left with the causes, by blocks that took no part in the fit, in N m
  Eigen::Index rows = 0;  ///< rows in which the joint moves
  int ripple_cycles = 0;  ///< per turn; 0: none
  int stribeck = 1;       ///< which of JointProblem::stribeck_shares
};

}  // namespace thermopower::robot
