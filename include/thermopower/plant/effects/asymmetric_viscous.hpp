// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// Viscous friction that differs between the directions.
///
/// @snippet effects_examples.cpp AsymmetricViscous
/// How to: @ref diagnose_a_gap, @ref laws.
struct AsymmetricViscous {
  /// Its parameters, in this order.
  enum Parameters {
    forward,  ///< torque by rate where the rate is positive, N m s/rad
    backward  ///< torque by rate where it is negative, N m s/rad
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    EffectInfo one = {
        "asymmetric_viscous",
        Submodel::mechanical_friction,
        "torque -= (forward where w > 0, else backward) w",
        "Viscous friction that differs between the two directions, besides the model's own.",
        {parameter(forward, "forward_Nms_per_rad").unit("N m s/rad").within(-1e3, 1e3).starts({0.0}),
         parameter(backward, "backward_Nms_per_rad").unit("N m s/rad").within(-1e3, 1e3).starts({0.0})},
        {Need::axis_model},
        "fast turns at constant rate in both directions"};
    one.where_equal = WhereEqual{forward, backward, "calibration.viscous"};
    return one;
  }

  /// Adds viscous friction by direction.
  template <class Scalar>
  static void act(const Scalar* p, FrictionTerms<Scalar>& terms) {
    const Scalar& rate = terms.rate_rad_per_s;
    terms.torque_Nm += value_of(rate) > 0.0 ? Scalar(p[forward] * rate) : Scalar(p[backward] * rate);
  }
};

}  // namespace thermopower::plant
