// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// A wrong factor of the current sensor.
struct CurrentSensorGain {
  /// What it is.
  static EffectInfo info() {
    return {"current_sensor_gain",
            "sensing.current",
            "reading = gain I",
            "The current sensor is off by a factor; the heat is not.",
            {{"gain", "1", 0.2, 5.0, {1.0}, false}},
            {"current", "current_A", "power_param"},
            "current and temperature recorded together over a long run"};
  }

  /// Scales the reading.
  template <class Scalar>
  static void act(const Scalar* p, BenchReadings<Scalar>& read) {
    read.current_A *= p[0];
  }
};

}  // namespace thermopower::plant
