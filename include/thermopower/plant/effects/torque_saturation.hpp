// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// A limit of the drive, stated in the command's unit.
///
/// @snippet effects_examples.cpp TorqueSaturation
/// How to: @ref diagnose_a_gap, @ref laws.
struct TorqueSaturation {
  /// Its parameters, in this order.
  enum Parameters {
    limit_A  ///< largest command that acts, A
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    EffectInfo one = {"torque_saturation",
                      Submodel::mechanical_drive,
                      "drive = clamp(u, -A, A)",
                      "The drive cannot deliver more than a limit.",
                      {parameter(limit_A, "A")
                           .unit("A")
                           .within(1e-6, 1e3)
                           .starts_as_shares_of(Input::drive_A, {0.25, 0.5, 0.75, 0.9})},
                      {Need::axis_model},
                      "short pulses at the largest command"};
    one.in_a_joint = in_a_joint;
    return one;
  }

  /// As simulators of bodies have it.
  static void in_a_joint(const double* p, JointDescription& joint) {
    joint.largest_drive = p[limit_A] * joint.drive_per_A;
  }

  /// Limits the command.
  template <class Scalar>
  static void act(const Scalar* p, DriveTerms<Scalar>& terms) {
    if (value_of(terms.drive_A) > value_of(p[limit_A])) terms.drive_A = p[limit_A];
    else if (value_of(terms.drive_A) < -value_of(p[limit_A])) terms.drive_A = -p[limit_A];
  }
};

}  // namespace thermopower::plant
