// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// A limit of the drive, stated in the command's unit.
struct TorqueSaturation {
  /// What it is.
  static EffectInfo info() {
    return {"torque_saturation",
            "mechanical.drive",
            "drive = clamp(u, -A, A)",
            "The drive cannot deliver more than a limit.",
            {{"A", "A", 1e-6, 1e3, {0.25, 0.5, 0.75, 0.9}, false, "drive_A"}},
            {"axis"},
            "short pulses at the largest command"};
  }

  /// Limits the command.
  template <class Scalar>
  static void act(const Scalar* p, DriveTerms<Scalar>& terms) {
    if (value_of(terms.drive_A) > value_of(p[0])) terms.drive_A = p[0];
    else if (value_of(terms.drive_A) < -value_of(p[0])) terms.drive_A = -p[0];
  }
};

}  // namespace thermopower::plant
