// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/friction_transition.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// Dry friction with a Stribeck rise near standstill.
struct StribeckFriction {
  /// What it is.
  static EffectInfo info() {
    return {"stribeck_friction",
            "mechanical.friction",
            "torque -= (Nm + rise exp(-(w / knee)^2)) tanh(w / transition)",
            "Dry friction that is larger near standstill than in motion.",
            {{"Nm", "N m", 0.0, 1e3, {0.0}, false},
             {"rise_Nm", "N m", 0.0, 1e3, {0.0}, false},
             {"knee_rad_per_s", "rad/s", 0.005, 100.0, {0.1, 0.5, 2.0}, true},
             friction_transition()},
            {"axis"},
            "very slow motion through standstill in both directions"};
  }

  /// Adds dry friction with a rise near standstill.
  template <class Scalar>
  static void act(const Scalar* p, AxisTerms<Scalar>& terms) {
    using std::exp;
    const Scalar ratio = terms.rate_rad_per_s / p[2];
    const Scalar friction_Nm = p[0] + p[1] * exp(-ratio * ratio);
    terms.add_friction(friction_Nm, friction_Nm, p[3]);
  }
};

}  // namespace thermopower::plant
