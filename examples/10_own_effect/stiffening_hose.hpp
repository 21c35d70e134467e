// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

//! [own effect]
/// A hose that stiffens as it bends: a torque back to its rest, with the cube of the angle.
struct StiffeningHose {
  /// Its parameters, in this order.
  enum Parameters {
    stiffness  ///< torque by the cube of the angle, N m/rad^3
  };

  /// What it is, for people and for the engine.
  static thermopower::plant::EffectInfo info() {
    using namespace thermopower::plant;
    return {"stiffening_hose",
            Submodel::mechanical_load,
            "torque -= k theta^3",
            "A hose that bends with the axis pulls back, the more the further it is bent.",
            {parameter(stiffness, "Nm_per_rad3").unit("N m/rad^3").within(0.0, 10.0).starts({1e-3})},
            {Need::axis_model, Need::angle_deg},
            "slow motion over the full travel"};
  }

  /// Its equation, for numbers and for derivatives alike.
  template <class Scalar>
  static void act(const Scalar* p, thermopower::plant::AxisTerms<Scalar>& terms) {
    const Scalar& angle = terms.angle_rad;
    terms.load_Nm -= p[stiffness] * angle * angle * angle;
  }
};
//! [own effect]
