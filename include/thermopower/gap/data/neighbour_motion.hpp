// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/robust.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <vector>

/// @file neighbour_motion.hpp
/// Where a sample should lie, judging by the samples before and after it alone. A motion bends: a polynomial through enough
/// neighbours follows the bend, and what it leaves of them says how far it can be trusted.

namespace thermopower::gap::engine {

/// The value at 0 of the polynomial through points. @param at  where they lie, all different  @param values  there
template <std::size_t count>
double polynomial_at_zero(const std::array<double, count>& at, const std::array<double, count>& values) {
  double sum = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    double weight = 1.0;
    for (std::size_t j = 0; j < count; ++j)
      if (j != k) weight *= at[j] / (at[j] - at[k]);
    sum += weight * values[k];
  }
  return sum;
}

/// Finite samples of a run, in order.
struct OrderedSamples {
  std::vector<Eigen::Index> rows;  ///< of the recording
  std::vector<double> at;          ///< their stamps in s, or their rows where there are no stamps
  std::vector<double> values;      ///< themselves

  /// @param t_s  stamps; nullptr: rows
  OrderedSamples(const Eigen::VectorXd& column, const Eigen::VectorXd* t_s, const RunSpan& run) {
    for (Eigen::Index i = run.begin; i < run.end; ++i) {
      if (!std::isfinite(column[i])) continue;
      rows.push_back(i);
      at.push_back(t_s != nullptr ? (*t_s)[i] : static_cast<double>(i));
      values.push_back(column[i]);
    }
  }

  /// Number of samples.
  std::size_t size() const { return rows.size(); }

  /// How far a sample lies from the polynomial through `beside` neighbours on either side, which there must be.
  template <std::size_t beside>
  double off_neighbours(std::size_t i) const {
    assert(i >= beside && i + beside < size());
    std::array<double, 2 * beside> where{}, what{};
    for (std::size_t k = 0; k < beside; ++k) {
      where[k] = at[i - k - 1] - at[i];
      what[k] = values[i - k - 1];
      where[beside + k] = at[i + k + 1] - at[i];
      what[beside + k] = values[i + k + 1];
    }
    return values[i] - polynomial_at_zero(where, what);
  }
};

/// How far a sample lies from the polynomial through four neighbours, should one of the two beside it be far off itself: the
/// farthest that any of three choices of them tells.
inline double off_good_neighbours(const OrderedSamples& samples, std::size_t i) {
  double farthest = std::abs(samples.off_neighbours<2>(i));
  if (i < 3 || i + 3 >= samples.size()) return farthest;
  const auto off = [&](const std::array<std::ptrdiff_t, 4>& steps) {
    std::array<double, 4> where{}, what{};
    for (std::size_t k = 0; k < steps.size(); ++k) {
      const auto j = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(i) + steps[k]);
      where[k] = samples.at[j] - samples.at[i];
      what[k] = samples.values[j];
    }
    return std::abs(samples.values[i] - polynomial_at_zero(where, what));
  };
  return std::max({farthest, off({-2, -1, 2, 3}), off({-3, -2, 1, 2})});
}

/// What neighbours say of a sample that takes no part in it.
struct NeighbourMotion {
  double off = 0.0;   ///< the sample less what they predict
  double gain = 1.0;  ///< standard deviation of `off` in white noise of 1
  double rest = 0.0;  ///< root mean square of what the polynomial leaves of them, per degree of freedom
};

/// The polynomial of least squares of some neighbours on either side, at the sample between them. Fewer coefficients than
/// neighbours.
/// @param beside  neighbours on either side (1..5), which there must be
/// @param degree  of the polynomial (0..7), less than 2 beside - 1
inline NeighbourMotion neighbour_motion(const OrderedSamples& samples, std::size_t i, std::size_t beside,
                                        std::size_t degree) {
  constexpr std::size_t most = 10, most_coefficients = 8;
  assert(i >= beside && i + beside < samples.size() && 2 * beside <= most);
  assert(degree < most_coefficients && degree + 1 < 2 * beside);
  std::size_t count = 0;
  std::array<double, most> left{};
  // Each power, made orthogonal to those before, over the neighbours; the last of each is its value at the sample.
  std::array<std::array<double, most + 1>, most_coefficients> basis{};
  const double width =
      std::max(samples.at[i] - samples.at[i - beside], samples.at[i + beside] - samples.at[i]);
  std::array<double, most> at{};
  for (std::size_t j = i - beside; j <= i + beside; ++j) {
    if (j == i) continue;
    at[count] = (samples.at[j] - samples.at[i]) / width;
    left[count] = samples.values[j] - samples.values[i];  // so that large values cost no digits
    ++count;
  }
  double predicted = 0.0, variance = 1.0;
  for (std::size_t power = 0; power <= degree; ++power) {
    std::array<double, most + 1>& one = basis[power];
    for (std::size_t k = 0; k < count; ++k) one[k] = power == 0 ? 1.0 : at[k] * basis[power - 1][k];
    one[most] = power == 0 ? 1.0 : 0.0;
    for (std::size_t before = 0; before < power; ++before) {
      double along = 0.0;
      for (std::size_t k = 0; k < count; ++k) along += one[k] * basis[before][k];
      for (std::size_t k = 0; k <= most; ++k) one[k] -= along * basis[before][k];
    }
    double squares = 0.0, part = 0.0;
    for (std::size_t k = 0; k < count; ++k) squares += one[k] * one[k];
    for (double& x : one) x /= std::sqrt(squares);
    for (std::size_t k = 0; k < count; ++k) part += one[k] * left[k];
    for (std::size_t k = 0; k < count; ++k) left[k] -= part * one[k];
    predicted += part * one[most];
    variance += one[most] * one[most];
  }
  double squares = 0.0;
  for (std::size_t k = 0; k < count; ++k) squares += left[k] * left[k];
  return {-predicted, std::sqrt(variance), std::sqrt(squares / static_cast<double>(count - degree - 1))};
}

/// How far samples lie from the polynomials through two, four and six neighbours: what is least of them, over many samples, is
/// noise. white_scale() knows straight lines alone, and takes the bend of a motion for noise.
class OffNeighbours {
public:
  /// Adds a sample, where it has so many neighbours.
  void add(const OrderedSamples& samples, std::size_t i) {
    if (i < 3 || i + 3 >= samples.size()) return;
    off_[0].push_back(std::abs(samples.off_neighbours<1>(i)));
    off_[1].push_back(std::abs(samples.off_neighbours<2>(i)));
    off_[2].push_back(std::abs(samples.off_neighbours<3>(i)));
  }

  /// The noise that the samples have, as a standard deviation; 0 where nothing tells. Reorders them.
  double noise() {
    constexpr double normal_median = 0.6745;
    // Of the weights of evenly spaced neighbours and of the sample itself.
    constexpr std::array<double, 3> gains{1.2247448713915890, 1.3944333775567927, 1.5198684153570665};
    double least = median_of(off_[0]) / gains[0];
    for (std::size_t k = 1; k < off_.size(); ++k) least = std::min(least, median_of(off_[k]) / gains[k]);
    return least / normal_median;
  }

private:
  std::array<std::vector<double>, 3> off_;
};

/// Scale of the noise around a sample, as a standard deviation; 0 where nothing tells.
/// @param around  samples before and after that tell  @param but  samples beside it that do not
inline double noise_around(const OrderedSamples& samples, std::size_t i, std::size_t around,
                           std::size_t but) {
  OffNeighbours off;
  for (std::size_t k = i < around ? 0 : i - around; k < std::min(samples.size(), i + around + 1); ++k)
    if (k + but < i || k > i + but) off.add(samples, k);
  return off.noise();
}

/// So many samples of a long recording that their quantiles are known to a hundredth: each so many-th.
inline std::size_t each_of_many(const std::vector<RunSpan>& runs) {
  constexpr Eigen::Index enough = 20000;
  Eigen::Index rows = 0;
  for (const RunSpan& run : runs) rows += run.size();
  return static_cast<std::size_t>(std::max<Eigen::Index>(1, rows / enough));
}

/// Scale of the noise on a motion, as a standard deviation.
/// @param t_s  stamps; nullptr: rows
inline double noise_on_motion(const Eigen::VectorXd& values, const Eigen::VectorXd* t_s,
                              const std::vector<RunSpan>& runs) {
  OffNeighbours off;
  const std::size_t each = each_of_many(runs);
  for (const RunSpan& run : runs) {
    const OrderedSamples samples(values, t_s, run);
    for (std::size_t i = 0; i < samples.size(); i += each) off.add(samples, i);
  }
  return off.noise();
}

}  // namespace thermopower::gap::engine
