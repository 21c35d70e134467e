// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/actuator/cooling.hpp>
#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// Natural convection in place of Newton's law; at a rise of `reference_K` both lose the same.
///
/// @snippet effects_examples.cpp NaturalConvectionEffect
/// How to: @ref diagnose_a_gap, @ref laws.
struct NaturalConvectionEffect {
  /// Its parameters, in this order.
  enum Parameters {
    exponent,    ///< power of the rise by which the conductance grows
    reference_K  ///< rise at which the conductance is the model's, K
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    EffectInfo one{"natural_convection",
                   Submodel::thermal_loss,
                   "loss = G (T - Ta) (|T - Ta| / reference)^n",
                   "Warm air rises faster the warmer it is: the loss grows faster than the temperature rise.",
                   {parameter(exponent, "exponent").unit("1").within(0.0, 1.0).starts({0.2}),
                    parameter(reference_K, "reference_K")
                        .unit("K")
                        .within(1.0, 300.0)
                        .logarithmic()
                        .starts({15.0, 40.0})},
                   {Need::thermal_model, Need::motor_C},
                   "holds at several powers and a long cooling curve in still air"};
    one.is_itself = rises_by_itself;
    return one;
  }

  /// Whether the loss grows no faster than that of air that rises by itself, which is turbulent at most (n = 1/3; Churchill & Chu
  /// 1975), and of a hot surface's radiation in it. A loss that grows faster sets in somewhere: a fan, or a liquid that
  /// boils.
  static bool rises_by_itself(const double* p) {
    constexpr double most = 0.6;
    return p[exponent] <= most;
  }

  /// Scales the baseline's conductance.
  template <class Scalar>
  static void act(const Scalar* p, ThermalTerms<Scalar>& terms) {
    const Surroundings<Scalar> around{terms.ambient_C, constant<Scalar>(0.0)};
    const NaturalConvection<Scalar> law{constant<Scalar>(1.0), p[exponent], p[reference_K]};
    const Scalar rise_K = terms.surface_C - terms.ambient_C;
    if (value_of(rise_K) != 0.0) terms.conductance_factor *= law.loss_W(terms.surface_C, around) / rise_K;
  }
};

}  // namespace thermopower::plant
