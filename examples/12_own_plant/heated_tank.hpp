// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/state_plant.hpp>

#include <cmath>

//! [own plant]
/// A tank that a pump fills, that empties itself through a hole, and whose water a heater warms.
struct HeatedTank {
  /// What it is made of: the order here is that of every array below.
  static thermopower::plant::PlantInfo info() {
    thermopower::plant::PlantInfo info;
    info.type = "heated_tank";
    info.constants = {{"tank", "area_m2", "m^2", 0.05},
                      {"tank", "outflow_m2p5_per_s", "m^2.5/s", 3e-4},
                      {"wall", "conductance_W_per_K", "W/K", 8.0}};
    info.inputs = {
        {"inflow_m3_per_s", "m^3/s"}, {"heater_W", "W"}, {"inlet_C", "degC"}, {"room_C", "degC", 20.0}};
    info.states = {{"level", "m", 0, 0.3, 0.2}, {"water", "degC", 1, 20.0, 20.0}};
    info.signals = {{"level_m", "m", "tank.outflow"}, {"water_C", "degC", "wall.loss"}};
    return info;
  }

  /// The terms of its two balances: what an effect sees, and what it changes.
  template <class Scalar>
  struct Terms {
    Scalar level_m, water_C;  ///< given
    Scalar room_C;            ///< given
    Scalar outflow_m3_per_s;  ///< to change
    Scalar loss_W;            ///< to change
  };

  /// d(state)/dt.
  template <class Scalar, class Effects>
  static void flow(const Scalar* constants, const Scalar* states, const Scalar* inputs,
                   const Effects& effects, Scalar* rates) {
    using std::sqrt;
    constexpr double J_per_m3_K = 998.0 * 4182.0;  // water
    const Scalar level_m = thermopower::plant::at_least(states[0], 1e-3);
    Terms<Scalar> terms{states[0], states[1], inputs[3], constants[1] * sqrt(level_m),
                        constants[2] * (states[1] - inputs[3])};
    effects(terms);  // a plant::ActingEffects: all that act, in their order
    rates[0] = (inputs[0] - terms.outflow_m3_per_s) / constants[0];
    rates[1] = (inputs[1] - terms.loss_W + J_per_m3_K * inputs[0] * (inputs[2] - states[1])) /
               (J_per_m3_K * constants[0] * level_m);
  }

  /// What its instruments show.
  template <class Scalar, class Effects>
  static void read(const Scalar*, const Scalar* states, const Scalar*, const Effects&, Scalar* signals) {
    signals[0] = states[0];
    signals[1] = states[1];
  }
};
//! [own plant]

//! [own plant's effects]
/// Water that seeps through a seam, the more the higher it stands.
struct Seepage {
  enum Parameters { m2_per_s };  ///< by which act() reads them
  /// What it is, for people and for the engine.
  static thermopower::plant::EffectInfo info() {
    using namespace thermopower::plant;
    return {"seepage",
            SubmodelName("tank.outflow"),
            "outflow += k level",
            "Water seeps through a seam: the tank loses more than its outlet lets pass.",
            {parameter(m2_per_s, "m2_per_s").unit("m^2/s").within(0.0, 1.0).starts({1e-5, 1e-4})},
            {},
            "fill the tank, stop the pump, and watch the level"};
  }
  /// Its equation, for numbers and for derivatives alike.
  template <class Scalar>
  static void act(const Scalar* p, HeatedTank::Terms<Scalar>& terms) {
    terms.outflow_m3_per_s += p[m2_per_s] * terms.level_m;
  }
};

/// Warm water evaporates, the more the warmer it is.
struct Evaporation {
  enum Parameters { W_per_K2 };  ///< by which act() reads them
  /// What it is, for people and for the engine.
  static thermopower::plant::EffectInfo info() {
    using namespace thermopower::plant;
    return {"evaporation",
            SubmodelName("wall.loss"),
            "loss += k (T - T_room)^2",
            "Warm water evaporates: hot, the tank loses more than its walls conduct.",
            {parameter(W_per_K2, "W_per_K2").unit("W/K^2").within(0.0, 100.0).starts({0.05, 1.0})},
            {},
            "cool down from hot with the pump at rest"};
  }
  /// Its equation.
  template <class Scalar>
  static void act(const Scalar* p, HeatedTank::Terms<Scalar>& terms) {
    const Scalar rise_K = terms.water_C - terms.room_C;
    terms.loss_W += p[W_per_K2] * rise_K * rise_K;
  }
};
//! [own plant's effects]
