// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../detail/numeric.hpp"

/// @file sine.hpp
/// One sine for every scalar of the simulation.

namespace thermopower::simulation {

/// Sine of an angle, without a branch and the same for every scalar: a lane of a batch and a plain number
/// take the same additions and multiplications, and compilers turn both into vector instructions.
///
/// Error below 2e-11 in double and 1e-6 in float for angles up to a thousand turns; the angle's own rounding
/// comes on top. NaN and Inf give NaN.
/// @param angle_rad  up to 2^51 turns in double, 2^22 in float
template <class Number>
Number sine(const Number& angle_rad) noexcept {
  using Real = typename thermopower::detail::Numeric<Number>::Real;
  constexpr bool is_double = sizeof(Real) > 4;
  // Adding and taking away a number whose last digit is 1 rounds to whole turns.
  const Real unit_digit = is_double ? static_cast<Real>(6755399441055744.0) : static_cast<Real>(12582912.0);
  const Real turn_rad = static_cast<Real>(6.283185307179586);
  const Number turns = angle_rad * static_cast<Real>(0.15915494309189535);
  const Number shifted = turns + unit_digit;
  const Number whole = shifted - unit_digit;
  const Number x = (turns - whole) * turn_rad;
  const Number square = x * x;
  // The series of x - x^3/3! + ... on -pi .. pi, up to x^21 in double and x^17 in float.
  Number series = square * Real(0);
  if constexpr (is_double) {
    series = Real(1) - square * static_cast<Real>(1.0 / 420.0);
    series = Real(1) - square * series * static_cast<Real>(1.0 / 342.0);
  } else {
    series = series + Real(1);
  }
  series = Real(1) - square * series * static_cast<Real>(1.0 / 272.0);
  series = Real(1) - square * series * static_cast<Real>(1.0 / 210.0);
  series = Real(1) - square * series * static_cast<Real>(1.0 / 156.0);
  series = Real(1) - square * series * static_cast<Real>(1.0 / 110.0);
  series = Real(1) - square * series * static_cast<Real>(1.0 / 72.0);
  series = Real(1) - square * series * static_cast<Real>(1.0 / 42.0);
  series = Real(1) - square * series * static_cast<Real>(1.0 / 20.0);
  series = Real(1) - square * series * static_cast<Real>(1.0 / 6.0);
  return x * series;
}

}  // namespace thermopower::simulation
