// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// A further part of the body, such as a frame or a mount, that soaks up heat from the surface and loses none itself.
/// Asked of a model that has winding and surface: behind a single node a thermometer cannot tell it from a surface.
///
/// @snippet effects_examples.cpp ThirdThermalMass
/// How to: @ref diagnose_a_gap, @ref laws.
struct ThirdThermalMass {
  /// Its parameters, in this order.
  enum Parameters {
    share,            ///< heat capacity of what soaks it up, as a part of the body's
    coupling_W_per_K  ///< conductance between surface and what soaks it up, W/K
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    return {
        "third_thermal_mass",
        Submodel::thermal_storage,
        "q C dM/dt = k (H - M), and k (H - M) is missing from the surface H",
        "A frame or a mount soaks up heat behind the surface: the body warms fast at first, and then slowly.",
        {parameter(share, "share").unit("1").within(0.02, 0.95).starts({0.3}),
         parameter(coupling_W_per_K, "coupling")
             .unit("W/K")
             .within(1e-3, 1e3)
             .logarithmic()
             .starts({0.05, 0.5})},
        {Need::thermal_model, Need::motor_C, Need::two_nodes},
        "a long step of power, and cooling from hot until nothing changes"};
  }

  /// Puts part of the heat capacity behind the surface.
  template <class Scalar>
  static void act(const Scalar* p, ThermalStructure<Scalar>& shape) {
    shape.soaks = true;
    shape.soaking_share = p[share];
    shape.soaking_W_per_K = p[coupling_W_per_K];
  }
};

}  // namespace thermopower::plant
