// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/pool/statistics.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <vector>

namespace thermopower::gap::pool {

/// One coordinate of one unit as its logs have it.
struct TimeSeries {
  std::vector<double> time;      ///< of each log, ascending, in days
  std::vector<double> at;        ///< the estimates
  std::vector<double> variance;  ///< of their errors
};

/// How a unit's coordinate went.
enum class DriftKind {
  slope,   ///< steadily
  change,  ///< at once, some time between two logs
};

/// The drift's name, as reports spell it.
inline const char* to_string(DriftKind kind) { return kind == DriftKind::slope ? "slope" : "change"; }

/// The result for one series. Which kind, and since when, only means something where `p` is small.
struct Drift {
  double p = 1.0;                     ///< probability of as large a departure without any drift
  DriftKind kind = DriftKind::slope;  ///< the likelier of the two
  double size = 0.0;                  ///< last fitted value less the first, in the coordinate
  double per_day = 0.0;               ///< of a slope
  double since = 0.0;  ///< a change lies after the log of this time, with 95 %; a slope's first log
  double until = 0.0;  ///< and before the log of this one; a slope's last log
};

/// Variance that the logs of one unit differ by beyond their errors, over all units of a fleet.
struct LogScatter {
  double variance = 0.0;  ///< beyond the errors, of one log, in the coordinate's square
  double degrees = 1.0;   ///< degrees of freedom it is known to
};

/// The scatter between the logs of one unit, from all series of one coordinate. It uses differences of neighbouring logs,
/// so that slow drifts hardly count, and their median, so that jumps of a few units do not.
inline LogScatter log_scatter(const std::vector<TimeSeries>& fleet) {
  // The median of chi^2. It is as precise as 0.37 times as many squares' mean, and neighbouring steps share a log.
  constexpr double median_of_chi2 = 0.454936423, efficiency = 0.37 * 2.0 / 3.0;
  std::vector<double> squares, errors;
  for (const TimeSeries& one : fleet) {
    assert(one.variance.size() == one.at.size());
    for (std::size_t i = 1; i < one.at.size(); ++i) {
      const double step = one.at[i] - one.at[i - 1];
      squares.push_back(step * step / median_of_chi2);
      errors.push_back(one.variance[i] + one.variance[i - 1]);
    }
  }
  LogScatter result;
  if (squares.empty()) return result;
  // The variance at which half of the squared steps, each over its own variance, lie below the median.
  const auto is_too_small = [&](double variance) {
    std::size_t below = 0;
    for (std::size_t i = 0; i < squares.size(); ++i) below += squares[i] < errors[i] + 2.0 * variance;
    return 2 * below < squares.size();
  };
  if (is_too_small(0.0))
    result.variance = end_of(0.0, *std::max_element(squares.begin(), squares.end()), is_too_small);
  result.degrees = std::max(1.0, efficiency * static_cast<double>(squares.size()));
  return result;
}

/// Looks for a drift of one unit: a slope, or a change between two logs, whichever stands out more. The probability
/// accounts for all candidates looked at (Bonferroni), and for the estimated scatter (Student's t).
/// @param series   at least four logs, else there is none
/// @param scatter  between the logs of one unit, from the fleet
inline Drift find_drift(const TimeSeries& series, const LogScatter& scatter) {
  constexpr Eigen::Index fewest = 4;
  constexpr double within = 3.84;  // of chi^2, 95 %
  Drift result;
  const auto n = static_cast<Eigen::Index>(series.at.size());
  assert(series.time.size() == series.at.size() && series.variance.size() == series.at.size());
  if (n < fewest) return result;
  using Values = Eigen::Map<const Eigen::ArrayXd>;
  const Values time(series.time.data(), n), at(series.at.data(), n), variance(series.variance.data(), n);
  const Eigen::ArrayXd weight = (variance + scatter.variance).max(1e-300).inverse();
  const auto centred = [&](const Eigen::ArrayXd& values) -> Eigen::ArrayXd {
    return values - (weight * values).sum() / weight.sum();
  };
  const Eigen::ArrayXd away = centred(at);
  // By how much a regressor lowers the weighted squares, and its coefficient.
  struct Look {
    double gain = 0.0, coefficient = 0.0;
  };
  const auto look = [&](const Eigen::ArrayXd& regressor) {
    const Eigen::ArrayXd x = centred(regressor);
    const double square = (weight * x * x).sum(), product = (weight * x * away).sum();
    return square > 0.0 ? Look{product * product / square, product / square} : Look{};
  };
  std::vector<Look> changes;  // the first one from the second log on
  for (Eigen::Index from = 1; from < n; ++from) {
    Eigen::ArrayXd step = Eigen::ArrayXd::Ones(n);
    step.head(from) = 0.0;
    changes.push_back(look(step));
  }
  const Look slope = look(time),
             change = *std::max_element(changes.begin(), changes.end(),
                                        [](const Look&a, const Look&b) { return a.gain < b.gain; });
  const bool is_slope = slope.gain >= change.gain;
  result.kind = is_slope ? DriftKind::slope : DriftKind::change;
  result.p = std::min(
      1.0, static_cast<double>(n) * t_tail(std::sqrt(std::max(slope.gain, change.gain)), scatter.degrees));
  result.per_day = is_slope ? slope.coefficient : 0.0;
  result.size = is_slope ? slope.coefficient * (time[n - 1] - time[0]) : change.coefficient;
  result.since = time[0];
  result.until = time[n - 1];
  if (is_slope) return result;
  // Each of the moments within reach of the best one lies between two logs.
  const auto is_possible = [&](const Look& one) { return one.gain > change.gain - within; };
  const auto first = std::find_if(changes.begin(), changes.end(), is_possible) - changes.begin(),
             last = std::find_if(changes.rbegin(), changes.rend(), is_possible) - changes.rbegin();
  result.since = time[first];
  result.until = time[n - 1 - last];
  return result;
}

}  // namespace thermopower::gap::pool
