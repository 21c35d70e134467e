// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// A wrong factor of the current sensor.
///
/// @snippet effects_examples.cpp CurrentSensorGain
/// How to: @ref diagnose_a_gap, @ref laws.
struct CurrentSensorGain {
  /// Its parameters, in this order.
  enum Parameters {
    gain  ///< reading by current
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    return {"current_sensor_gain",
            Submodel::sensing_current,
            "reading = gain I",
            "The current sensor is off by a factor; the heat is not.",
            {parameter(gain, "gain").unit("1").within(0.2, 5.0).starts({1.0}).absent_at(1.0)},
            {Need::current_model, Need::current_A, Need::power_param},
            "current and temperature recorded together over a long run"};
  }

  /// Scales the reading.
  template <class Scalar>
  static void act(const Scalar* p, BenchReadings<Scalar>& read) {
    read.current_A *= p[gain];
  }
};

}  // namespace thermopower::plant
