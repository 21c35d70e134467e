// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/friction_transition.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// Dry friction with a magnitude for each direction.
struct AsymmetricFriction {
  /// What it is.
  static EffectInfo info() {
    return {"asymmetric_friction",
            "mechanical.friction",
            "torque -= (forward where w > 0, else backward) tanh(w / transition)",
            "Dry friction that differs between the two directions.",
            {{"forward_Nm", "N m", 0.0, 1e3, {0.0}, false},
             {"backward_Nm", "N m", 0.0, 1e3, {0.0}, false},
             friction_transition()},
            {"axis"},
            "slow motion at constant rate in both directions, and standstill"};
  }

  /// Adds dry friction by direction.
  template <class Scalar>
  static void act(const Scalar* p, AxisTerms<Scalar>& terms) {
    terms.add_friction(p[0], p[1], p[2]);
  }
};

}  // namespace thermopower::plant
