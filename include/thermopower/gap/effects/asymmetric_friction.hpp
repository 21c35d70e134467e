// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/dual.hpp>
#include <thermopower/gap/effect.hpp>
#include <thermopower/gap/terms.hpp>

namespace thermopower::gap {

/// Dry friction with a magnitude for each direction.
struct AsymmetricFriction {
  /// What it is.
  static EffectInfo info() {
    return {"asymmetric_friction",
            "mechanical.friction",
            "torque -= forward (w > 0), torque += backward (w < 0)",
            "Dry friction that differs between the two directions.",
            {{"forward_Nm", "N m", 0.0, 1e3, {0.0}, false}, {"backward_Nm", "N m", 0.0, 1e3, {0.0}, false}},
            {"axis"},
            "slow motion at constant rate in both directions, and standstill"};
  }

  /// Adds dry friction by direction.
  template <class Scalar>
  static void act(const Scalar* p, AxisTerms<Scalar>& terms) {
    terms.friction_forward_Nm += p[0];
    terms.friction_backward_Nm += p[1];
  }
};

}  // namespace thermopower::gap
