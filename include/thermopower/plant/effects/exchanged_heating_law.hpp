// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// The thesis's heating law r(V, T) with voltage and temperature exchanged. It is the result of a call with its arguments
/// exchanged, and mends a simulation that holds such a call. It has no parameters.
///
/// @snippet effects_examples.cpp ExchangedHeatingLaw
/// How to: @ref diagnose_a_gap, @ref laws.
struct ExchangedHeatingLaw {
  /// Its description, parameters and needs.
  static EffectInfo info() {
    return {"law.exchanged_heating",
            Submodel::thermal_storage,
            "1/r = (s1 T + s0) V + o1 T + o0, where the model has (s1 V + s0) T + o1 V + o0",
            "The heating law was called with the temperature in the voltage's place.",
            {},
            {Need::thermal_model, Need::motor_C, Need::thesis_thermal},
            "the same power on the cold and on the warm motor"};
  }

  /// Exchanges them.
  template <class Scalar>
  static void act(const Scalar*, ThermalStructure<Scalar>& shape) {
    shape.heating_exchanged = true;
  }
};

}  // namespace thermopower::plant
