// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// A wrong factor of the angle (a unit, a gear, a sign).
struct AngleScale {
  /// What it is.
  static EffectInfo info() {
    return {"angle_scale",
            "sensing.angle",
            "reading = gain angle",
            "The angle is in another unit, or its sensor is off by a factor or a sign.",
            {{"gain", "1", -400.0, 400.0, {1.0}, false}},
            {"axis", "angle_deg"},
            "any motion, angle and rate recorded together"};
  }

  /// Scales the reading.
  template <class Scalar>
  static void act(const Scalar* p, AxisReadings<Scalar>& read) {
    read.angle_deg *= p[0];
  }
};

}  // namespace thermopower::plant
