// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/radians.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// Heat of the iron apart from the copper's: hysteresis goes with the rate, eddy currents with its square (Bertotti 1988,
/// without the excess term; the flux of a magnet does not change). It enters the stator, which is the surface where the
/// body has winding and surface.
///
/// In a body of one node without hysteresis it is `motion_heating`.
///
/// @snippet effects_examples.cpp IronLoss
/// How to: @ref diagnose_a_gap, @ref laws.
struct IronLoss {
  /// Its parameters, in this order.
  enum Parameters {
    hysteresis_W_s_per_rad,  ///< heat by the rate, W s/rad
    eddy_W_s2_per_rad2       ///< heat by the square of the rate, W s^2/rad^2
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    EffectInfo info{"iron_loss",
                    Submodel::thermal_heating,
                    "P_surface += h |rate| + e rate^2",
                    "Turning heats the iron: hysteresis with the rate, eddy currents with its square.",
                    {parameter(hysteresis_W_s_per_rad, "hysteresis_W_s_per_rad")
                         .unit("W s/rad")
                         .within(0.0, 100.0)
                         .starts({0.0}),
                     parameter(eddy_W_s2_per_rad2, "eddy_W_s2_per_rad2")
                         .unit("W s^2/rad^2")
                         .within(0.0, 100.0)
                         .starts({0.0})},
                    {Need::thermal_model, Need::motor_C, Need::rate_dps},
                    "the same power at rest, turning slowly and turning fast"};
    info.costly = true;  // a richer kind of motion_heating
    return info;
  }

  /// Adds the heat to the surface node.
  template <class Scalar>
  static void act(const Scalar* p, ThermalTerms<Scalar>& terms) {
    const auto rate_rad_per_s = magnitude(terms.rate_dps * rad_per_deg);
    terms.extra_loss_W -= p[hysteresis_W_s_per_rad] * rate_rad_per_s +
                          p[eddy_W_s2_per_rad2] * (rate_rad_per_s * rate_rad_per_s);
  }
};

}  // namespace thermopower::plant
