// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// A torque constant that falls with the recorded motor temperature.
///
/// @snippet effects_examples.cpp TorqueFade
/// How to: @ref diagnose_a_gap, @ref laws.
struct TorqueFade {
  /// Its parameters, in this order.
  enum Parameters {
    per_K  ///< part of the torque constant lost by each kelvin above 25 degC, 1/K
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    return {"torque_fade",
            Submodel::mechanical_drive,
            "Kt(T) = Kt (1 - per_K (T - 25))",
            "Magnets weaken as the motor warms: the same current gives less torque.",
            {parameter(per_K, "per_K").unit("1/K").within(-0.02, 0.05).starts({0.0})},
            {Need::axis_model, Need::motor_C},
            "the same motion cold and hot"};
  }

  /// Lowers the torque constant.
  template <class Scalar>
  static void act(const Scalar* p, DriveTerms<Scalar>& terms) {
    terms.torque_constant_Nm_per_A *= 1.0 - p[per_K] * (terms.motor_C - 25.0);
  }
};

}  // namespace thermopower::plant
