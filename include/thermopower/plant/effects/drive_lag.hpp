// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// A first-order lag between command and torque.
///
/// @snippet effects_examples.cpp DriveLag
/// How to: @ref diagnose_a_gap, @ref laws.
struct DriveLag {
  /// Its parameters, in this order.
  enum Parameters {
    lag_s  ///< time constant of the torque, s
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    EffectInfo info{
        "drive_lag",
        Submodel::mechanical_drive,
        "lag dM/dt = drive - M, M acts",
        "The torque follows its command late: winding inductance, a filter, a slow current loop.",
        {parameter(lag_s, "lag_s").unit("s").within(5e-4, 3.0).logarithmic().starts({0.005, 0.02, 0.08})},
        {Need::axis_model},
        "steps of the command, recorded at a high rate"};
    info.states = {{"lagged_Nm", "N m"}};
    info.in_a_joint = in_a_joint;
    return info;
  }

  /// As simulators of bodies have it.
  static void in_a_joint(const double* p, JointDescription& joint) { joint.lag_s = p[lag_s]; }

  /// Lets the torque follow.
  template <class Scalar>
  static void act(const Scalar* p, AxisTerms<Scalar>& terms) {
    OwnState<Scalar>& lagged_Nm = terms.own[0];
    lagged_Nm.per_s = 1.0 / p[lag_s];
    lagged_Nm.slope = terms.drive_Nm * lagged_Nm.per_s;
    terms.delivered_Nm += lagged_Nm.value - terms.drive_Nm;
  }
};

}  // namespace thermopower::plant
