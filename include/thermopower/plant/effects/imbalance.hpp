// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// Gravity on a centre of mass off the axis.
///
/// @snippet effects_examples.cpp Imbalance
/// How to: @ref diagnose_a_gap, @ref laws.
struct Imbalance {
  /// Its parameters, in this order.
  enum Parameters {
    size_Nm,   ///< weight times lever, N m
    phase_rad  ///< added to the angle: at minus this the load hangs or stands, rad
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    EffectInfo one = {"imbalance",
                      Submodel::mechanical_load,
                      "torque -= Nm sin(theta + phase)",
                      "The load's centre of mass is off the axis: gravity pulls with the angle.",
                      {parameter(size_Nm, "Nm").unit("N m").within(0.0, 1e3).starts({0.0}),
                       parameter(phase_rad, "phase_rad")
                           .unit("rad")
                           .within(-6.4, 6.4)
                           .starts({0.0, 1.5708, 3.1416, -1.5708})},
                      {Need::axis_model, Need::angle_deg},
                      "slow motion through a full turn"};
    one.in_a_joint = in_a_joint;
    return one;
  }

  /// As simulators of bodies have it.
  static void in_a_joint(const double* p, JointDescription& joint) {
    if (p[size_Nm] != 0.0) joint.imbalance = JointImbalance{p[size_Nm], p[phase_rad]};
  }

  /// Adds gravity's torque.
  template <class Scalar>
  static void act(const Scalar* p, AxisTerms<Scalar>& terms) {
    using std::sin;
    terms.load_Nm -= p[size_Nm] * sin(terms.angle_rad + p[phase_rad]);
  }
};

}  // namespace thermopower::plant
