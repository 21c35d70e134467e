// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/friction_transition.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// Dry friction in proportion to the transmitted torque.
///
/// @snippet effects_examples.cpp LoadFriction
/// How to: @ref diagnose_a_gap, @ref laws.
struct LoadFriction {
  /// Its parameters, in this order.
  enum Parameters {
    share,       ///< part of the transmitted torque that is friction
    transition,  ///< rate within which it turns over, see friction_transition()
    tail         ///< how slowly it becomes full beyond, see friction_tail()
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    EffectInfo one = {"load_friction",
                      Submodel::mechanical_friction,
                      "torque -= share |drive - load| film(w / transition, tail)",
                      "Friction that grows with the torque transmitted (gears, screws).",
                      {parameter(share, "share").unit("1").within(0.0, 0.95).starts({0.0}),
                       friction_transition(transition), friction_tail(tail)},
                      {Need::axis_model},
                      "fast and slow motion at large and at small torque"};
    one.is_itself = passes_torque;
    return one;
  }

  /// Whether a tenth of the torque at least is left, as DriveEfficiency::drives() asks it.
  static bool passes_torque(const double* p) {
    constexpr double most = 0.9;
    return p[share] <= most;
  }

  /// Adds dry friction in proportion to what the gears transmit.
  template <class Scalar>
  static void act(const Scalar* p, FrictionTerms<Scalar>& terms) {
    const Scalar friction_Nm = p[share] * terms.transmitted_Nm();
    terms.add_friction(friction_Nm, friction_Nm, p[transition], p[tail]);
  }
};

}  // namespace thermopower::plant
