// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// A torque that repeats several times a turn, with its second harmonic.
///
/// With phi the angle times the cycles and sin_Nm sin(phi) + cos_Nm cos(phi) = A sin(phi + d), the second harmonic is
/// A (second_sin sin(2 phi + d) + second_cos cos(2 phi + d)): stated relative to the first, so that there is none
/// without a first, and a torque of twelve cycles is not six that lack their first harmonic.
///
/// @snippet effects_examples.cpp Cogging
/// How to: @ref diagnose_a_gap, @ref laws.
struct Cogging {
  /// Its parameters, in this order.
  enum Parameters {
    sin_Nm,           ///< part that goes with the sine of the angle times the cycles, N m
    cos_Nm,           ///< part that goes with the cosine, N m
    cycles_per_turn,  ///< how often it repeats in a turn
    second_sin,       ///< second harmonic in phase with the first, as a share of its size
    second_cos        ///< second harmonic a quarter of its period ahead, as a share of the first's size
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    return {
        "cogging",
        Submodel::mechanical_load,
        "torque -= A sin(p + d) + second_sin A sin(2 p + d) + second_cos A cos(2 p + d), p = cycles theta, "
        "sin_Nm = A cos(d), cos_Nm = A sin(d)",
        "Magnets hold the rotor at preferred angles, several times a turn.",
        {parameter(sin_Nm, "sin_Nm").unit("N m").within(-1e3, 1e3).starts({0.0}),
         parameter(cos_Nm, "cos_Nm").unit("N m").within(-1e3, 1e3).starts({0.0}),
         parameter(cycles_per_turn, "cycles_per_turn")
             .unit("1")
             .within(1.6, 400.0)
             .periods_in_travel(2.0)
             .starts({2,  3,  4,  5,  6,  7,  8,  9,  10, 11, 12, 13, 14, 15, 16, 17,
                      18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30, 32, 34, 36,
                      38, 40, 42, 44, 46, 48, 52, 56, 60, 66, 72, 84, 96, 120}),
         parameter(second_sin, "second_sin")
             .unit("1")
             .within(-0.9, 0.9)
             .starts({0.0})
             .standard(0.0)
             .refines(),
         parameter(second_cos, "second_cos")
             .unit("1")
             .within(-0.9, 0.9)
             .starts({0.0})
             .standard(0.0)
             .refines()},
        {Need::axis_model, Need::angle_deg},
        "slow motion through a full turn in both directions"};
  }

  /// Adds a torque periodic in the angle.
  template <class Scalar>
  static void act(const Scalar* p, AxisTerms<Scalar>& terms) {
    using std::cos;
    using std::sin;
    const Scalar phase = p[cycles_per_turn] * terms.angle_rad;
    const Scalar s = sin(phase), c = cos(phase);
    if (is_constant(p[second_sin], 0.0) && is_constant(p[second_cos], 0.0)) {
      terms.load_Nm -= p[sin_Nm] * s + p[cos_Nm] * c;
      return;
    }
    const Scalar s2 = 2.0 * s * c, c2 = c * c - s * s;
    terms.load_Nm -= p[sin_Nm] * (s + p[second_sin] * s2 + p[second_cos] * c2) +
                     p[cos_Nm] * (c + p[second_sin] * c2 - p[second_cos] * s2);
  }
};

}  // namespace thermopower::plant
