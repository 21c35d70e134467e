// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/friction_transition.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// A gear that loses another part of the power when it drives than when it is driven (Wang and Kim 2015,
/// "Directional efficiency in geared transmissions").
///
/// With M the motor's torque at the gear's output, before losses, what arrives is efficiency M while the motor drives,
/// M w > 0, and M / back_efficiency while the load drives and the motor brakes, M w < 0. Both are M less a dry friction
/// of |M| (1 - efficiency) or |M| (1 / back_efficiency - 1): as such it is simulated, so that a gear at rest holds what
/// its friction holds. Inertia and loads lie behind the gear.
///
/// Where nothing but the motor loads the axis it is the same as `load_friction` with another torque constant, by a factor
/// of (efficiency + 1 / back_efficiency) / 2: what is known of the torque constant tells them apart, or a load that is
/// known. Driven one way only it is a smaller torque constant.
///
/// @snippet effects_examples.cpp DriveEfficiency
/// How to: @ref geared_joint, @ref diagnose_a_gap.
struct DriveEfficiency {
  /// Its parameters, in this order.
  enum Parameters {
    efficiency,       ///< part of the torque that arrives while the motor drives
    back_efficiency,  ///< part of the load's torque that reaches the motor while the load drives
    transition,       ///< rate within which the loss turns over, see friction_transition()
    tail              ///< how slowly it becomes full beyond, see friction_tail()
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    EffectInfo one = {
        "drive_efficiency",
        Submodel::mechanical_friction,
        "torque -= |drive| (1 - efficiency) film(w) where drive w > 0, "
        "|drive| (1 / back_efficiency - 1) film(w) where drive w < 0",
        "A gear loses another part of the torque when the motor drives than when the load does.",
        {parameter(efficiency, "efficiency").unit("1").within(0.05, 1.0).starts({0.85}).absent_at(1.0),
         parameter(back_efficiency, "back_efficiency")
             .unit("1")
             .within(0.05, 1.0)
             .starts({0.7})
             .absent_at(1.0),
         begun_once(friction_transition(transition)), begun_once(friction_tail(tail))},
        {Need::axis_model},
        "driving and braking in turn, under a load that is known"};
    one.is_itself = drives;
    return one;
  }

  /// Whether a tenth of the torque at least arrives while the motor drives: worms and screws pass a fifth, and what takes more
  /// than nine tenths away stands for something that the motion itself feels.
  static bool drives(const double* p) {
    constexpr double least = 0.1;
    return p[efficiency] >= least;
  }

  /// With the first of its starts alone: how the film turns over shows as in `load_friction`, which a fit goes on from.
  static Parameter begun_once(Parameter film) {
    film.starts.resize(1);
    return film;
  }

  /// Adds what the gear loses as dry friction.
  template <class Scalar>
  static void act(const Scalar* p, FrictionTerms<Scalar>& terms) {
    const Scalar size_Nm = magnitude(terms.drive_Nm);
    const Scalar ahead_Nm = (size_Nm + terms.drive_Nm) * 0.5, behind_Nm = (size_Nm - terms.drive_Nm) * 0.5;
    const Scalar driving = 1.0 - p[efficiency], driven = 1.0 / p[back_efficiency] - 1.0;
    terms.add_friction(driving * ahead_Nm + driven * behind_Nm, driving * behind_Nm + driven * ahead_Nm,
                       p[transition], p[tail]);
  }
};

}  // namespace thermopower::plant
