// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// A constant error of the current sensor.
///
/// @snippet effects_examples.cpp CurrentSensorOffset
/// How to: @ref diagnose_a_gap, @ref laws.
struct CurrentSensorOffset {
  /// Its parameters, in this order.
  enum Parameters {
    offset_A  ///< reading at no current, A
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    return {"current_sensor_offset",
            Submodel::sensing_current,
            "reading = I + offset",
            "The current sensor does not read zero at zero.",
            {parameter(offset_A, "A").unit("A").within(-100.0, 100.0).starts({0.0})},
            {Need::current_model, Need::current_A, Need::power_param},
            "a rest with the power off"};
  }

  /// Shifts the reading.
  template <class Scalar>
  static void act(const Scalar* p, BenchReadings<Scalar>& read) {
    read.current_A += p[offset_A];
  }
};

}  // namespace thermopower::plant
