// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// A drag that grows with the square of the rate: a propeller, a fan, a pump.
///
/// @snippet effects_examples.cpp QuadraticDrag
/// How to: @ref diagnose_a_gap, @ref laws.
struct QuadraticDrag {
  /// Its parameters, in this order.
  enum Parameters {
    Nm_s2_per_rad2  ///< torque by the square of the rate, N m s^2/rad^2
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    return {
        "quadratic_drag",
        Submodel::mechanical_friction,
        "torque -= c w |w|",
        "A propeller, fan or pump moves air or water: its torque grows with the square of the rate.",
        {parameter(Nm_s2_per_rad2, "Nm_s2_per_rad2").unit("N m s^2/rad^2").within(0.0, 10.0).starts({0.0})},
        {Need::axis_model},
        "steady turning, slow and fast, in each direction that the load allows"};
  }

  /// Takes the drag off the torques.
  template <class Scalar>
  static void act(const Scalar* p, AxisTerms<Scalar>& terms) {
    const Scalar& rate = terms.rate_rad_per_s;
    terms.load_Nm -= p[Nm_s2_per_rad2] * rate * magnitude(rate);
  }
};

}  // namespace thermopower::plant
