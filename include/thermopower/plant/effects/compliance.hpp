// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/radians.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// Two inertias on a spring; the near one is driven and measured.
///
/// @snippet effects_examples.cpp Compliance
/// How to: @ref diagnose_a_gap, @ref laws.
struct Compliance {
  /// Its parameters, in this order.
  enum Parameters {
    far_share,     ///< part of the inertia that is behind the spring
    frequency_Hz,  ///< frequency of the spring, Hz
    damping        ///< damping ratio of the spring; 1 is critical
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    EffectInfo one = {
        "compliance",
        Submodel::mechanical_structure,
        "J1 dw/dt = drive - spring, J2 dw2/dt = spring",
        "Part of the inertia hangs on a spring: the axis rings.",
        {parameter(far_share, "far_share").unit("1").within(0.01, 0.97).starts({0.2, 0.6}),
         parameter(frequency_Hz, "frequency_Hz")
             .unit("Hz")
             .within(0.2, 300.0)
             .logarithmic()
             .starts({1.5, 2.2, 3.3, 5.0, 7.5, 11.0, 16.0, 25.0, 40.0, 60.0}),
         // A spring with more damping does not ring: it is a drag, or a command that comes early or late.
         parameter(damping, "damping")
             .unit("1")
             .within(1e-4, 2.0)
             .logarithmic()
             .starts({0.03})
             .degenerate_at_upper()},
        {Need::axis_model, Need::shown_inertia},
        "fast reversals and a frequency sweep"};
    one.in_a_joint = in_a_joint;
    return one;
  }

  /// As simulators of bodies have it.
  static void in_a_joint(const double* p, JointDescription& joint) {
    joint.far_side = JointFarSide{p[far_share], rad_per_turn * p[frequency_Hz], p[damping]};
  }

  /// Puts part of the inertia behind a spring.
  template <class Scalar>
  static void act(const Scalar* p, AxisStructure<Scalar>& shape) {
    shape.compliant = true;
    shape.far_share = p[far_share];
    shape.spring_rad_per_s = p[frequency_Hz] * rad_per_turn;
    shape.spring_damping = p[damping];
  }
};

}  // namespace thermopower::plant
