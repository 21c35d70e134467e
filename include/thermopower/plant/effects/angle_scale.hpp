// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// A wrong factor of the angle (a unit, a gear, a sign).
///
/// @snippet effects_examples.cpp AngleScale
/// How to: @ref diagnose_a_gap, @ref laws.
struct AngleScale {
  /// Its parameters, in this order.
  enum Parameters {
    gain  ///< reading by angle
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    return {"angle_scale",
            Submodel::sensing_angle,
            "reading = gain angle",
            "The angle is in another unit, or its sensor is off by a factor or a sign.",
            {parameter(gain, "gain").unit("1").within(-400.0, 400.0).starts({1.0}).absent_at(1.0)},
            {Need::axis_model, Need::angle_deg},
            "any motion, angle and rate recorded together"};
  }

  /// Scales the reading.
  template <class Scalar>
  static void act(const Scalar* p, AxisReadings<Scalar>& read) {
    read.angle_deg *= p[gain];
  }
};

}  // namespace thermopower::plant
