// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/actuator/cooling.hpp>
#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// The conductance grows with the recorded airspeed; `gain` is its relative growth at 1 m/s.
///
/// @snippet effects_examples.cpp ForcedAirflowEffect
/// How to: @ref diagnose_a_gap, @ref laws.
struct ForcedAirflowEffect {
  /// Its parameters, in this order.
  enum Parameters {
    gain,     ///< how much larger the loss is at 1 m/s, as a part of that in still air
    exponent  ///< power of the airspeed that the loss grows with
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    return {"forced_airflow",
            Submodel::thermal_loss,
            "loss = G (1 + gain v^n) (T - Ta)",
            "Moving air takes more heat away than still air.",
            {parameter(gain, "gain").unit("1").within(0.0, 50.0).starts({0.1}),
             parameter(exponent, "exponent").unit("1").within(0.2, 1.2).starts({0.7})},
            {Need::thermal_model, Need::motor_C, Need::airspeed_mps},
            "the same power with the air still and moving"};
  }

  /// Scales the baseline's conductance.
  template <class Scalar>
  static void act(const Scalar* p, ThermalTerms<Scalar>& terms) {
    const Surroundings<Scalar> around{constant<Scalar>(0.0), Scalar(terms.airspeed_mps)};
    const ForcedAirflow<Scalar> law{constant<Scalar>(1.0), p[gain], p[exponent]};
    terms.conductance_factor *= law.loss_W(constant<Scalar>(1.0), around);
  }
};

}  // namespace thermopower::plant
