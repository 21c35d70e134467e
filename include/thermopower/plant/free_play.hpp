// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>

#include <cmath>

namespace thermopower::plant {

/// What a spring with free play does at a twist.
template <class Scalar>
struct FreePlay {
  Scalar stretch_rad;  ///< of the spring: 0 inside the gap, beyond it the twist past the gap's end
  Scalar engaged;      ///< 0 inside the gap, 1 beyond it: the share of the damper that acts
};

/// A gap of `gap_rad` from end to end, centred at a twist of 0. Its ends are rounded over a hundredth of its half, so
/// that what follows from the gap is differentiable: the stretch is a softplus of the twist past the end, and the share
/// engaged its slope.
template <class Scalar>
FreePlay<Scalar> free_play(const Scalar& twist_rad, const Scalar& gap_rad) {
  using std::exp;
  using std::log;
  constexpr double rounded = 0.01;  // of the half
  constexpr double far = 30.0;      // from here on exp(-x) is below a double's digits
  const Scalar half_rad = 0.5 * gap_rad, width_rad = rounded * half_rad;
  const bool forward = value_of(twist_rad) >= 0.0;
  const Scalar past = ((forward ? twist_rad : Scalar(-twist_rad)) - half_rad) / width_rad;
  if (value_of(past) > far) {
    const Scalar stretch_rad = forward ? Scalar(twist_rad - half_rad) : Scalar(twist_rad + half_rad);
    return {stretch_rad, constant<Scalar>(1.0)};
  }
  if (value_of(past) < -far) return {constant<Scalar>(0.0), constant<Scalar>(0.0)};
  const Scalar grown = exp(past);
  const Scalar stretch_rad = width_rad * log(Scalar(1.0 + grown));
  return {forward ? stretch_rad : Scalar(-stretch_rad), grown / (1.0 + grown)};
}

}  // namespace thermopower::plant
