// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/standard_catalogue.hpp>

#include <cmath>

/// Effects that only a test knows: nothing else in the tree names them.
namespace own_effects {

namespace plant = thermopower::plant;
using plant::Need;
using plant::Submodel;
using plant::value_of;

/// A loss with a branch and a loop: a heat pipe that starts to carry at a temperature.
struct HeatPipe {
  enum Parameters { W_per_K, starts_at_C };
  static plant::EffectInfo info() {
    return {"heat_pipe",
            Submodel::thermal_loss,
            "loss += g (T - start) while T > start, the more the warmer",
            "A heat pipe carries heat away above a temperature.",
            {plant::parameter(W_per_K, "W_per_K").unit("W/K").within(0.0, 10.0).starts({0.0}),
             plant::parameter(starts_at_C, "starts_at_C").unit("degC").within(0.0, 200.0).starts({40.0})},
            {Need::thermal_model},
            "holds below and above its start"};
  }
  template <class Scalar>
  static void act(const Scalar* p, plant::ThermalTerms<Scalar>& terms) {
    if (terms.surface_C > p[starts_at_C]) {
      Scalar loss_W = p[W_per_K] * (terms.surface_C - p[starts_at_C]);
      for (int i = 0; i < 2; ++i) loss_W = loss_W * (1.0 + 0.01 * loss_W);
      terms.extra_loss_W += loss_W;
    }
  }
};

/// A drag with the square of the rate, in one direction only, and a bump of the angle.
struct Paddle {
  enum Parameters { drag, bump_Nm };
  static plant::EffectInfo info() {
    return {"paddle",
            Submodel::mechanical_friction,
            "torque -= c w^2 while w > 0, + bump exp(-theta^2)",
            "A paddle with a flap.",
            {plant::parameter(drag, "drag").unit("N m s^2/rad^2").within(0.0, 1.0).starts({1e-5}),
             plant::parameter(bump_Nm, "bump_Nm").unit("N m").within(-1.0, 1.0).starts({0.01})},
            {Need::axis_model},
            "fast turns"};
  }
  template <class Scalar>
  static void act(const Scalar* p, plant::AxisTerms<Scalar>& terms) {
    using std::exp;
    if (value_of(terms.rate_rad_per_s) > 0.0)
      terms.load_Nm -= p[drag] * terms.rate_rad_per_s * terms.rate_rad_per_s;
    terms.load_Nm += p[bump_Nm] * exp(-terms.angle_rad * terms.angle_rad);
  }
};

/// An equation that no export can follow: it rounds a plain number.
struct Rounded {
  enum Parameters { step_V };
  static plant::EffectInfo info() {
    return {"rounded",
            Submodel::electrical,
            "V = step floor(V / step)",
            "A converter with steps.",
            {plant::parameter(step_V, "step_V").unit("V").within(0.01, 1.0).starts({0.1})},
            {Need::current_model},
            "a slow ramp"};
  }
  template <class Scalar>
  static void act(const Scalar* p, plant::ElectricalTerms<Scalar>& terms) {
    const double steps = std::floor(value_of(terms.supply_V) / value_of(p[step_V]));
    terms.supply_V = p[step_V] * steps;
  }
};

}  // namespace own_effects
