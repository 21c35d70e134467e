// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// A constant error of the current sensor.
struct CurrentSensorOffset {
  /// What it is.
  static EffectInfo info() {
    return {"current_sensor_offset",
            "sensing.current",
            "reading = I + offset",
            "The current sensor does not read zero at zero.",
            {{"A", "A", -100.0, 100.0, {0.0}, false}},
            {"current", "current_A", "power_param"},
            "a rest with the power off"};
  }

  /// Shifts the reading.
  template <class Scalar>
  static void act(const Scalar* p, BenchReadings<Scalar>& read) {
    read.current_A += p[0];
  }
};

}  // namespace thermopower::plant
