// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// A torque that is always there.
///
/// @snippet effects_examples.cpp ConstantTorque
/// How to: @ref diagnose_a_gap, @ref laws.
struct ConstantTorque {
  /// Its parameters, in this order.
  enum Parameters {
    size_Nm  ///< the torque, N m; positive pushes towards positive angles
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    EffectInfo one = {
        "constant_torque",
        Submodel::mechanical_load,
        "torque += Nm",
        "A weight on a pulley, a preload, or an offset of the command: a torque that nothing changes.",
        {parameter(size_Nm, "Nm").unit("N m").within(-1e3, 1e3).starts({0.0})},
        {Need::axis_model},
        "slow motion at constant rate in both directions, and rest with the drive off"};
    one.in_a_joint = in_a_joint;
    return one;
  }

  /// As simulators of bodies have it.
  static void in_a_joint(const double* p, JointDescription& joint) { joint.offset_Nm += p[size_Nm]; }

  /// Adds the torque.
  template <class Scalar>
  static void act(const Scalar* p, AxisTerms<Scalar>& terms) {
    terms.load_Nm += p[size_Nm];
  }
};

}  // namespace thermopower::plant
