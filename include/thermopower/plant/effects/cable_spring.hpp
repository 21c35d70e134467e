// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// A linear spring to a rest position.
///
/// @snippet effects_examples.cpp CableSpring
/// How to: @ref diagnose_a_gap, @ref laws.
struct CableSpring {
  /// Its parameters, in this order.
  enum Parameters {
    Nm_per_rad,  ///< stiffness of the cable, N m/rad
    centre_rad   ///< angle at which it does not pull, rad
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    EffectInfo one = {"cable_spring",
                      Submodel::mechanical_load,
                      "torque -= k (theta - centre)",
                      "A cable pulls back towards its rest position.",
                      {parameter(Nm_per_rad, "Nm_per_rad").unit("N m/rad").within(0.0, 1e3).starts({0.0}),
                       // From far enough away the pull is a constant torque.
                       parameter(centre_rad, "centre_rad")
                           .unit("rad")
                           .within(-60.0, 60.0)
                           .starts({0.0})
                           .degenerate_at_bounds()},
                      {Need::axis_model, Need::angle_deg},
                      "slow motion over the full travel"};
    one.in_a_joint = in_a_joint;
    return one;
  }

  /// As simulators of bodies have it.
  static void in_a_joint(const double* p, JointDescription& joint) {
    joint.spring = JointSpring{p[Nm_per_rad], p[centre_rad]};
  }

  /// Adds the spring's torque.
  template <class Scalar>
  static void act(const Scalar* p, AxisTerms<Scalar>& terms) {
    terms.load_Nm -= p[Nm_per_rad] * (terms.angle_rad - p[centre_rad]);
  }
};

}  // namespace thermopower::plant
