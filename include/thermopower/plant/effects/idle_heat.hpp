// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// A constant heat beside the winding's: electronics that draw power while the motor rests.
///
/// With a single node and a loss in proportion to the rise it is the same as air that is warmer than its sensor says, by
/// heat over conductance. A change of the loss tells them apart.
///
/// @snippet effects_examples.cpp IdleHeat
/// How to: @ref diagnose_a_gap, @ref laws.
struct IdleHeat {
  /// Its parameters, in this order.
  enum Parameters {
    W  ///< heat into the body at all times, W
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    return {"idle_heat",
            Submodel::thermal_heating,
            "P += W",
            "Electronics beside the winding heat the body by a constant power, at rest too.",
            {parameter(W, "W").unit("W").within(0.0, 1e4).starts({0.0})},
            {Need::thermal_model, Need::motor_C},
            "a long rest with the electronics on, in still and in moving air"};
  }

  /// Adds the heat.
  template <class Scalar>
  static void act(const Scalar* p, ThermalTerms<Scalar>& terms) {
    terms.heat_W += p[W];
  }
};

}  // namespace thermopower::plant
