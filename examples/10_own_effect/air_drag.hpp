// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

//! [own effect]
/// Air drag on something that the axis turns: a torque against the motion, with the square of the rate.
struct AirDrag {
  /// Its parameters, in this order.
  enum Parameters { drag };

  /// What it is, for people and for the engine.
  static thermopower::plant::EffectInfo info() {
    using namespace thermopower::plant;
    return {"air_drag",
            Submodel::mechanical_friction,
            "torque -= c rate |rate|",
            "What the axis turns beats the air: the drag grows with the square of the rate.",
            {parameter(drag, "Nm_s2_per_rad2").unit("N m s^2/rad^2").within(0.0, 1.0).starts({1e-5})},
            {Need::axis_model},
            "fast turns at a steady rate, in both directions"};
  }

  /// Its equation, for numbers and for derivatives alike.
  template <class Scalar>
  static void act(const Scalar* p, thermopower::plant::AxisTerms<Scalar>& terms) {
    using thermopower::plant::magnitude;
    terms.load_Nm -= p[drag] * terms.rate_rad_per_s * magnitude(terms.rate_rad_per_s);
  }
};
//! [own effect]
