// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// A constant loss of duty.
///
/// @snippet effects_examples.cpp DeadTime
/// How to: @ref diagnose_a_gap, @ref laws.
struct DeadTime {
  /// Its parameters, in this order.
  enum Parameters {
    duty_lost  ///< part of each period that is lost, as duty
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    return {"dead_time",
            Submodel::electrical,
            "duty = max(0, power_param / 255 - lost)",
            "The bridge loses a fixed part of each period: low powers suffer most.",
            {parameter(duty_lost, "duty_lost").unit("1").within(0.0, 0.5).starts({0.0, 0.01, 0.03, 0.08})},
            {Need::current_model, Need::current_A, Need::power_param},
            "holds at low power parameters"};
  }

  /// Takes a fixed part of the duty.
  template <class Scalar>
  static void act(const Scalar* p, ElectricalTerms<Scalar>& terms) {
    const Scalar left = terms.duty - p[duty_lost];
    if (value_of(terms.duty) > 0.0) terms.duty = value_of(left) > 0.0 ? left : constant<Scalar>(0.0);
  }
};

}  // namespace thermopower::plant
