// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// The parameter that every dry friction has: the rate in rad/s within which it turns over, 0.0005 (where the
/// axis sticks) to 1; 0.01 where a model leaves it out.
/// @param index  by which the effect reads it
inline Parameter friction_transition(int index) {
  return parameter(index, "transition_rad_per_s")
      .unit("rad/s")
      .within(friction_sticks_below_rad_per_s, 1.0)
      .logarithmic()
      .starts({0.01, 0.06})
      .standard(0.01);
}

/// The other parameter that every dry friction has: how slowly it becomes full beyond the transition, from -1 (in
/// proportion to the rate, then at once) over 0 (as tanh) to 1 (as x / (1 + |x|)); 0 where a model leaves it out.
/// @param index  by which the effect reads it
inline Parameter friction_tail(int index) {
  return parameter(index, "tail").unit("1").within(-1.0, 1.0).starts({0.0, 0.6}).standard(0.0).two_families();
}

}  // namespace thermopower::plant
