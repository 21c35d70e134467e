// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace thermopower::plant {

/// A deviation of a format for simulators of bodies from the meaning of an effect.
struct JointRemark {
  std::vector<int> parameters;  ///< of the effect, whose values it is about
  std::string text;             ///< what becomes of them, in a few words
};

/// A spring between the driven inertia and what carries the joint.
struct JointSpring {
  double Nm_per_rad = 0.0;  ///< its stiffness
  double centre_rad = 0.0;  ///< where it does not pull
};

/// A mass off the axis, under gravity.
struct JointImbalance {
  double Nm = 0.0;         ///< largest torque of gravity
  double phase_rad = 0.0;  ///< torque = -Nm sin(angle + phase)
};

/// A part of the inertia that hangs on a spring.
struct JointFarSide {
  double share = 0.0;      ///< of the inertia
  double rad_per_s = 0.0;  ///< at which both sides ring against each other
  double damping = 0.0;    ///< of that ringing, of the critical one
};

/// An axis and its drive in the terms that simulators of bodies have (MuJoCo, URDF). An effect that can be said in them
/// says so in EffectInfo::in_a_joint, and is exported; others are left out, with their numbers.
///
/// @snippet plant_examples.cpp joint
/// How to: @ref diagnose_a_gap.
struct JointDescription {
  double inertia_kgm2 = 0.0;         ///< of everything that turns
  double damping_Nms_per_rad = 0.0;  ///< viscous
  double Nm_per_drive =
      0.0;  ///< torque for each A of the drive, or for each V where a voltage drives the motor
  double drive_per_A =
      1.0;  ///< what an ampere asks of the drive: 1, or of a motor at a voltage its resistance
  double back_emf_Nms_per_rad = 0.0;        ///< what a motor at a voltage loses of its torque by its rate
  double friction_Nm = 0.0;                 ///< dry, the same in both directions
  double offset_Nm = 0.0;                   ///< torque that nothing changes
  std::optional<double> largest_drive;      ///< magnitude at which the drive is cut off
  std::optional<double> lag_s;              ///< time constant by which the torque follows the drive
  std::optional<JointSpring> spring;        ///< to what carries the joint
  std::optional<JointImbalance> imbalance;  ///< of the load
  std::optional<JointFarSide> far_side;     ///< behind a spring
  std::vector<JointRemark> remarks;         ///< on what the description does not hold

  /// Adds dry friction. Simulators of bodies have none that turns over gradually: a transition that is wider than
  /// sticking is remarked upon.
  /// @param Nm            while it moves
  /// @param transition    place of `transition_rad_per_s` among the effect's parameters
  /// @param rad_per_s     its value
  void add_friction(double Nm, int transition, double rad_per_s) {
    constexpr double sticks_below_rad_per_s = 5e-4;
    friction_Nm += Nm;
    if (rad_per_s > sticks_below_rad_per_s)
      remarks.push_back({{transition}, "it turns over within that rate, here at rest at once"});
  }
};

}  // namespace thermopower::plant
