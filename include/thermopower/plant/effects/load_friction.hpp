// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/friction_transition.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// Dry friction in proportion to the transmitted torque.
struct LoadFriction {
  /// What it is.
  static EffectInfo info() {
    return {"load_friction",
            "mechanical.friction",
            "torque -= share |drive torque| tanh(w / transition)",
            "Friction that grows with the torque transmitted (gears, screws).",
            {{"share", "1", 0.0, 0.95, {0.0}, false}, friction_transition()},
            {"axis"},
            "fast and slow motion at large and at small torque"};
  }

  /// Adds dry friction in proportion to the drive.
  template <class Scalar>
  static void act(const Scalar* p, AxisTerms<Scalar>& terms) {
    const Scalar friction_Nm = p[0] * magnitude(terms.drive_Nm);
    terms.add_friction(friction_Nm, friction_Nm, p[1]);
  }
};

}  // namespace thermopower::plant
