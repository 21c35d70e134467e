// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/simulation/vector_math.hpp>

/// @file sine.hpp
/// One sine for every scalar of the simulation.

namespace thermopower::simulation {

/// Sine of an angle, without a branch and the same for every scalar: a lane of a batch and a plain number
/// take the same additions and multiplications, and compilers turn both into vector instructions.
///
/// Error below 1e-12 in double and 1e-6 in float for angles up to a thousand turns; the angle's own rounding
/// comes on top. The error is absolute: of an angle below it no digit is left. NaN and Inf give NaN.
/// @param angle_rad  up to 2^51 turns in double, 2^22 in float
template <class Number>
Number sine(const Number& angle_rad) noexcept {
  using Real = typename thermopower::detail::Numeric<Number>::Real;
  constexpr bool is_double = sizeof(Real) > 4;
  // Adding and taking away a number whose last digit is 1 rounds to whole turns.
  const Real unit_digit = is_double ? static_cast<Real>(6755399441055744.0) : static_cast<Real>(12582912.0);
  // A quarter of a turn earlier it is a cosine, which is even: so a magnitude folds it to a quarter of a
  // turn.
  const Number turns = angle_rad * static_cast<Real>(0.15915494309189535) - Real(0.25);
  const Number shifted = turns + unit_digit;
  const Number whole = shifted - unit_digit;
  const Number x = Real(0.25) - VectorMath<Number>::absolute(Number(turns - whole));
  const Number square = x * x;
  // The polynomials of least largest error for sin(2 pi x) on -1/4 .. 1/4: 4e-14 and 3e-9.
  if constexpr (is_double) {
    Number series = square * Real(3.655084109001314961) - Real(15.07929495585570381);
    series = series * square + Real(42.05796387841392067);
    series = series * square - Real(76.70584112988999304);
    series = series * square + Real(81.60524903205844699);
    series = series * square - Real(41.34170223898956355);
    series = series * square + Real(6.28318530717722857);
    return x * series;
  } else {
    Number series = square * static_cast<Real>(39.53670744) - static_cast<Real>(76.54978252);
    series = series * square + static_cast<Real>(81.60100408);
    series = series * square - static_cast<Real>(41.34165503);
    series = series * square + static_cast<Real>(6.28318516);
    return x * series;
  }
}

}  // namespace thermopower::simulation
