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

/// The units nearest to the coordinates' medians: a core that up to two fifths of odd units cannot pull away.
inline std::vector<bool> core_of(const std::vector<Estimate>& units) {
  assert(!units.empty());
  constexpr double normal = 1.4826;  // standard deviations in a median absolute deviation
  constexpr double plain = 3.5;      // such deviations: nobody doubts these (Iglewicz & Hoaglin 1993)
  std::vector<double> far(units.size(), 0.0);
  for (Eigen::Index c = 0; c < units.front().at.size(); ++c) {
    std::vector<double> values, errors;
    for (const Estimate& one : units) {
      values.push_back(one.at[c]);
      errors.push_back(one.covariance(c, c));
    }
    const double middle = median(values), smallest = 1e-24 * (1.0 + middle * middle);
    for (double& one : values) one = std::abs(one - middle);
    const double scale = normal * median(values),
                 between = std::max(scale * scale - median(errors), smallest);
    for (std::size_t i = 0; i < units.size(); ++i)
      far[i] = std::max(far[i], values[i] / std::sqrt(between + errors[i]));
  }
  const std::size_t least = std::max(units.size() * 3 / 5, std::min<std::size_t>(units.size(), 4));
  std::vector<double> sorted = far;
  std::sort(sorted.begin(), sorted.end());
  const double limit = std::max(sorted[least - 1], plain);
  std::vector<bool> core;
  for (const double one : far) core.push_back(one <= limit);
  return core;
}

/// A fleet without one of its units: its part of the mean, and of the last iteration of the spread, is taken out.
inline MixedEffects without(const Estimate& one, const MixedEffects& fleet) {
  assert(fleet.units > 1 && one.at.size() == fleet.size());
  const double count = static_cast<double>(fleet.units);
  const Eigen::MatrixXd& between = fleet.between;
  const Eigen::MatrixXd weight = inverse_of(one.covariance + between),
                        known = inverse_of(fleet.mean_covariance);
  const Eigen::VectorXd pull = between * weight * (one.at - fleet.mean);
  const Eigen::MatrixXd own = between -
                              between * (weight - weight * fleet.mean_covariance * weight) * between +
                              pull * pull.transpose();
  MixedEffects others;
  others.between = (count * between - own) / (count - 1.0);
  others.mean_covariance = inverse_of(known - weight);
  others.mean = others.mean_covariance * (known * fleet.mean - weight * one.at);
  others.information =
      fleet.information.array() - (one.covariance + between).diagonal().array().square().inverse();
  return others;
}

/// Hotelling's T^2 of one unit, with Satterthwaite's degrees of freedom of the variance it is compared with.
/// @param limit  probability below which it is odd
inline Standing standing_of(const Estimate& one, const MixedEffects& others, double limit) {
  assert(one.at.size() > 0 && others.size() == one.at.size());
  const double k = static_cast<double>(one.at.size());
  const Eigen::VectorXd away = one.at - others.mean;
  const Eigen::MatrixXd spread = one.covariance + others.between, whole = spread + others.mean_covariance;
  const double square = std::max(0.0, away.dot(inverse_of(whole) * away)),
               degrees = spread.diagonal().array().square().matrix().dot(others.information) / k - 1.0,
               within = std::max(degrees - k + 1.0, 0.5);
  const Eigen::VectorXd deviations = away.cwiseQuotient(whole.diagonal().cwiseSqrt());
  Standing standing;
  standing.distance = std::sqrt(square);
  standing.p = f_tail(square * within / (k * std::max(degrees, 1.0)), k, within);
  standing.odd = standing.p < limit;
  deviations.cwiseAbs().maxCoeff(&standing.coordinate);
  standing.standard_deviations = deviations[standing.coordinate];
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
  const std::size_t fewest = units.empty() ? 1 : static_cast<std::size_t>(units.front().at.size()) + 4;
  if (units.size() < fewest) {
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
    result.sound = fit_mixed_effects(others);
    std::vector<bool> next(units.size());
    for (std::size_t i = 0; i < units.size(); ++i) {
      result.units[i] = detail::standing_of(
          units[i], kept[i] ? detail::without(units[i], result.sound) : result.sound, limit);
      next[i] = !result.units[i].odd;
    }
    if (next == kept || std::count(next.begin(), next.end(), true) < static_cast<std::ptrdiff_t>(fewest))
      break;
    kept = std::move(next);
  }
  return result;
}

}  // namespace thermopower::gap::pool
