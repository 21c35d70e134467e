// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>

namespace thermopower::plant {

/// A spring and a damper with free play between two sides: teeth in a gap. Inside the gap nothing is transmitted; at
/// either of its ends the sides meet on the spring and the damper, and never pull, as teeth that part do not stick.
///
/// The gap is centred at a twist of 0. The damper makes the torque jump where two sides meet: what integrates it stops
/// there (AxisStep does), for an end that is rounded instead softens each blow, and what follows a blow never forgets it.
///
/// @snippet plant_examples.cpp free play
/// How the whole works: @ref gap_method.
template <class Scalar>
struct FreePlay {
  Scalar gap_rad;    ///< from end to end, > 0
  Scalar stiffness;  ///< per rad, in any unit of torque
  Scalar damping;    ///< per rad/s, in the same unit

  /// How far the twist lies beyond an end, rad; inside the gap below 0.
  /// @param end    +1 or -1: the end at positive twists, or at negative ones
  /// @param twist  of the far side relative to the near one, rad
  Scalar beyond(int end, const Scalar& twist) const {
    return static_cast<double>(end) * twist - 0.5 * gap_rad;
  }

  /// The force of an end if the sides could also pull: below 0 it does not touch.
  /// @param twist_rate  of the far side relative to the near one, rad/s
  Scalar pressed(int end, const Scalar& twist, const Scalar& twist_rate) const {
    return stiffness * beyond(end, twist) + damping * (static_cast<double>(end) * twist_rate);
  }

  /// The end at which the sides touch, +1 or -1; 0: none.
  int touching(const Scalar& twist, const Scalar& twist_rate) const {
    const int end = value_of(twist) < 0.0 ? -1 : 1;
    const bool touches =
        value_of(beyond(end, twist)) > 0.0 && value_of(pressed(end, twist, twist_rate)) > 0.0;
    return touches ? end : 0;
  }

  /// The torque while the sides touch at an end, or at none (0); positive where the twist is.
  Scalar torque(int end, const Scalar& twist, const Scalar& twist_rate) const {
    if (end == 0) return constant<Scalar>(0.0);
    return static_cast<double>(end) * pressed(end, twist, twist_rate);
  }
};

}  // namespace thermopower::plant
