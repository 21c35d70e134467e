// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// A drift of the angle in proportion to time.
struct AngleBiasDrift {
  /// What it is.
  static EffectInfo info() {
    return {"angle_bias_drift",
            "sensing.angle",
            "reading = angle + drift t",
            "The angle sensor drifts away while nothing moves.",
            {{"deg_per_s", "deg/s", -1e3, 1e3, {0.0}, false}},
            {"axis", "angle_deg"},
            "a long recording with standstill at its end"};
  }

  /// Adds a drift.
  template <class Scalar>
  static void act(const Scalar* p, AxisReadings<Scalar>& read) {
    read.angle_deg += p[0] * read.t_s;
  }
};

}  // namespace thermopower::plant
