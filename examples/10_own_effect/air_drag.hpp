// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

//! [own effect]
/// Air drag on something that the axis turns: a torque against the motion, with the square of the rate.
struct AirDrag {
  /// What it is, for people and for the engine.
  static thermopower::plant::EffectInfo info() {
    return {"air_drag",
            "mechanical.friction",
            "torque -= c rate |rate|",
            "What the axis turns beats the air: the drag grows with the square of the rate.",
            {{"Nm_s2_per_rad2", "N m s^2/rad^2", 0.0, 1.0, {1e-5}, false}},
            {"axis"},
            "fast turns at a steady rate, in both directions"};
  }

  /// Its equation, for numbers and for derivatives alike.
  template <class Scalar>
  static void act(const Scalar* p, thermopower::plant::AxisTerms<Scalar>& terms) {
    using thermopower::plant::magnitude;
    terms.load_Nm -= p[0] * terms.rate_rad_per_s * magnitude(terms.rate_rad_per_s);
  }
};
//! [own effect]
