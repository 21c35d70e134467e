// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/pool/log_result.hpp>
#include <thermopower/gap/pool/mixed_effects.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace thermopower::gap::pool {

/// By how much a constant is off in all units for want of an effect that all of them have and no unit's model.
struct Shift {
  double by = 0.0;        ///< with the effect less without it, in the coordinate; of the mean unit
  double error = 0.0;     ///< variance of that
  double variance = 0.0;  ///< of one unit's own shift around it: `error`, and what the units differ in
};

/// The shifts of constants, by the names of their coordinates.
using CommonShift = std::map<std::string, Shift>;

/// Where the fits of one unit's logs ended without an effect and with it.
struct FittedBothWays {
  std::vector<const FittedExplanation*> without;  ///< of each log
  std::vector<const FittedExplanation*> with;     ///< of the same logs
};

namespace detail {

/// Mean over the logs of what the effect moves a coordinate by, and its variance; none where a fit lacks it.
inline std::optional<Estimate> moved(const FittedBothWays& unit, const std::string& name) {
  // A restricted fit is the more precise one, and the two differ by the wider one's extra knowledge. So the variance of the
  // difference is that of the variances (Hausman 1978). Both are estimates, so that it may come out as nothing; a twentieth
  // of the wider fit's is the least that is believed.
  constexpr double least = 0.05;
  const double count = static_cast<double>(unit.with.size());
  assert(unit.without.size() == unit.with.size());
  double by = 0.0, variance = 0.0;
  for (std::size_t i = 0; i < unit.with.size(); ++i) {
    const std::optional<Estimate> one = unit.without[i]->estimate_of({name}),
                                  other = unit.with[i]->estimate_of({name});
    if (!one || !other) return std::nullopt;
    const double wider = other->covariance(0, 0);
    by += (other->at[0] - one->at[0]) / count;
    variance += std::max(wider - one->covariance(0, 0), least * wider) / (count * count);
  }
  if (!std::isfinite(by) || !(variance > 0.0)) return std::nullopt;
  return Estimate{Eigen::VectorXd::Constant(1, by), Eigen::MatrixXd::Constant(1, 1, variance)};
}

}  // namespace detail

/// The shift of the units' constants by an effect that stands in the pool: mean and spread over the units. No single unit
/// knows; what it gets from the others is the mean, and a wider error.
/// @param units  that were fitted both ways, the effect being the only difference
/// @return shifts of the constants that all of these fits have; empty with fewer than four units
inline CommonShift common_shift(const std::vector<FittedBothWays>& units) {
  constexpr std::size_t fewest = 4;
  CommonShift result;
  if (units.size() < fewest || units.front().without.empty()) return result;
  for (const std::string& name : units.front().without.front()->names) {
    if (!is_constant(name)) continue;
    std::vector<Estimate> moved;
    for (const FittedBothWays& unit : units)
      if (const std::optional<Estimate> one = detail::moved(unit, name)) moved.push_back(*one);
    if (moved.size() < units.size()) continue;
    const MixedEffects fit = fit_mixed_effects(moved);
    const double error = fit.mean_covariance(0, 0);
    result[name] = {fit.mean[0], error, error + fit.between(0, 0)};
  }
  return result;
}

/// A shift if the units do not tell the effect from others. One of those might be the true one, so their largest difference
/// in shift is an error of this one, too.
inline CommonShift either(CommonShift leading, const std::vector<CommonShift>& others) {
  for (auto& [name, shift] : leading) {
    double most = 0.0;
    for (const CommonShift& other : others) {
      const auto found = other.find(name);
      const double away = shift.by - (found == other.end() ? 0.0 : found->second.by);
      most = std::max(most, away * away);
    }
    shift.error += most;
    shift.variance += most;
  }
  return leading;
}

}  // namespace thermopower::gap::pool
