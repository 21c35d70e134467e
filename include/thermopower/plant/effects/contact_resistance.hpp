// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// A heat sink or a frame behind a contact. The surface gives it heat through the contact's resistance, and it loses heat
/// to the air.
///
/// The body is what it was without, heat capacity and loss; the sink comes on top of it. With one thermometer that is the
/// same circuit as `second_thermal_mass` or `enclosure` with other constants of the body: what is known of those tells them apart.
///
/// @snippet effects_examples.cpp ContactResistance
/// How to: @ref motor_on_a_frame, @ref diagnose_a_gap.
struct ContactResistance {
  /// Its parameters, in this order.
  enum Parameters {
    capacity_J_per_K,    ///< heat capacity of the sink, J/K
    resistance_K_per_W,  ///< of the contact, K/W
    conductance_W_per_K  ///< from the sink to the air, W/K
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    EffectInfo info{
        "contact_resistance",
        Submodel::thermal_loss,
        "Cs dS/dt = (H - S) / R - g (S - Ta), and (H - S) / R is missing from the surface H",
        "A sink or a frame behind a contact takes heat from the body and loses it to the air.",
        {parameter(capacity_J_per_K, "J_per_K").unit("J/K").within(0.1, 1e5).logarithmic().starts({100.0}),
         parameter(resistance_K_per_W, "K_per_W")
             .unit("K/W")
             .within(1e-2, 1e3)
             .logarithmic()
             .starts({4.0, 40.0}),
         parameter(conductance_W_per_K, "W_per_K").unit("W/K").within(0.0, 50.0).starts({0.1})},
        {Need::thermal_model, Need::motor_C},
        "a long step of power with the motor bolted on and off, and the temperature of what it is bolted to"};
    // A sink that hardly changes in a run is air of another temperature.
    info.slowest_s = [](const double* p) {
      return p[capacity_J_per_K] * p[resistance_K_per_W] /
             (1.0 + p[conductance_W_per_K] * p[resistance_K_per_W]);
    };
    return info;
  }

  /// Puts the sink behind the surface.
  template <class Scalar>
  static void act(const Scalar* p, ThermalStructure<Scalar>& shape) {
    shape.soaks = shape.soaking_added = true;
    shape.soaking_J_per_K = p[capacity_J_per_K];
    shape.soaking_W_per_K = 1.0 / p[resistance_K_per_W];
    shape.soaking_loss_W_per_K = p[conductance_W_per_K];
  }
};

}  // namespace thermopower::plant
