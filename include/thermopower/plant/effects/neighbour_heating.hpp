// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// Heat conducted from a neighbour whose temperature was recorded.
///
/// @snippet effects_examples.cpp NeighbourHeating
/// How to: @ref diagnose_a_gap, @ref laws.
struct NeighbourHeating {
  /// Its parameters, in this order.
  enum Parameters {
    coupling_W_per_K  ///< conductance between neighbour and motor, W/K
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    return {"neighbour_heating",
            Submodel::thermal_heating,
            "P += g (Tn - T)",
            "A warm neighbour heats the motor, or a cool one cools it.",
            {parameter(coupling_W_per_K, "coupling").unit("W/K").within(0.0, 100.0).starts({0.0})},
            {Need::thermal_model, Need::motor_C, Need::neighbour_C},
            "the neighbour hot while the motor is cold, and the other way round"};
  }

  /// Adds the heat that flows from the neighbour.
  template <class Scalar>
  static void act(const Scalar* p, ThermalTerms<Scalar>& terms) {
    terms.extra_loss_W += p[coupling_W_per_K] * (terms.surface_C - terms.neighbour_C);
  }
};

}  // namespace thermopower::plant
