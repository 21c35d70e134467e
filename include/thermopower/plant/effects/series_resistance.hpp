// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// Resistance in the circuit that neither warms with the winding nor heats it.
///
/// @snippet effects_examples.cpp SeriesResistance
/// How to: @ref diagnose_a_gap, @ref laws.
struct SeriesResistance {
  /// Its parameters, in this order.
  enum Parameters {
    ohm  ///< resistance of leads and switches, ohm
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    return {"series_resistance",
            Submodel::electrical,
            "I = V_rms / (R(T) + series)",
            "Leads and switches take part of the voltage and heat something else.",
            {parameter(ohm, "ohm").unit("ohm").within(0.0, 1e3).starts({0.0})},
            {Need::current_model, Need::current_A, Need::power_param},
            "a cold and a hot run with current and temperature recorded"};
  }

  /// Adds to the circuit, not to the heat.
  template <class Scalar>
  static void act(const Scalar* p, ElectricalTerms<Scalar>& terms) {
    terms.series_ohm += p[ohm];
  }
};

}  // namespace thermopower::plant
