// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// A constant error of the rate sensor.
struct RateBias {
  /// What it is.
  static EffectInfo info() {
    return {"rate_bias",
            "sensing.rate",
            "reading = rate + bias",
            "The gyro does not read zero at rest.",
            {{"dps", "deg/s", -1e3, 1e3, {0.0}, false}},
            {"axis", "rate_dps"},
            "a standstill of a few seconds"};
  }

  /// Shifts the reading.
  template <class Scalar>
  static void act(const Scalar* p, AxisReadings<Scalar>& read) {
    read.rate_dps += p[0];
  }
};

}  // namespace thermopower::plant
