// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/radians.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// Voltage induced by the recorded rate.
///
/// @snippet effects_examples.cpp BackEmf
/// How to: @ref diagnose_a_gap, @ref laws.
struct BackEmf {
  /// Its parameters, in this order.
  enum Parameters {
    V_s_per_rad  ///< voltage that turning induces, by rate, V s/rad
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    return {"back_emf",
            Submodel::electrical,
            "I = (V_rms - k |rate|) / R(T)",
            "A turning motor pushes back: less current at the same voltage.",
            {parameter(V_s_per_rad, "V_s_per_rad").unit("V s/rad").within(0.0, 100.0).starts({0.0})},
            {Need::current_model, Need::current_A, Need::power_param, Need::rate_dps},
            "the same power at rest and turning fast"};
  }

  /// Sets a voltage against the drive.
  template <class Scalar>
  static void act(const Scalar* p, ElectricalTerms<Scalar>& terms) {
    const auto rate_rad_per_s = terms.rate_dps * rad_per_deg;
    terms.counter_V += p[V_s_per_rad] * magnitude(rate_rad_per_s);
  }
};

}  // namespace thermopower::plant
