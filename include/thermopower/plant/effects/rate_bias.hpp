// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// A constant error of the rate sensor.
///
/// @snippet effects_examples.cpp RateBias
/// How to: @ref diagnose_a_gap, @ref laws.
struct RateBias {
  /// Its parameters, in this order.
  enum Parameters {
    bias_dps  ///< reading at rest, deg/s
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    return {"rate_bias",
            Submodel::sensing_rate,
            "reading = rate + bias",
            "The gyro does not read zero at rest.",
            {parameter(bias_dps, "dps").unit("deg/s").within(-1e3, 1e3).starts({0.0})},
            {Need::axis_model, Need::rate_dps},
            "a standstill of a few seconds"};
  }

  /// Shifts the reading.
  template <class Scalar>
  static void act(const Scalar* p, AxisReadings<Scalar>& read) {
    read.rate_dps += p[bias_dps];
  }
};

}  // namespace thermopower::plant
