// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/dual.hpp>
#include <thermopower/gap/effect.hpp>
#include <thermopower/gap/terms.hpp>

namespace thermopower::gap {

/// A torque that repeats several times a turn.
struct Cogging {
  /// What it is.
  static EffectInfo info() {
    return {"cogging",
            "mechanical.load",
            "torque -= Nm sin(cycles theta + phase)",
            "Magnets hold the rotor at preferred angles, several times a turn.",
            {{"Nm", "N m", 0.0, 1e3, {0.0}, false},
             {"cycles_per_turn", "1", 1.5, 400.0, {2, 3, 4, 5, 6, 7, 8, 10, 12, 14, 18, 24, 36, 48, 84}, false},
             {"phase_rad", "rad", -6.4, 6.4, {0.0, 1.5708, 3.1416, -1.5708}, false}},
            {"axis", "angle_deg"},
            "slow motion through a full turn in both directions"};
  }

  /// Adds a torque periodic in the angle.
  template <class Scalar>
  static void act(const Scalar* p, AxisTerms<Scalar>& terms) {
    using std::sin;
    terms.load_Nm -= p[0] * sin(p[1] * terms.angle_rad + p[2]);
  }
};

}  // namespace thermopower::gap
