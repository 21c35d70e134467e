// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// A dead band of the drive; beyond it the command counts from its edge.
struct DriveDeadband {
  /// What it is.
  static EffectInfo info() {
    return {"drive_deadband",
            "mechanical.drive",
            "drive = sign(u) max(0, |u| - A)",
            "Small commands do nothing.",
            {{"A", "A", 0.0, 1e3, {0.02, 0.1, 0.3}, false, "drive_A"}},
            {"axis"},
            "small commands in both directions"};
  }

  /// Takes a fixed amount off the command.
  template <class Scalar>
  static void act(const Scalar* p, DriveTerms<Scalar>& terms) {
    const double command = value_of(terms.drive_A);
    if (command > value_of(p[0])) terms.drive_A -= p[0];
    else if (command < -value_of(p[0])) terms.drive_A += p[0];
    else terms.drive_A = constant<Scalar>(0.0);
  }
};

}  // namespace thermopower::plant
