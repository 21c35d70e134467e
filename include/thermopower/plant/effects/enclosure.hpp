// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// Air around the body that warms up: what the body loses goes into it, and from there to the measured air.
///
/// @snippet effects_examples.cpp Enclosure
/// How to: @ref diagnose_a_gap, @ref laws.
struct Enclosure {
  /// Its parameters, in this order.
  enum Parameters {
    share,               ///< heat capacity of the air in the box, as a multiple of the body's
    conductance_W_per_K  ///< from the air in the box to the measured air, W/K
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    return {
        "enclosure",
        Submodel::thermal_loss,
        "q C dE/dt = loss - g (E - Ta), and the body's air is E",
        "The body stands in a box: the air around it warms up, and the loss falls behind what its rise says.",
        {parameter(share, "share").unit("1").within(0.02, 50.0).logarithmic().starts({1.0}),
         parameter(conductance_W_per_K, "W_per_K")
             .unit("W/K")
             .within(5e-3, 50.0)
             .logarithmic()
             .starts({0.3, 2.0})},
        {Need::thermal_model, Need::motor_C},
        "a long step of power, and the temperature of the air in the box"};
  }

  /// Puts air between body and surroundings.
  template <class Scalar>
  static void act(const Scalar* p, ThermalStructure<Scalar>& shape) {
    shape.enclosed = true;
    shape.enclosed_share = p[share];
    shape.enclosed_W_per_K = p[conductance_W_per_K];
  }
};

}  // namespace thermopower::plant
