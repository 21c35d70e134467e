// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// A servo that acts later than its file says, from the sample of its sensors to the torque; any value.
///
/// @snippet effects_examples.cpp ServoDelay
/// How to: @ref diagnose_a_gap, @ref laws.
struct ServoDelay {
  /// Its parameters, in this order.
  enum Parameters {
    delay_s  ///< time from what the servo measures to its torque, s
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    return {"servo_delay",
            Submodel::mechanical_drive,
            "drive(t) = servo(t - s)",
            "The servo's loop is slower than its file says: what it measures turns into torque late.",
            {parameter(delay_s, "s").unit("s").within(0.0, 1.0).starts({0.002, 0.01, 0.03, 0.08})},
            {Need::axis_model, Need::closed_loop},
            "steps of the target, recorded at a high rate"};
  }

  /// Delays the servo's command.
  template <class Scalar>
  static void act(const Scalar* p, AxisStructure<Scalar>& shape) {
    shape.delayed = true;
    shape.delay_s = shape.delay_s + p[delay_s];
  }
};

}  // namespace thermopower::plant
