// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// A temperature coefficient where the simulation has none.
struct WindingTempco {
  /// What it is.
  static EffectInfo info() {
    return {"winding_tempco",
            "electrical",
            "R(T) = R (1 + (a + tempco) (T - T_ref))",
            "The winding's resistance rises with temperature; the simulation had it constant.",
            {{"tempco_per_K", "1/K", 0.0, 0.02, {0.0}, false}},
            {"ohmic current without tempco", "motor_C"},
            "the same power cold and hot, current recorded"};
  }

  /// Adds to the temperature coefficient.
  template <class Scalar>
  static void act(const Scalar* p, ElectricalTerms<Scalar>& terms) {
    terms.tempco_per_K += p[0];
  }
};

}  // namespace thermopower::plant
