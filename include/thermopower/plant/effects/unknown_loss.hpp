// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/curve.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/radians.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// A heat that the body loses besides, as some smooth function of its rise over the air.
///
/// @snippet effects_examples.cpp UnknownLoss
/// How to: @ref diagnose_a_gap, @ref laws.
struct UnknownLoss {
  /// As model files and reports call it.
  static constexpr const char* id = "unknown.loss(rise_K)";

  /// What it is. Its parameters are those of curve_info().
  static EffectInfo info() {
    return curve_info(id, Submodel::thermal_loss, "loss += f(T - T_air)",
                      "The loss goes with the rise over the air in a way that no named loss does.",
                      {CurveVariable::rise_K, CurveScale::heat_W}, "rise_K", "W", "W",
                      {Need::thermal_model, Need::motor_C}, "long holds at many temperatures");
  }

  /// Adds the loss.
  template <class Scalar>
  static void act(const Scalar* p, ThermalTerms<Scalar>& terms) {
    terms.extra_loss_W += curve_at(id, p, Scalar(terms.surface_C - terms.ambient_C));
  }
};

}  // namespace thermopower::plant
