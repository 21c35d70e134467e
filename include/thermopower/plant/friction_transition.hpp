// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// The parameter that every dry friction has last: the rate in rad/s within which it turns over, 0.0005 (where
/// the axis sticks) to 0.3; 0.01 where a model leaves it out.
inline Parameter friction_transition() {
  Parameter transition;
  transition.name = "transition_rad_per_s";
  transition.unit = "rad/s";
  transition.lower = friction_sticks_below_rad_per_s;
  transition.upper = 0.3;
  transition.starts = {0.01, 0.06};
  transition.logarithmic = true;
  transition.standard = 0.01;
  return transition;
}

}  // namespace thermopower::plant
