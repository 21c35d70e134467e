// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/curve.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/radians.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// A torque that is some smooth function of the angle.
///
/// @snippet effects_examples.cpp UnknownLoad
/// How to: @ref diagnose_a_gap, @ref laws.
struct UnknownLoad {
  /// As model files and reports call it.
  static constexpr const char* id = "unknown.load(angle_deg)";

  /// What it is. Its parameters are those of curve_info().
  static EffectInfo info() {
    return curve_info(id, Submodel::mechanical_load, "torque += f(angle_deg)",
                      "A torque goes with the angle in a way that no named load does.",
                      {CurveVariable::angle_deg, CurveScale::drive_Nm}, "angle_deg", "Nm", "N m",
                      {Need::axis_model, Need::angle_deg}, "slow motion over the full travel, both ways");
  }

  /// Adds the torque.
  template <class Scalar>
  static void act(const Scalar* p, AxisTerms<Scalar>& terms) {
    terms.load_Nm += curve_at(id, p, Scalar(terms.angle_rad * deg_per_rad));
  }
};

}  // namespace thermopower::plant
