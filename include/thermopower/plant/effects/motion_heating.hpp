// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/radians.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// Heat from turning, with the square of the recorded rate.
///
/// @snippet effects_examples.cpp MotionHeating
/// How to: @ref diagnose_a_gap, @ref laws.
struct MotionHeating {
  /// Its parameters, in this order.
  enum Parameters {
    W_s2_per_rad2  ///< heat by the square of the rate, W s^2/rad^2
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    return {"motion_heating",
            Submodel::thermal_heating,
            "P += c rate^2",
            "Turning heats the motor (iron, bearing and windage losses).",
            {parameter(W_s2_per_rad2, "W_s2_per_rad2").unit("W s^2/rad^2").within(0.0, 100.0).starts({0.0})},
            {Need::thermal_model, Need::motor_C, Need::rate_dps},
            "the same power at rest and turning fast"};
  }

  /// Adds heat that grows with the square of the rate.
  template <class Scalar>
  static void act(const Scalar* p, ThermalTerms<Scalar>& terms) {
    const auto rate_rad_per_s = terms.rate_dps * rad_per_deg;
    terms.heat_W += p[W_s2_per_rad2] * (rate_rad_per_s * rate_rad_per_s);
  }
};

}  // namespace thermopower::plant
