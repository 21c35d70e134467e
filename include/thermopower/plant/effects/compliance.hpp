// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// Two inertias on a spring; the near one is driven and measured.
struct Compliance {
  /// What it is.
  static EffectInfo info() {
    return {
        "compliance",
        "mechanical.structure",
        "J1 dw/dt = drive - spring, J2 dw2/dt = spring",
        "Part of the inertia hangs on a spring: the axis rings.",
        {{"far_share", "1", 0.01, 0.97, {0.2, 0.6}, false},
         {"frequency_Hz", "Hz", 0.2, 300.0, {1.5, 2.2, 3.3, 5.0, 7.5, 11.0, 16.0, 25.0, 40.0, 60.0}, true},
         {"damping", "1", 1e-4, 2.0, {0.03}, true}},
        {"axis"},
        "fast reversals and a frequency sweep"};
  }

  /// Puts part of the inertia behind a spring.
  template <class Scalar>
  static void act(const Scalar* p, AxisStructure<Scalar>& shape) {
    shape.compliant = true;
    shape.far_share = p[0];
    shape.spring_rad_per_s = p[1] * 6.283185307179586;
    shape.spring_damping = p[2];
  }
};

}  // namespace thermopower::plant
