// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// Heat by the supply's voltage in place of the effective one; a share of 1 is all of it.
///
/// @snippet effects_examples.cpp SupplyPowerHeating
/// How to: @ref diagnose_a_gap, @ref laws.
struct SupplyPowerHeating {
  /// Its parameters, in this order.
  enum Parameters {
    share  ///< part of what is lost between supply and winding that heats the motor
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    return {"supply_power_heating",
            Submodel::thermal_heating,
            "P = V_rms I + share (V_supply - V_rms) I",
            "The measured current is drawn at the supply: the heat is V_supply I and not V_rms I.",
            {parameter(share, "share").unit("1").within(0.0, 1.5).starts({0.0})},
            {Need::thermal_model, Need::motor_C, Need::power_param},
            "the same current at low and at full duty"};
  }

  /// Adds the power between supply and V_rms.
  template <class Scalar>
  static void act(const Scalar* p, ThermalTerms<Scalar>& terms) {
    terms.heat_W += p[share] * (terms.supply_V - terms.v_rms_V) * terms.current_A;
  }
};

}  // namespace thermopower::plant
