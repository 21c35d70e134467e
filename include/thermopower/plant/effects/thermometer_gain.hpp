// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// A thermometer that scales the rise over air temperature.
///
/// @snippet effects_examples.cpp ThermometerGain
/// How to: @ref diagnose_a_gap, @ref laws.
struct ThermometerGain {
  /// Its parameters, in this order.
  enum Parameters {
    gain  ///< part of the temperature rise that is shown
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    return {"thermometer_gain",
            Submodel::sensing_temperature,
            "reading = Ta + gain (T - Ta)",
            "The thermometer shows only part of the temperature rise (a wrong emissivity, a poor contact).",
            {parameter(gain, "gain").unit("1").within(0.2, 2.0).starts({1.0}).absent_at(1.0)},
            {Need::thermal_model, Need::motor_C},
            "runs with the current recorded: the winding's resistance knows the true temperature"};
  }

  /// Scales the rise over the air.
  template <class Scalar>
  static void act(const Scalar* p, BenchReadings<Scalar>& read) {
    read.motor_C = p[gain] * (read.motor_C - read.measured_ambient_C) + read.measured_ambient_C;
  }
};

}  // namespace thermopower::plant
