// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/pool/mixed_effects.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <vector>

namespace thermopower::gap::pool {

/// How a unit stands among the others.
struct Standing {
  double distance = 0.0;           ///< Mahalanobis distance from the others' mean
  double p = 1.0;                  ///< probability of such a distance for a sound unit
  bool odd = false;                ///< beyond what sound units would show
  Eigen::Index coordinate = 0;     ///< in which it is furthest off
  double standard_deviations = 0;  ///< by how much, of the spread and the estimate's error together, signed
};

/// Which units of a fleet are odd, and how the others spread.
struct OddUnits {
  std::vector<Standing> units;  ///< as given
  MixedEffects sound;           ///< of the units that are not odd
};

namespace detail {

/// The middle of a sample, 0 of none.
inline double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The units nearest to the coordinates' medians: a core that up to two fifths of odd units cannot pull away.
inline std::vector<bool> core_of(const std::vector<Estimate>& units) {
  assert(!units.empty());
  const Eigen::Index k = units.front().at.size();
  std::vector<double> far(units.size(), 0.0);
  for (Eigen::Index c = 0; c < k; ++c) {
    std::vector<double> values, errors;
    for (const Estimate& one : units) {
      values.push_back(one.at[c]);
      errors.push_back(one.covariance(c, c));
    }
    const double middle = median(values), error = median(errors);
    for (double& one : values) one = std::abs(one - middle);
    constexpr double normal = 1.4826;  // standard deviations in a median absolute deviation
    const double scale = std::max(normal * median(values), 1e-12 * (1.0 + std::abs(middle)));
    const double between = std::max(scale * scale - error, 0.0);
    for (std::size_t i = 0; i < units.size(); ++i)
      far[i] =
          std::max(far[i], std::abs(units[i].at[c] - middle) / std::sqrt(between + units[i].covariance(c, c) +
                                                                         1e-24 * (1.0 + middle * middle)));
  }
  const std::size_t least =
      std::max<std::size_t>((units.size() * 3) / 5, std::min<std::size_t>(units.size(), 4));
  assert(least > 0 && least <= units.size());
  std::vector<double> sorted = far;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(least - 1), sorted.end());
  constexpr double plain =
      3.5;  // median absolute deviations' worth: nobody doubts these (Iglewicz & Hoaglin 1993)
  const double limit = std::max(sorted[least - 1], plain);
  std::vector<bool> core(units.size());
  for (std::size_t i = 0; i < units.size(); ++i) core[i] = far[i] <= limit;
  return core;
}

/// The reference of one unit: the others' mean, its error, their spread, and how well that is known.
struct Others {
  Eigen::VectorXd mean;
  Eigen::MatrixXd error, spread;
  Eigen::VectorXd information;  ///< by coordinate, that the units have on the spread
};

/// A fleet without one of its units: its part of the mean, and of the last iteration of the spread, is taken out.
inline Others without(const Estimate& one, const MixedEffects& fleet, const Eigen::VectorXd& information) {
  assert(fleet.units > 1 && one.at.size() == fleet.size() && information.size() == fleet.size());
  const double count = static_cast<double>(fleet.units);
  const Eigen::MatrixXd& between = fleet.between;
  const Eigen::MatrixXd weight = inverse_of(one.covariance + between),
                        known = inverse_of(fleet.mean_covariance);
  const Eigen::VectorXd pull = between * weight * (one.at - fleet.mean);
  const Eigen::MatrixXd own = between -
                              between * (weight - weight * fleet.mean_covariance * weight) * between +
                              pull * pull.transpose();
  Others others;
  others.spread = (count * between - own) / (count - 1.0);
  others.error = inverse_of(known - weight);
  others.mean = others.error * (known * fleet.mean - weight * one.at);
  others.information = information;
  for (Eigen::Index c = 0; c < fleet.size(); ++c) {
    const double whole = one.covariance(c, c) + between(c, c);
    others.information[c] -= 1.0 / (whole * whole);
  }
  return others;
}

/// Hotelling's T^2 of one unit, with Satterthwaite's degrees of freedom of the variance it is compared with.
/// @param limit  probability below which it is odd
inline Standing standing_of(const Estimate& one, const Others& others, double limit) {
  const Eigen::Index k = one.at.size();
  assert(k > 0 && others.mean.size() == k && others.information.size() == k);
  const Eigen::VectorXd away = one.at - others.mean;
  const Eigen::MatrixXd whole = one.covariance + others.spread + others.error;
  const double square = std::max(0.0, away.dot(inverse_of(whole) * away));
  double degrees = -1.0;
  for (Eigen::Index c = 0; c < k; ++c) {
    const double own = one.covariance(c, c) + others.spread(c, c);
    degrees += own * own * others.information[c] / static_cast<double>(k);
  }
  const double within = std::max(degrees - static_cast<double>(k) + 1.0, 0.5);
  Standing standing;
  standing.distance = std::sqrt(square);
  standing.p = f_tail(square * within / (static_cast<double>(k) * std::max(degrees, 1.0)),
                      static_cast<double>(k), within);
  standing.odd = standing.p < limit;
  for (Eigen::Index c = 0; c < k; ++c) {
    const double own = away[c] / std::sqrt(whole(c, c));
    if (std::abs(own) > std::abs(standing.standard_deviations)) {
      standing.standard_deviations = own;
      standing.coordinate = c;
    }
  }
  return standing;
}

}  // namespace detail

/// Finds the odd units of a fleet so that a sound fleet has one with a probability of at most `false_odd`.
///
/// Each unit is compared with the others without it. Its distance from their mean, in their spread and its own error,
/// follows Hotelling's T^2. The degrees of freedom are those of their spread. A core around the medians decides first who
/// the others are; then those who are within the limit, until nothing changes. The limit is Bonferroni's: the probability
/// over the number of units. The test is for a departure from a normal spread in the given coordinates. A spread with
/// heavier tails has more odd units.
/// @param units      estimates of one size; with fewer than size + 4 nobody is odd
/// @param false_odd  0..1
inline OddUnits find_odd_units(const std::vector<Estimate>& units, double false_odd = 0.01) {
  OddUnits result;
  result.units.resize(units.size());
  if (units.empty()) return result;
  const Eigen::Index k = units.front().at.size();
  if (units.size() < static_cast<std::size_t>(k) + 4) {
    result.sound = fit_mixed_effects(units);
    return result;
  }
  const double limit = false_odd / static_cast<double>(units.size());
  std::vector<bool> kept = detail::core_of(units);
  constexpr int rounds = 12;
  for (int round = 0; round < rounds; ++round) {
    std::vector<Estimate> others;
    for (std::size_t i = 0; i < units.size(); ++i)
      if (kept[i]) others.push_back(units[i]);
    const MixedEffects& fleet = result.sound = fit_mixed_effects(others);
    Eigen::VectorXd information = Eigen::VectorXd::Zero(k);
    for (const Estimate& one : others)
      for (Eigen::Index c = 0; c < k; ++c) {
        const double whole = one.covariance(c, c) + fleet.between(c, c);
        information[c] += 1.0 / (whole * whole);
      }
    const detail::Others all{fleet.mean, fleet.mean_covariance, fleet.between, information};
    std::vector<bool> next(units.size());
    for (std::size_t i = 0; i < units.size(); ++i) {
      result.units[i] =
          detail::standing_of(units[i], kept[i] ? detail::without(units[i], fleet, information) : all, limit);
      next[i] = !result.units[i].odd;
    }
    const auto sound = static_cast<std::size_t>(std::count(next.begin(), next.end(), true));
    if (next == kept || sound < static_cast<std::size_t>(k) + 4) break;
    kept = std::move(next);
  }
  return result;
}

}  // namespace thermopower::gap::pool
