// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// Gravity on a centre of mass off the axis.
struct Imbalance {
  /// What it is.
  static EffectInfo info() {
    return {"imbalance",
            "mechanical.load",
            "torque -= Nm sin(theta + phase)",
            "The load's centre of mass is off the axis: gravity pulls with the angle.",
            {{"Nm", "N m", 0.0, 1e3, {0.0}, false},
             {"phase_rad", "rad", -6.4, 6.4, {0.0, 1.5708, 3.1416, -1.5708}, false}},
            {"axis", "angle_deg"},
            "slow motion through a full turn"};
  }

  /// Adds gravity's torque.
  template <class Scalar>
  static void act(const Scalar* p, AxisTerms<Scalar>& terms) {
    using std::sin;
    terms.load_Nm -= p[0] * sin(terms.angle_rad + p[1]);
  }
};

}  // namespace thermopower::plant
