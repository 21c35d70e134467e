// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

#include <cmath>

namespace thermopower::plant {

/// Friction that falls as the motor warms.
///
/// @snippet effects_examples.cpp WarmFriction
/// How to: @ref diagnose_a_gap, @ref laws.
struct WarmFriction {
  /// Its parameters, in this order.
  enum Parameters {
    per_K  ///< how fast friction falls with temperature, 1/K
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    return {"warm_friction",
            Submodel::mechanical_friction,
            "friction = friction at 25 degC exp(-per_K (T - 25))",
            "Grease thins as the motor warms: all friction, the viscous one too, falls.",
            {parameter(per_K, "per_K").unit("1/K").within(-0.05, 0.2).starts({0.0})},
            {Need::axis_model, Need::motor_C},
            "the same motion cold and hot, with the drive off, too"};
  }

  /// Scales all friction.
  template <class Scalar>
  static void act(const Scalar* p, FrictionTerms<Scalar>& terms) {
    using std::exp;
    constexpr double reference_C = 25.0;
    terms.factor *= exp(Scalar(p[per_K] * (reference_C - terms.motor_C)));
  }
};

}  // namespace thermopower::plant
