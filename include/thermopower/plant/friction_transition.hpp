// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// The parameter that every dry friction has: the rate in rad/s within which it turns over, 0.0005 (where the
/// axis sticks) to 0.3; 0.01 where a model leaves it out.
/// @param index  by which the effect reads it
inline Parameter friction_transition(int index) {
  return parameter(index, "transition_rad_per_s")
      .unit("rad/s")
      .within(friction_sticks_below_rad_per_s, 0.3)
      .logarithmic()
      .starts({0.01, 0.06})
      .standard(0.01);
}

}  // namespace thermopower::plant
