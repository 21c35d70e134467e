// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/curve.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/radians.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// A friction that is some smooth function of the rate.
///
/// @snippet effects_examples.cpp UnknownFriction
/// How to: @ref diagnose_a_gap, @ref laws.
struct UnknownFriction {
  /// As model files and reports call it.
  static constexpr const char* id = "unknown.friction(rate_dps)";

  /// What it is. Its parameters are those of curve_info().
  static EffectInfo info() {
    return curve_info(id, Submodel::mechanical_friction, "torque -= f(rate_dps)",
                      "A friction goes with the rate in a way that no named friction does.",
                      {CurveVariable::rate_dps, CurveScale::drive_Nm}, "rate_dps", "Nm", "N m",
                      {Need::axis_model}, "steady turning at many rates, both ways");
  }

  /// Adds the friction.
  template <class Scalar>
  static void act(const Scalar* p, FrictionTerms<Scalar>& terms) {
    terms.torque_Nm += curve_at(id, p, Scalar(terms.rate_rad_per_s * deg_per_rad));
  }
};

}  // namespace thermopower::plant
