// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/radians.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// Part of the inertia is coupled with free play. Inside the gap nothing is transmitted; at its ends two sides meet on a
/// spring and a damper. The near side is driven and measured.
///
/// @snippet effects_examples.cpp Backlash
/// How to: @ref diagnose_a_gap, @ref laws.
struct Backlash {
  /// Its parameters, in this order.
  enum Parameters {
    gap_rad,     ///< the whole gap, rad
    far_share,   ///< part of the inertia that is behind the gap
    contact_Hz,  ///< frequency at which the far side would ring on the contact's spring, Hz
    damping      ///< damping ratio of the contact; 1 is critical
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    EffectInfo info{
        "backlash",
        Submodel::mechanical_structure,
        "J1 dw/dt = drive - contact(q), J2 dw2/dt = contact(q), contact = 0 for |q| < gap / 2",
        "Teeth have play: the far side is free for an angle after each reversal, and then it is hit.",
        {parameter(gap_rad, "gap_rad")
             .unit("rad")
             .within(1e-3, 1.0)
             .logarithmic()
             .starts({0.015, 0.06})
             .degenerate_at_bounds(),
         parameter(far_share, "far_share").unit("1").within(0.02, 0.97).starts({0.35, 0.65}),
         parameter(contact_Hz, "contact_Hz").unit("Hz").within(5.0, 50.0).logarithmic().starts({20.0}),
         parameter(damping, "damping").unit("1").within(1e-3, 2.0).logarithmic().starts({0.15})},
        {Need::axis_model, Need::shown_inertia},
        "slow reversals at small torque, and fast ones"};
    info.costly = info.strikes = true;
    return info;
  }

  /// Puts part of the inertia behind a gap.
  template <class Scalar>
  static void act(const Scalar* p, AxisStructure<Scalar>& shape) {
    shape.compliant = true;
    shape.gapped = true;
    shape.far_share = p[far_share];
    shape.spring_rad_per_s = p[contact_Hz] * rad_per_turn;
    shape.spring_damping = p[damping];
    shape.gap_rad = p[gap_rad];
  }
};

}  // namespace thermopower::plant
