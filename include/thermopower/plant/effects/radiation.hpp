// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/actuator/cooling.hpp>
#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// Radiation to surroundings at air temperature; emissivity and area only show as their product.
///
/// @snippet effects_examples.cpp Radiation
/// How to: @ref diagnose_a_gap, @ref laws.
struct Radiation {
  /// Its parameters, in this order.
  enum Parameters {
    emissive_area_m2  ///< emissivity times the area that radiates, m^2
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    return {"radiation",
            Submodel::thermal_loss,
            "loss += sigma A eps (T^4 - Ta^4), in kelvin",
            "Hot surfaces lose more than in proportion to their temperature rise.",
            {parameter(emissive_area_m2, "emissive_area_m2").unit("m^2").within(0.0, 10.0).starts({0.0})},
            {Need::thermal_model, Need::motor_C},
            "long holds at the highest and at a low temperature"};
  }

  /// Adds the radiated power.
  template <class Scalar>
  static void act(const Scalar* p, ThermalTerms<Scalar>& terms) {
    const Surroundings<Scalar> around{terms.ambient_C, constant<Scalar>(0.0)};
    const RadiationCooling<Scalar> law{p[emissive_area_m2], constant<Scalar>(1.0)};
    terms.extra_loss_W += law.loss_W(terms.surface_C, around);
  }
};

}  // namespace thermopower::plant
