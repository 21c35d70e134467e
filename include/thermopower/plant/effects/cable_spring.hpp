// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// A linear spring to a rest position.
struct CableSpring {
  /// What it is.
  static EffectInfo info() {
    return {"cable_spring",
            "mechanical.load",
            "torque -= k (theta - centre)",
            "A cable pulls back towards its rest position.",
            // From far enough away the pull is a constant torque.
            {{"Nm_per_rad", "N m/rad", 0.0, 1e3, {0.0}, false},
             {"centre_rad", "rad", -60.0, 60.0, {0.0}, false, {}, {}, true}},
            {"axis", "angle_deg"},
            "slow motion over the full travel"};
  }

  /// Adds the spring's torque.
  template <class Scalar>
  static void act(const Scalar* p, AxisTerms<Scalar>& terms) {
    terms.load_Nm -= p[0] * (terms.angle_rad - p[1]);
  }
};

}  // namespace thermopower::plant
