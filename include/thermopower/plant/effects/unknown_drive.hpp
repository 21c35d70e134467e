// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/curve.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/radians.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// A current that the drive adds or withholds, as some smooth function of its command.
///
/// @snippet effects_examples.cpp UnknownDrive
/// How to: @ref diagnose_a_gap, @ref laws.
struct UnknownDrive {
  /// As model files and reports call it.
  static constexpr const char* id = "unknown.drive(drive_A)";

  /// What it is. Its parameters are those of curve_info().
  static EffectInfo info() {
    return curve_info(id, Submodel::mechanical_drive, "drive += f(drive_A)",
                      "The drive answers its command by a curve that no named cause has.",
                      {CurveVariable::drive_A, CurveScale::drive_A}, "drive_A", "A", "A", {Need::axis_model},
                      "commands of all sizes, both ways");
  }

  /// Adds the current.
  template <class Scalar>
  static void act(const Scalar* p, DriveTerms<Scalar>& terms) {
    terms.drive_A += curve_at(id, p, Scalar(terms.drive_A));
  }
};

}  // namespace thermopower::plant
