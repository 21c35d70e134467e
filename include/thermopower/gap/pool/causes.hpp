// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/pool/log_result.hpp>
#include <thermopower/gap/pool/mixed_effects.hpp>
#include <thermopower/gap/pool/statistics.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

/// @file causes.hpp
/// What the units of a fleet have in common: causes, effects too weak for one log, and what those make of constants.

namespace thermopower::gap::pool {

/// How probable each explanation is to one unit, by name. One that is not listed is next to impossible.
using Probabilities = std::map<std::string, double>;

/// No diagnosis is as sure as that an explanation is less probable.
inline constexpr double impossible = 1e-6;

/// How common an explanation is.
struct Prevalence {
  std::string explanation;  ///< its name
  double share = 0.0;       ///< of the units, 0..1
  Range share90;            ///< 90 % interval of it
  double units = 0.0;       ///< how many that are; a sum of probabilities
};

/// Which explanations are common, and what each unit's is in their light.
struct CommonCauses {
  std::vector<Prevalence> common;    ///< the commonest first
  std::vector<Probabilities> units;  ///< of each unit, over all explanations, once the shares are known
};

/// The shares of explanations in a fleet by maximum likelihood (EM on a mixture). An explanation that many units find
/// likely gets likelier for units that cannot tell it from another one.
/// @param units  probabilities with every explanation alike beforehand
inline CommonCauses common_causes(const std::vector<Probabilities>& units) {
  constexpr int iterations = 300;
  CommonCauses result;
  std::map<std::string, Eigen::Index> column;
  for (const Probabilities& unit : units)
    for (const auto& [name, probability] : unit) column.emplace(name, 0);
  if (column.empty()) return result;
  Eigen::Index next = 0;
  for (auto& [name, place] : column) place = next++;
  const auto rows = static_cast<Eigen::Index>(units.size());
  Eigen::ArrayXXd likely = Eigen::ArrayXXd::Constant(rows, next, impossible);
  for (Eigen::Index i = 0; i < rows; ++i)
    for (const auto& [name, probability] : units[static_cast<std::size_t>(i)])
      likely(i, column[name]) = std::max(probability, impossible);
  Eigen::ArrayXd share = Eigen::ArrayXd::Constant(next, 1.0 / static_cast<double>(next));
  Eigen::ArrayXXd own;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    own = likely.rowwise() * share.transpose();
    own.colwise() /= own.rowwise().sum().eval();
    share = own.colwise().mean().transpose();
  }
  assert(!(std::abs(share.sum() - 1.0) > 1e-6));
  result.units.resize(units.size());
  const double count = static_cast<double>(units.size());
  for (const auto& [name, place] : column) {
    for (Eigen::Index i = 0; i < rows; ++i) result.units[static_cast<std::size_t>(i)][name] = own(i, place);
    // Jeffreys's interval of a share that was counted (Brown, Cai & DasGupta 2001).
    const double of_all = share[place] * count;
    const auto quantile = [&](double below) {
      return end_of(0.0, 1.0, [&](double x) {
        return regularised_beta(of_all + 0.5, count - of_all + 0.5, x) < below;
      });
    };
    result.common.push_back({name, share[place], {quantile(0.05), quantile(0.95)}, of_all});
  }
  std::stable_sort(result.common.begin(), result.common.end(),
                   [](const Prevalence& a, const Prevalence& b) { return a.share > b.share; });
  return result;
}

/// The evidence of one unit's logs for an explanation against none, summed over its logs.
struct Gain {
  double train = 0.0;  ///< twice the log likelihood ratio of the training data, its parameters fitted there
  double held_out = 0.0;  ///< of held-out data, nothing fitted
  int parameters = 0;     ///< that were fitted in all logs
};

namespace detail {

/// The gain of all data, less twice the parameters fitted (Akaike).
inline double whole(const Gain& gain) { return gain.train + gain.held_out - 2.0 * gain.parameters; }

}  // namespace detail

/// An effect that is too weak to be named in any log, and may be seen in all of them together.
struct WeakEffect {
  std::string explanation;       ///< its name
  std::size_t units = 0;         ///< that looked at it
  double held_out_median = 0.0;  ///< gain of a unit
  double p = 1.0;  ///< one-sided: probability of such gains, were it no help on data it was not fitted to
  bool stands = false;  ///< beyond chance, all explanations that were tried counted
  double gain = 0.0;    ///< of all data, median unit, less twice the parameters fitted (Akaike)
  std::vector<std::string> not_told_from;  ///< others that the fleet cannot tell from it
};

/// Looks for effects that help a little everywhere, among units whose own diagnosis names none.
///
/// Named are explanations that help on held-out data over the units, at a family-wise error of 1 % over all
/// explanations tried (Holm). That assumes nothing of noise or its correlation, only that units are independent. The one
/// with the largest gain leads. Others that the units do not reject beyond doubt (paired over units, two-sided 5 %, as
/// Vuong 1989 does over observations) are listed beside it.
/// @param units  for each unit the explanations that were fitted and looked at on held-out data
/// @return those that stand, the leading one first, then all others by p
inline std::vector<WeakEffect> weak_effects(const std::vector<std::map<std::string, Gain>>& units) {
  constexpr double level = 0.01, doubt = 0.025;
  std::map<std::string, std::vector<double>> held_out, gains;
  for (const auto& unit : units)
    for (const auto& [name, gain] : unit) {
      held_out[name].push_back(gain.held_out);
      gains[name].push_back(detail::whole(gain));
    }
  std::vector<WeakEffect> list;
  std::vector<double> p;
  for (const auto& [name, values] : held_out) {
    // Looked at in fewer than half of the units, it is a choice of those that liked it.
    p.push_back(2 * values.size() >= units.size() ? signed_rank_p(values) : 1.0);
    list.push_back({name, values.size(), median(values), p.back(), false, median(gains[name]), {}});
  }
  const std::vector<bool> stands = holm(p, level);
  for (std::size_t i = 0; i < list.size(); ++i) list[i].stands = stands[i] && list[i].gain > 0.0;
  std::stable_sort(list.begin(), list.end(), [](const WeakEffect& a, const WeakEffect& b) {
    if (a.stands != b.stands) return a.stands;
    return a.stands ? a.gain > b.gain : a.p < b.p;
  });
  for (std::size_t i = 1; i < list.size() && list[i].stands; ++i) {
    std::vector<double> difference;
    for (const auto& unit : units) {
      const auto one = unit.find(list.front().explanation), other = unit.find(list[i].explanation);
      if (one != unit.end() && other != unit.end())
        difference.push_back(detail::whole(one->second) - detail::whole(other->second));
    }
    if (!(signed_rank_p(difference) < doubt)) list.front().not_told_from.push_back(list[i].explanation);
  }
  return list;
}

/// By how much a constant is off in all units for want of an effect that all of them have and no unit's model.
struct Shift {
  double by = 0.0;        ///< with the effect less without it, in the coordinate; of the mean unit
  double error = 0.0;     ///< variance of that
  double variance = 0.0;  ///< of one unit's own shift around it: `error`, and what the units differ in
};

/// The shifts of constants, by the names of their coordinates.
using CommonShift = std::map<std::string, Shift>;

/// Where the fit of one log ended without an effect and with it.
struct FittedBothWays {
  const FittedExplanation* without;  ///< as a diagnosis of nothing missing has it
  const FittedExplanation* with;     ///< of the same log
};

namespace detail {

/// Mean over the logs of what the effect moves a coordinate by, and its variance; none where a fit lacks it.
inline std::optional<Estimate> moved(const std::vector<FittedBothWays>& logs, const std::string& name) {
  // A restricted fit is the more precise one, and the two differ by the wider one's extra knowledge. So the variance of the
  // difference is that of the variances (Hausman 1978). Both are estimates, so that it may come out as nothing; a twentieth
  // of the wider fit's is the least that is believed.
  constexpr double least = 0.05;
  const double count = static_cast<double>(logs.size());
  double by = 0.0, variance = 0.0;
  for (const FittedBothWays& log : logs) {
    const std::optional<Estimate> one = log.without->estimate_of({name}),
                                  other = log.with->estimate_of({name});
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
/// @param units  of each one the logs, fitted both ways: the effect is the only difference
/// @return shifts of the constants that all of these fits have; empty with fewer than four units
inline CommonShift common_shift(const std::vector<std::vector<FittedBothWays>>& units) {
  constexpr std::size_t fewest = 4;
  CommonShift result;
  if (units.size() < fewest || units.front().empty()) return result;
  for (const std::string& name : units.front().front().without->names) {
    if (!is_constant(name)) continue;
    std::vector<Estimate> moved;
    for (const std::vector<FittedBothWays>& unit : units)
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
