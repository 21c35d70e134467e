// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/curve.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/radians.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// A heat that the body gains besides, as some smooth function of the current.
///
/// @snippet effects_examples.cpp UnknownHeat
/// How to: @ref diagnose_a_gap, @ref laws.
struct UnknownHeat {
  /// As model files and reports call it.
  static constexpr const char* id = "unknown.heat(current_A)";

  /// What it is. Its parameters are those of curve_info().
  static EffectInfo info() {
    return curve_info(id, Submodel::thermal_heating, "P += f(current_A)",
                      "The heat goes with the current in a way that no named heating does.",
                      {CurveVariable::current_A, CurveScale::heat_W}, "current_A", "W", "W",
                      {Need::thermal_model, Need::motor_C}, "long holds at many currents");
  }

  /// Adds the heat.
  template <class Scalar>
  static void act(const Scalar* p, ThermalTerms<Scalar>& terms) {
    terms.heat_W += curve_at(id, p, terms.current_A);
  }
};

}  // namespace thermopower::plant
