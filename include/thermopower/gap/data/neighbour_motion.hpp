// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/robust.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <vector>

/// @file neighbour_motion.hpp
/// Where a sample should lie, judging by the samples before and after it alone. A motion bends: a polynomial
/// through enough neighbours follows the bend, and what it leaves of them says how far it can be trusted.

namespace thermopower::gap::engine {

/// The weights of points in the value at 0 of the polynomial through them. @param at  where they lie, all different
template <std::size_t count>
std::array<double, count> weights_at_zero(const std::array<double, count>& at) {
  std::array<double, count> weights{};
  for (std::size_t k = 0; k < count; ++k) {
    weights[k] = 1.0;
    for (std::size_t j = 0; j < count; ++j)
      if (j != k) weights[k] *= at[j] / (at[j] - at[k]);
  }
  return weights;
}

/// The value at 0 of the polynomial through points. @param at  where they lie, all different  @param values  there
template <std::size_t count>
double polynomial_at_zero(const std::array<double, count>& at, const std::array<double, count>& values) {
  const std::array<double, count> weights = weights_at_zero(at);
  return std::inner_product(weights.begin(), weights.end(), values.begin(), 0.0);
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

  /// How far a sample lies from the polynomial through other ones. @param steps  from it to these, which there must be
  template <std::size_t count>
  double off(std::size_t i, const std::array<std::ptrdiff_t, count>& steps) const {
    std::array<double, count> where{}, what{};
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t j = i + static_cast<std::size_t>(steps[k]);
      assert(j < size());
      where[k] = at[j] - at[i];
      what[k] = values[j];
    }
    return values[i] - polynomial_at_zero(where, what);
  }

  /// The same from the cubic through two neighbours on either side.
  double off_four(std::size_t i) const { return off<4>(i, {-1, -2, 1, 2}); }
};

/// How far a sample lies from the polynomial through four neighbours, should one of the two beside it be far off
/// itself: the farthest that any of three choices of them tells.
inline double off_good_neighbours(const OrderedSamples& samples, std::size_t i) {
  const double farthest = std::abs(samples.off_four(i));
  if (i < 3 || i + 3 >= samples.size()) return farthest;
  return std::max(
      {farthest, std::abs(samples.off<4>(i, {-2, -1, 2, 3})), std::abs(samples.off<4>(i, {-3, -2, 1, 2}))});
}

/// The motion of neighbours beside a sample that takes no part in it.
struct NeighbourMotion {
  double off = 0.0;   ///< the sample less what they predict
  double gain = 1.0;  ///< standard deviation of `off` in white noise of 1
  double rest = 0.0;  ///< root mean square of what the polynomial leaves of them, per degree of freedom
};

/// The polynomial of least squares of some neighbours on either side, at the sample between them. Fewer
/// coefficients than neighbours.
/// @param beside  neighbours on either side (1..5), which there must be
/// @param degree  of the polynomial (0..7), less than 2 beside - 1
inline NeighbourMotion neighbour_motion(const OrderedSamples& samples, std::size_t i, std::size_t beside,
                                        std::size_t degree) {
  assert(i >= beside && i + beside < samples.size() && beside <= 5 && degree < 8 && degree + 1 < 2 * beside);
  const auto count = static_cast<Eigen::Index>(2 * beside);
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 10, 1> at(count), left(count);
  const double width =
      std::max(samples.at[i] - samples.at[i - beside], samples.at[i + beside] - samples.at[i]);
  for (std::size_t j = i - beside, k = 0; j <= i + beside; ++j) {
    if (j == i) continue;
    at[static_cast<Eigen::Index>(k)] = (samples.at[j] - samples.at[i]) / width;
    left[static_cast<Eigen::Index>(k++)] =
        samples.values[j] - samples.values[i];  // so that large values cost no digits
  }
  // Each power, made orthogonal to those before, over the neighbours; the last of each is its value at the sample.
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 11, 8> basis(
      count + 1, static_cast<Eigen::Index>(degree) + 1);
  double predicted = 0.0, variance = 1.0;
  for (Eigen::Index power = 0; power < basis.cols(); ++power) {
    auto one = basis.col(power);
    if (power == 0) one.setOnes();
    else one << at.cwiseProduct(basis.col(power - 1).head(count)), 0.0;
    for (Eigen::Index before = 0; before < power; ++before)
      one -= one.head(count).dot(basis.col(before).head(count)) * basis.col(before);
    one /= one.head(count).norm();
    const double part = one.head(count).dot(left);
    left -= part * one.head(count);
    predicted += part * one[count];
    variance += one[count] * one[count];
  }
  return {-predicted, std::sqrt(variance),
          left.norm() / std::sqrt(static_cast<double>(2 * beside - degree - 1))};
}

/// How far samples lie from the polynomials through two, four and six neighbours: what is least of them, over many
/// samples, is noise. white_scale() knows straight lines alone, and takes the bend of a motion for noise.
class OffNeighbours {
public:
  /// Adds a sample, where it has so many neighbours.
  void add(const OrderedSamples& samples, std::size_t i) {
    if (i < 3 || i + 3 >= samples.size()) return;
    off_[0].push_back(std::abs(samples.off<2>(i, {-1, 1})));
    off_[1].push_back(std::abs(samples.off_four(i)));
    off_[2].push_back(std::abs(samples.off<6>(i, {-1, -2, -3, 1, 2, 3})));
  }

  /// The noise that the samples have, as a standard deviation; 0 where nothing tells. Reorders them.
  double noise() {
    constexpr double normal_median = 0.6745;
    // Of the weights of evenly spaced neighbours and of the sample itself.
    constexpr std::array<double, 3> gains{1.2247448713915890, 1.3944333775567927, 1.5198684153570665};
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < off_.size(); ++k) least = std::min(least, median_of(off_[k]) / gains[k]);
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
