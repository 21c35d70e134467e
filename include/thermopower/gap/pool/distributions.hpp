// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <algorithm>
#include <cassert>
#include <cmath>

namespace thermopower::gap::pool {

/// Regularised incomplete beta function I_x(a, b), by the continued fraction of Abramowitz & Stegun 26.5.8 with Lentz's
/// method. The relative error is below 1e-10 for a and b up to some ten thousand.
/// @param a  > 0
/// @param b  > 0
/// @param x  0..1; outside of it the nearer end counts
inline double regularised_beta(double a, double b, double x) {
  assert(!(a <= 0.0) && !(b <= 0.0));
  if (!(x > 0.0)) return 0.0;
  if (x >= 1.0) return 1.0;
  if (x > (a + 1.0) / (a + b + 2.0)) return 1.0 - regularised_beta(b, a, 1.0 - x);
  constexpr double tiny = 1e-300, enough = 1e-13;
  constexpr int most = 2000;
  const double front =
      std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x));
  const auto away_from_zero = [](double value) { return std::abs(value) < tiny ? tiny : value; };
  double c = 1.0, d = 1.0 / away_from_zero(1.0 - (a + b) * x / (a + 1.0)), h = d;
  for (int m = 1; m < most; ++m) {
    const double even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
    d = 1.0 / away_from_zero(1.0 + even * d);
    c = away_from_zero(1.0 + even / c);
    h *= d * c;
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
    d = 1.0 / away_from_zero(1.0 + odd * d);
    c = away_from_zero(1.0 + odd / c);
    h *= d * c;
    if (std::abs(d * c - 1.0) < enough) break;
  }
  return front * h / a;
}

/// Probability that a variable of the F distribution is above `value`.
/// @param between  its first degrees of freedom, > 0
/// @param within   its second, > 0
inline double f_tail(double value, double between, double within) {
  if (!(value > 0.0)) return 1.0;
  return regularised_beta(0.5 * within, 0.5 * between, within / (within + between * value));
}

/// Probability that Student's t is above `value` in magnitude.
inline double t_tail(double value, double degrees) { return f_tail(value * value, 1.0, degrees); }

/// The value that Student's t exceeds in magnitude with probability `tail`, by bisection; tail in (0, 1).
inline double t_quantile(double tail, double degrees) {
  assert(tail > 0.0 && tail < 1.0 && !(degrees <= 0.0));
  double low = 0.0, high = 1.0;
  while (t_tail(high, degrees) > tail && high < 1e12) high *= 2.0;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (t_tail(middle, degrees) > tail ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Probability that a standard normal variable is above `value` in magnitude.
inline double normal_tail(double value) { return std::erfc(std::abs(value) / std::sqrt(2.0)); }

/// Probability that chi^2 is above `value`: F with a second degree of freedom without end.
inline double chi2_tail(double value, double degrees) {
  constexpr double without_end = 1e7;  // the relative error is of the order of value^2 over it
  return f_tail(value / degrees, degrees, without_end);
}

}  // namespace thermopower::gap::pool
