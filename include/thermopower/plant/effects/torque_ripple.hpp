// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

#include <cmath>

namespace thermopower::plant {

/// A torque constant that varies with the angle.
///
/// @snippet effects_examples.cpp TorqueRipple
/// How to: @ref diagnose_a_gap, @ref laws.
struct TorqueRipple {
  /// Its parameters, in this order.
  enum Parameters {
    sin_share,       ///< part of the torque that goes with the sine of the angle times the cycles
    cos_share,       ///< part that goes with the cosine
    cycles_per_turn  ///< how often it repeats in a turn
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    EffectInfo one = {
        "torque_ripple",
        Submodel::mechanical_drive,
        "torque = drive (1 + sin_share sin(cycles theta) + cos_share cos(cycles theta))",
        "The same current gives more torque at some angles than at others, several times a turn.",
        {parameter(sin_share, "sin_share").within(-1.0, 1.0).starts({0.0}),
         parameter(cos_share, "cos_share").within(-1.0, 1.0).starts({0.0}),
         parameter(cycles_per_turn, "cycles_per_turn").within(1.6, 400.0).starts({2,  3,  4,  5,  6,  7,
                                                                                  8,  9,  10, 11, 12, 13,
                                                                                  14, 16, 18, 20, 21, 22,
                                                                                  24, 28, 30, 33, 36, 40,
                                                                                  42, 44, 48, 54, 60, 72})},
        {Need::axis_model, Need::angle_deg},
        "slow motion through a full turn at large and at small current"};
    one.is_itself = leaves_torque;
    return one;
  }

  /// Whether the drive still gives torque at every angle, a tenth of it at least: what takes it away or turns it around at some
  /// angles is something that holds the axis there.
  static bool leaves_torque(const double* p) {
    constexpr double most = 0.9;
    return std::hypot(p[sin_share], p[cos_share]) <= most;
  }

  /// Scales what arrives of the drive.
  template <class Scalar>
  static void act(const Scalar* p, AxisTerms<Scalar>& terms) {
    using std::cos;
    using std::sin;
    const Scalar phase = p[cycles_per_turn] * terms.angle_rad;
    terms.delivered_Nm += terms.drive_Nm * (p[sin_share] * sin(phase) + p[cos_share] * cos(phase));
  }
};

}  // namespace thermopower::plant
