// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// A pure delay between command and torque; any value, not only multiples of the sampling step.
///
/// @snippet effects_examples.cpp ActuationDelay
/// How to: @ref diagnose_a_gap, @ref laws.
struct ActuationDelay {
  /// Its parameters, in this order.
  enum Parameters {
    delay_s  ///< time from command to torque, s
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    EffectInfo one = {"actuation_delay",
                      Submodel::mechanical_drive,
                      "drive(t) = u(t - s)",
                      "The torque comes later than the command.",
                      {parameter(delay_s, "s").unit("s").within(0.0, 1.0).starts({0.002, 0.01, 0.03, 0.08})},
                      {Need::axis_model, Need::open_loop},
                      "fast reversals, recorded at a high rate"};
    one.in_a_joint = in_a_joint;
    return one;
  }

  /// As simulators of bodies have it.
  static void in_a_joint(const double*, JointDescription& joint) {
    joint.remarks.push_back(
        {{delay_s}, "hold the control back by this time, in whole steps of the simulation"});
  }

  /// Delays the command.
  template <class Scalar>
  static void act(const Scalar* p, AxisStructure<Scalar>& shape) {
    shape.delayed = true;
    shape.delay_s = shape.delay_s + p[delay_s];
  }
};

}  // namespace thermopower::plant
