// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// A heated node (the thermometer is on it) coupled to a housing that loses the heat.
struct SecondThermalMass {
  /// What it is.
  static EffectInfo info() {
    return {"second_thermal_mass",
            "thermal.storage",
            "s C dT/dt = P - k (T - H), (1 - s) C dH/dt = k (T - H) - G (H - Ta)",
            "The heated winding is coupled to a housing that loses the heat: steps begin and end faster than "
            "one mass allows.",
            {{"winding_share", "1", 0.01, 0.97, {0.12, 0.4}, false},
             {"coupling", "W/K", 1e-3, 1e3, {0.1, 1.0, 8.0}, true}},
            {"thermal", "motor_C"},
            "power steps sampled every few seconds, followed by cooling from hot"};
  }

  /// Splits the heat capacity.
  template <class Scalar>
  static void act(const Scalar* p, ThermalStructure<Scalar>& shape) {
    shape.two_nodes = true;
    shape.winding_share = p[0];
    shape.coupling_W_per_K = p[1];
  }
};

}  // namespace thermopower::plant
