// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/radians.hpp>
#include <thermopower/plant/terms.hpp>

#include <cmath>

namespace thermopower::plant {

/// An encoder whose disc or magnet sits off the centre: its error is periodic in the angle.
///
/// @snippet effects_examples.cpp EncoderEccentricity
/// How to: @ref diagnose_a_gap, @ref laws.
struct EncoderEccentricity {
  /// Its parameters, in this order.
  enum Parameters {
    sin_deg,         ///< part that goes with the sine of the angle times the cycles, deg
    cos_deg,         ///< part that goes with the cosine, deg
    cycles_per_turn  ///< how often it repeats in a turn
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    return {"encoder_eccentricity",
            Submodel::sensing_angle,
            "reading = angle + sin_deg sin(n angle) + cos_deg cos(n angle)",
            "The encoder sits off the centre: it is wrong by a periodic function of the angle.",
            {parameter(sin_deg, "sin_deg").unit("deg").within(-10.0, 10.0).starts({0.0}),
             parameter(cos_deg, "cos_deg").unit("deg").within(-10.0, 10.0).starts({0.0}),
             parameter(cycles_per_turn, "cycles_per_turn")
                 .unit("1")
                 .within(0.8, 40.0)
                 .periods_in_travel(0.2)
                 .starts({1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0})},
            {Need::axis_model, Need::angle_deg, Need::rate_dps},
            "several turns, angle and rate recorded together"};
  }

  /// Adds the periodic error.
  template <class Scalar>
  static void act(const Scalar* p, AxisReadings<Scalar>& read) {
    using std::cos;
    using std::sin;
    const Scalar phase_rad = read.angle_deg * p[cycles_per_turn] * rad_per_deg;
    read.angle_deg += p[sin_deg] * sin(phase_rad) + p[cos_deg] * cos(phase_rad);
  }
};

}  // namespace thermopower::plant
