// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// Internal resistance and discharge of a supply whose voltage was not recorded.
struct SupplySag {
  /// What it is.
  static EffectInfo info() {
    return {"supply_sag",
            "electrical",
            "V = V0 - internal I_supply - slope Q, I_supply = I sqrt(duty)",
            "The supply is not logged and gives way under load and as it discharges.",
            {{"internal_ohm", "ohm", 0.0, 1e3, {0.0}, false}, {"V_per_Ah", "V/Ah", 0.0, 1e3, {0.0}, false}},
            {"current", "current_A", "power_param", "no supply_V"},
            "log the supply voltage; or high and low power in turn, early and late in a discharge"};
  }

  /// Lowers the supply by load and charge.
  template <class Scalar>
  static void act(const Scalar* p, ElectricalTerms<Scalar>& terms) {
    terms.source_ohm += p[0];
    terms.supply_V -= p[1] * terms.charge_Ah;
  }
};

}  // namespace thermopower::plant
