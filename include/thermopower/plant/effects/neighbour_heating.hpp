// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// Heat conducted from a neighbour whose temperature was recorded.
struct NeighbourHeating {
  /// What it is.
  static EffectInfo info() {
    return {"neighbour_heating",
            "thermal.heating",
            "P += g (Tn - T)",
            "A warm neighbour heats the motor, or a cool one cools it.",
            {{"coupling", "W/K", 0.0, 100.0, {0.0}, false}},
            {"thermal", "motor_C", "neighbour_C"},
            "the neighbour hot while the motor is cold, and the other way round"};
  }

  /// Adds the heat that flows from the neighbour.
  template <class Scalar>
  static void act(const Scalar* p, ThermalTerms<Scalar>& terms) {
    terms.extra_loss_W += p[0] * (terms.surface_C - terms.neighbour_C);
  }
};

}  // namespace thermopower::plant
