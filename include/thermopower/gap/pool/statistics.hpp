// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

namespace thermopower::gap::pool {

/// The middle of a sample; 0 where it is empty.
inline double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Where a condition that holds at `low` ends before `high`, by bisection.
template <class Condition>
double end_of(double low, double high, const Condition& holds) {
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (holds(middle) ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

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
  const auto away_from_zero = [](double value) { return std::abs(value) < tiny ? tiny : value; };
  double c = 1.0, d = 1.0, fraction = 1.0;
  const auto take = [&](double coefficient) {
    d = 1.0 / away_from_zero(1.0 + coefficient * d);
    c = away_from_zero(1.0 + coefficient / c);
    fraction *= c * d;
  };
  d = 1.0 / away_from_zero(1.0 - (a + b) * x / (a + 1.0));
  fraction = d;
  for (int m = 1; m < most && (m == 1 || std::abs(c * d - 1.0) >= enough); ++m) {
    take(m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m)));
    take(-(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0)));
  }
  return fraction / a *
         std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) +
                  b * std::log1p(-x));
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

/// The value that Student's t exceeds in magnitude with probability `tail`; tail in (0, 1).
inline double t_quantile(double tail, double degrees) {
  assert(tail > 0.0 && tail < 1.0 && !(degrees <= 0.0));
  const auto is_exceeded_more = [&](double value) { return t_tail(value, degrees) > tail; };
  double high = 1.0;
  while (is_exceeded_more(high) && high < 1e12) high *= 2.0;
  return end_of(0.0, high, is_exceeded_more);
}

/// Probability that a standard normal variable is above `value` in magnitude.
inline double normal_tail(double value) { return std::erfc(std::abs(value) / std::sqrt(2.0)); }

/// Probability that chi^2 is above `value`: F with a second degree of freedom without end.
inline double chi2_tail(double value, double degrees) {
  constexpr double without_end = 1e7;  // the relative error is of the order of value^2 over it
  return f_tail(value / degrees, degrees, without_end);
}

/// Wilcoxon's signed-rank test, one-sided: probability that values around 0 would be as much above it. By ranks, as one
/// log far off must not decide for a fleet; the normal approximation, which is good from six values on. With fewer it is 1.
inline double signed_rank_p(std::vector<double> values) {
  constexpr std::size_t fewest = 6;
  values.erase(std::remove(values.begin(), values.end(), 0.0), values.end());
  if (values.size() < fewest) return 1.0;
  std::sort(values.begin(), values.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  double sum = 0.0, square = 0.0, rank = 0.0;
  for (const double one : values) {
    rank += 1.0;
    sum += std::copysign(rank, one);
    square += rank * rank;
  }
  const double z = (sum - 1.0) / std::sqrt(square);  // continuity
  return z > 0.0 ? 0.5 * normal_tail(z) : 1.0 - 0.5 * normal_tail(z);
}

/// Holm's step-down: which of many tests stand at a family-wise error of `level`.
inline std::vector<bool> holm(const std::vector<double>& p, double level) {
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });
  std::vector<bool> stands(p.size(), false);
  for (std::size_t place = 0; place < order.size(); ++place) {
    if (!(p[order[place]] * static_cast<double>(p.size() - place) <= level)) break;
    stands[order[place]] = true;
  }
  return stands;
}

}  // namespace thermopower::gap::pool
