// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/friction_transition.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// Dry friction of constant magnitude.
struct CoulombFriction {
  /// What it is.
  static EffectInfo info() {
    return {"coulomb_friction",
            "mechanical.friction",
            "torque -= Nm tanh(w / transition)",
            "Dry friction: a constant torque against the motion, and sticking at rest.",
            {{"Nm", "N m", 0.0, 1e3, {0.0}, false}, friction_transition()},
            {"axis"},
            "slow reversals at small torque"};
  }

  /// Adds dry friction.
  template <class Scalar>
  static void act(const Scalar* p, AxisTerms<Scalar>& terms) {
    terms.add_friction(p[0], p[0], p[1]);
  }
};

}  // namespace thermopower::plant
