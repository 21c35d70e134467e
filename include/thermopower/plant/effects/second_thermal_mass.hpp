// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// A heated node (the thermometer is on it) coupled to a housing that loses the heat.
///
/// @snippet effects_examples.cpp SecondThermalMass
/// How to: @ref diagnose_a_gap, @ref laws.
struct SecondThermalMass {
  /// Its parameters, in this order.
  enum Parameters {
    winding_share,    ///< part of the heat capacity that is the winding's
    coupling_W_per_K  ///< conductance between winding and housing, W/K
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    return {"second_thermal_mass",
            Submodel::thermal_storage,
            "s C dT/dt = P - k (T - H), (1 - s) C dH/dt = k (T - H) - G (H - Ta)",
            "The heated winding is coupled to a housing that loses the heat: steps begin and end faster than "
            "one mass allows.",
            {// With all of the capacity in the winding there is no housing.
             parameter(winding_share, "winding_share")
                 .unit("1")
                 .within(0.01, 0.97)
                 .starts({0.12, 0.4})
                 .absent_at(0.97),
             parameter(coupling_W_per_K, "coupling")
                 .unit("W/K")
                 .within(1e-3, 1e3)
                 .logarithmic()
                 .starts({0.1, 1.0, 8.0})},
            {Need::thermal_model, Need::motor_C},
            "power steps sampled every few seconds, followed by cooling from hot"};
  }

  /// Splits the heat capacity.
  template <class Scalar>
  static void act(const Scalar* p, ThermalStructure<Scalar>& shape) {
    shape.two_nodes = true;
    shape.winding_share = p[winding_share];
    shape.coupling_W_per_K = p[coupling_W_per_K];
  }
};

}  // namespace thermopower::plant
