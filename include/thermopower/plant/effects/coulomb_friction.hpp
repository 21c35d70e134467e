// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/friction_transition.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// Dry friction of constant magnitude.
///
/// @snippet effects_examples.cpp CoulombFriction
/// How to: @ref diagnose_a_gap, @ref laws.
struct CoulombFriction {
  /// Its parameters, in this order.
  enum Parameters {
    size_Nm,     ///< torque against the motion, N m
    transition,  ///< rate within which it turns over, see friction_transition()
    tail         ///< how slowly it becomes full beyond, see friction_tail()
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    EffectInfo one = {"coulomb_friction",
                      Submodel::mechanical_friction,
                      "torque -= Nm film(w / transition, tail)",
                      "Dry friction: a constant torque against the motion, and sticking at rest.",
                      {parameter(size_Nm, "Nm").unit("N m").within(0.0, 1e3).starts({0.0}),
                       friction_transition(transition), friction_tail(tail)},
                      {Need::axis_model},
                      "slow reversals at small torque"};
    one.in_a_joint = in_a_joint;
    one.rarity = 2.0;  // hardly any joint is without it
    return one;
  }

  /// As simulators of bodies have it.
  static void in_a_joint(const double* p, JointDescription& joint) {
    joint.add_friction(p[size_Nm], transition, p[transition]);
  }

  /// Adds dry friction.
  template <class Scalar>
  static void act(const Scalar* p, FrictionTerms<Scalar>& terms) {
    terms.add_friction(p[size_Nm], p[size_Nm], p[transition], p[tail]);
  }
};

}  // namespace thermopower::plant
