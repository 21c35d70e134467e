// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// A first-order lag of the thermometer.
///
/// @snippet effects_examples.cpp ThermometerLag
/// How to: @ref diagnose_a_gap, @ref laws.
struct ThermometerLag {
  /// Its parameters, in this order.
  enum Parameters {
    lag_s  ///< time constant of the thermometer, s
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    return {
        "thermometer_lag",
        Submodel::sensing_temperature,
        "lag dS/dt = T - S, S is read",
        "The thermometer follows late: corners of the temperature curve are rounded and shifted.",
        {parameter(lag_s, "lag_s").unit("s").within(0.05, 3000.0).logarithmic().starts({3.0, 20.0, 100.0})},
        {Need::thermal_model, Need::motor_C},
        "power steps sampled faster than the lag"};
  }

  /// Puts a first-order lag between body and reading.
  template <class Scalar>
  static void act(const Scalar* p, ThermalStructure<Scalar>& shape) {
    shape.lagged = true;
    shape.thermometer_lag_s = p[lag_s];
  }
};

}  // namespace thermopower::plant
