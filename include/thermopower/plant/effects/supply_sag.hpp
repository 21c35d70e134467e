// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// Internal resistance and discharge of a supply whose voltage was not recorded.
///
/// @snippet effects_examples.cpp SupplySag
/// How to: @ref diagnose_a_gap, @ref laws.
struct SupplySag {
  /// Its parameters, in this order.
  enum Parameters {
    internal_ohm,  ///< internal resistance of the supply, ohm
    V_per_Ah       ///< loss of voltage by charge taken, V/Ah
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    return {"supply_sag",
            Submodel::electrical,
            "V = V0 - internal I_supply - slope Q, I_supply = I sqrt(duty)",
            "The supply is not logged and gives way under load and as it discharges.",
            {parameter(internal_ohm, "internal_ohm").unit("ohm").within(0.0, 1e3).starts({0.0}),
             parameter(V_per_Ah, "V_per_Ah").unit("V/Ah").within(0.0, 1e3).starts({0.0})},
            {Need::current_model, Need::current_A, Need::power_param, Need::supply_not_logged},
            "log the supply voltage; or high and low power in turn, early and late in a discharge"};
  }

  /// Lowers the supply by load and charge.
  template <class Scalar>
  static void act(const Scalar* p, ElectricalTerms<Scalar>& terms) {
    terms.source_ohm += p[internal_ohm];
    terms.supply_V -= p[V_per_Ah] * terms.charge_Ah;
  }
};

}  // namespace thermopower::plant
