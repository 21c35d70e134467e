// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// Dry friction with bristles that bend before they slide (LuGre without a Stribeck rise; Canudas de Wit and
/// others 1995, eqs. 1 to 3).
///
/// @snippet effects_examples.cpp PreslidingFriction
/// How to: @ref diagnose_a_gap, @ref laws.
struct PreslidingFriction {
  /// Its parameters, in this order.
  enum Parameters {
    size_Nm,   ///< torque against sliding, N m
    bend_rad,  ///< how far the bristles bend before they slide, rad
    damping    ///< torque of bending by its rate, as a time: of the stiffness, s
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    EffectInfo info{
        "presliding_friction",
        Submodel::mechanical_friction,
        "torque -= Nm / bend (z + damping dz/dt), dz/dt = w - |w| z / bend",
        "Dry friction that gives like a spring before it slides: the axis creeps back after each stop.",
        {parameter(size_Nm, "Nm").unit("N m").within(0.0, 1e3).starts({0.0, 0.005}),
         // Bristles that hardly bend are Coulomb's friction, and such that bend very far are a spring.
         parameter(bend_rad, "bend_rad")
             .unit("rad")
             .within(5e-4, 1.0)
             .logarithmic()
             .starts({0.01, 0.06})
             .degenerate_at_bounds(),
         parameter(damping, "damping_s").unit("s").within(0.0, 0.02).standard(0.0).starts({0.0})},
        {Need::axis_model},
        "small reversals that do not slide, and large ones that do"};
    info.states = {{"bent_rad", "rad"}};
    return info;
  }

  /// Adds the bristles' torque.
  template <class Scalar>
  static void act(const Scalar* p, FrictionTerms<Scalar>& terms) {
    OwnState<Scalar>& bent_rad = terms.own[0];
    bent_rad.slope = terms.rate_rad_per_s;
    bent_rad.per_s = magnitude(terms.rate_rad_per_s) / p[bend_rad];
    const Scalar bending_rad_per_s = bent_rad.slope - bent_rad.per_s * bent_rad.value;
    terms.torque_Nm += p[size_Nm] / p[bend_rad] * (bent_rad.value + p[damping] * bending_rad_per_s);
  }
};

}  // namespace thermopower::plant
