// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <cmath>

/// @file
/// The hyperbolic tangent of the transitions of friction.

namespace thermopower::plant {

/// Hyperbolic tangent to 1e-15 of itself, in half the time of the C library's: a search for causes takes some ten million of
/// them. About 0 it is a Pade approximant, further away the exponential's.
/// @param x  any; what is no number stays none
inline double hyperbolic_tangent(double x) {
  constexpr double by_quotient = 0.55;  // up to here the quotient is exact, beyond it little cancels
  constexpr double is_one = 20.0;       // in double precision
  const double size = std::abs(x);
  if (size < by_quotient) {
    const double z = x * x;
    return x * (135135.0 + z * (17325.0 + z * (378.0 + z))) /
           (135135.0 + z * (62370.0 + z * (3150.0 + z * 28.0)));
  }
  if (!(size < is_one)) return std::isnan(x) ? x : std::copysign(1.0, x);
  return std::copysign(1.0 - 2.0 / (std::exp(2.0 * size) + 1.0), x);
}

/// The same of any other scalar of the models, by its own `tanh`.
template <class Scalar>
Scalar hyperbolic_tangent(const Scalar& x) {
  return tanh(x);
}

}  // namespace thermopower::plant
