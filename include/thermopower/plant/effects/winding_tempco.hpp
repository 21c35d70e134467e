// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// A temperature coefficient where the simulation has none.
///
/// @snippet effects_examples.cpp WindingTempco
/// How to: @ref diagnose_a_gap, @ref laws.
struct WindingTempco {
  /// Its parameters, in this order.
  enum Parameters {
    tempco_per_K  ///< what the winding's temperature coefficient is larger by, 1/K
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    return {"winding_tempco",
            Submodel::electrical,
            "R(T) = R (1 + (a + tempco) (T - T_ref))",
            "The winding's resistance rises with temperature; the simulation had it constant.",
            {parameter(tempco_per_K, "tempco_per_K").unit("1/K").within(0.0, 0.02).starts({0.0})},
            {Need::ohmic_without_tempco, Need::motor_C},
            "the same power twice, once cold and once hot, with the motor current logged"};
  }

  /// Adds to the temperature coefficient.
  template <class Scalar>
  static void act(const Scalar* p, ElectricalTerms<Scalar>& terms) {
    terms.tempco_per_K += p[tempco_per_K];
  }
};

}  // namespace thermopower::plant
