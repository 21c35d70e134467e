// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/robust.hpp>

#include <algorithm>
#include <array>
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
