// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/curve.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/radians.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// A voltage against the drive, as some smooth function of the temperature of the winding.
///
/// @snippet effects_examples.cpp UnknownVoltage
/// How to: @ref diagnose_a_gap, @ref laws.
struct UnknownVoltage {
  /// As model files and reports call it.
  static constexpr const char* id = "unknown.voltage(motor_C)";

  /// What it is. Its parameters are those of curve_info().
  static EffectInfo info() {
    return curve_info(
        id, Submodel::electrical, "V -= f(motor_C)",
        "The voltage at the winding goes with its temperature in a way that no named cause has.",
        {CurveVariable::motor_C, CurveScale::supply_V}, "motor_C", "V", "V",
        {Need::current_model, Need::current_A, Need::motor_C},
        "the same power twice, once cold and once hot, with the motor current logged");
  }

  /// Adds the voltage.
  template <class Scalar>
  static void act(const Scalar* p, ElectricalTerms<Scalar>& terms) {
    terms.counter_V += curve_at(id, p, terms.winding_C);
  }
};

}  // namespace thermopower::plant
