// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// A constant error of the recorded air temperature.
///
/// @snippet effects_examples.cpp AmbientBias
/// How to: @ref diagnose_a_gap, @ref laws.
struct AmbientBias {
  /// Its parameters, in this order.
  enum Parameters {
    bias_K  ///< how much warmer the air at the motor is than its sensor says, K
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    return {
        "ambient_bias",
        Submodel::thermal_loss,
        "loss = G (T - (Ta + bias))",
        "The air around the motor is not what its sensor says: the motor cools towards another temperature.",
        {parameter(bias_K, "bias_K").unit("K").within(-40.0, 40.0).starts({0.0})},
        {Need::thermal_model, Need::motor_C},
        "a long rest with the power off, until the motor is at air temperature"};
  }

  /// Shifts the air temperature.
  template <class Scalar>
  static void act(const Scalar* p, AirTerms<Scalar>& terms) {
    terms.ambient_C += p[bias_K];
  }
};

}  // namespace thermopower::plant
