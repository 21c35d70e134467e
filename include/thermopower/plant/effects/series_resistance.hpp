// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// Resistance in the circuit that neither warms with the winding nor heats it.
struct SeriesResistance {
  /// What it is.
  static EffectInfo info() {
    return {"series_resistance",
            "electrical",
            "I = V_rms / (R(T) + series)",
            "Leads and switches take part of the voltage and heat something else.",
            {{"ohm", "ohm", 0.0, 1e3, {0.0}, false}},
            {"current", "current_A", "power_param"},
            "a cold and a hot run with current and temperature recorded"};
  }

  /// Adds to the circuit, not to the heat.
  template <class Scalar>
  static void act(const Scalar* p, ElectricalTerms<Scalar>& terms) {
    terms.series_ohm += p[0];
  }
};

}  // namespace thermopower::plant
