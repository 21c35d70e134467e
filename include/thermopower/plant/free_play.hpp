// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>

#include <cmath>

namespace thermopower::plant {

/// What a spring and a damper with free play transmit at a twist: nothing inside the gap, and beyond its ends never a
/// pull, as teeth that part do not stick.
///
/// The gap is centred at a twist of 0. Its ends are rounded over a hundredth of its half, so that what follows from the
/// gap is differentiable: the stretch is a softplus of the twist past the end, and the share of the damper that acts its
/// slope.
/// @param twist, twist_rate  of the far side relative to the near one, rad and rad/s
/// @param gap_rad            from end to end, > 0
/// @param stiffness, damping per rad and per rad/s, in any unit of torque
/// @return in that unit, positive where the twist is
template <class Scalar>
Scalar across_gap(const Scalar& twist, const Scalar& twist_rate, const Scalar& gap_rad,
                  const Scalar& stiffness, const Scalar& damping) {
  using std::exp;
  using std::log;
  constexpr double rounded = 0.01;  // of the half
  constexpr double far = 30.0;      // from here on exp(-x) is below a double's digits
  const bool forward = value_of(twist) >= 0.0;
  const Scalar half_rad = 0.5 * gap_rad, width_rad = rounded * half_rad;
  const Scalar past = ((forward ? twist : Scalar(-twist)) - half_rad) / width_rad;
  if (value_of(past) < -far) return constant<Scalar>(0.0);
  const Scalar closing = forward ? twist_rate : Scalar(-twist_rate);
  Scalar pressed;
  if (value_of(past) > far) {
    pressed = stiffness * (past * width_rad) + damping * closing;
  } else {
    const Scalar grown = exp(past);
    pressed =
        stiffness * (width_rad * log(Scalar(1.0 + grown))) + damping * closing * (grown / (1.0 + grown));
  }
  if (!(value_of(pressed) > 0.0)) return constant<Scalar>(0.0);
  return forward ? pressed : Scalar(-pressed);
}

}  // namespace thermopower::plant
