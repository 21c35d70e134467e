// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/friction_transition.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// Dry friction with a magnitude for each direction.
///
/// @snippet effects_examples.cpp AsymmetricFriction
/// How to: @ref diagnose_a_gap, @ref laws.
struct AsymmetricFriction {
  /// Its parameters, in this order.
  enum Parameters {
    forward_Nm,   ///< torque against motion of positive rate, N m
    backward_Nm,  ///< torque against motion of negative rate, N m
    transition,   ///< rate within which it turns over, see friction_transition()
    tail          ///< how slowly it becomes full beyond, see friction_tail()
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    EffectInfo one = {"asymmetric_friction",
                      Submodel::mechanical_friction,
                      "torque -= (forward where w > 0, else backward) film(w / transition, tail)",
                      "Dry friction that differs between the two directions.",
                      {parameter(forward_Nm, "forward_Nm").unit("N m").within(0.0, 1e3).starts({0.0}),
                       parameter(backward_Nm, "backward_Nm").unit("N m").within(0.0, 1e3).starts({0.0}),
                       friction_transition(transition), friction_tail(tail)},
                      {Need::axis_model},
                      "slow motion at constant rate in both directions, and standstill"};
    one.where_equal = WhereEqual{forward_Nm, backward_Nm, "coulomb_friction"};
    one.in_a_joint = in_a_joint;
    return one;
  }

  /// As simulators of bodies have it.
  static void in_a_joint(const double* p, JointDescription& joint) {
    joint.add_friction(0.5 * (p[forward_Nm] + p[backward_Nm]), transition, p[transition]);
    joint.remarks.push_back({{forward_Nm, backward_Nm}, "here the mean of both in both directions"});
  }

  /// Adds dry friction by direction.
  template <class Scalar>
  static void act(const Scalar* p, FrictionTerms<Scalar>& terms) {
    terms.add_friction(p[forward_Nm], p[backward_Nm], p[transition], p[tail]);
  }
};

}  // namespace thermopower::plant
