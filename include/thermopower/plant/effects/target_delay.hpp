// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// A target that reaches a servo late, over a bus or in a PWM frame; the servo itself is as fast as its file says.
///
/// @snippet effects_examples.cpp TargetDelay
/// How to: @ref diagnose_a_gap, @ref laws.
struct TargetDelay {
  /// Its parameters, in this order.
  enum Parameters {
    delay_s  ///< time from the recorded target to the servo that takes it, s
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    return {"target_delay",
            Submodel::mechanical_drive,
            "target(t) = recorded target(t - s)",
            "The target reaches the servo late, as over a bus or in a PWM frame.",
            {parameter(delay_s, "s").unit("s").within(0.0, 1.0).starts({0.005, 0.02, 0.05, 0.12})},
            {Need::axis_model, Need::closed_loop},
            "steps of the target, recorded at a high rate"};
  }

  /// Delays the target.
  template <class Scalar>
  static void act(const Scalar* p, AxisStructure<Scalar>& shape) {
    shape.target_delayed = true;
    shape.target_delay_s = shape.target_delay_s + p[delay_s];
  }
};

}  // namespace thermopower::plant
