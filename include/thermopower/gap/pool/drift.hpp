// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/pool/distributions.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>
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
  none,    ///< no more than its errors and the usual scatter between logs
  slope,   ///< steadily
  change,  ///< at once, some time between two logs
};

/// The drift's name, as reports spell it.
inline const char* to_string(DriftKind kind) {
  return kind == DriftKind::slope ? "slope" : kind == DriftKind::change ? "change" : "none";
}

/// The result for one series. Which kind, and since when, only means something where `p` is small.
struct Drift {
  double p = 1.0;                    ///< probability of as large a departure without any drift
  DriftKind kind = DriftKind::none;  ///< the likelier of the two
  double size = 0.0;                 ///< last fitted value less the first, in the coordinate
  double per_day = 0.0;              ///< of a slope
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
  std::vector<double> squares, errors;
  for (const TimeSeries& one : fleet) {
    assert(one.variance.size() == one.at.size());
    for (std::size_t i = 1; i < one.at.size(); ++i) {
      const double step = one.at[i] - one.at[i - 1];
      squares.push_back(step * step);
      errors.push_back(one.variance[i] + one.variance[i - 1]);
    }
  }
  LogScatter result;
  if (squares.empty()) return result;
  // The variance at which half of the squared steps, each over its own variance, lie below the median of chi^2.
  constexpr double median_of_chi2 = 0.454936423;
  const auto share_below = [&](double variance) {
    double below = 0.0;
    for (std::size_t i = 0; i < squares.size(); ++i)
      below += squares[i] < median_of_chi2 * (errors[i] + 2.0 * variance) ? 1.0 : 0.0;
    return below / static_cast<double>(squares.size());
  };
  double high = *std::max_element(squares.begin(), squares.end()) / median_of_chi2, low = 0.0;
  if (share_below(0.0) < 0.5) {
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (share_below(middle) < 0.5 ? low : high) = middle;
    }
    result.variance = high;
  }
  // A median of squares is as precise as 0.37 times as many squares' mean; neighbouring steps share a log.
  constexpr double efficiency = 0.37, shared = 2.0 / 3.0;
  result.degrees = std::max(1.0, efficiency * shared * static_cast<double>(squares.size()));
  return result;
}

/// Looks for a drift of one unit: a slope, or a change between two logs, whichever stands out more. The probability
/// accounts for all candidates looked at (Bonferroni), and for the estimated scatter (Student's t).
/// @param series   at least four logs, else there is none
/// @param scatter  between the logs of one unit, from the fleet
inline Drift find_drift(const TimeSeries& series, const LogScatter& scatter) {
  Drift result;
  const std::size_t n = series.at.size();
  assert(series.time.size() == n && series.variance.size() == n && !(scatter.variance < 0.0));
  constexpr std::size_t fewest = 4;
  if (n < fewest) return result;
  std::vector<double> weight(n);
  double sum = 0.0, mean = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    weight[i] = 1.0 / std::max(series.variance[i] + scatter.variance, 1e-300);
    sum += weight[i];
    mean += weight[i] * series.at[i];
  }
  mean /= sum;
  // By how much a regressor lowers the weighted squares, and its coefficient.
  struct Look {
    double gain = 0.0, coefficient = 0.0;
  };
  const auto look = [&](const auto& regressor) {
    double middle = 0.0, square = 0.0, product = 0.0;
    for (std::size_t i = 0; i < n; ++i) middle += weight[i] * regressor(i) / sum;
    for (std::size_t i = 0; i < n; ++i) {
      const double x = regressor(i) - middle;
      square += weight[i] * x * x;
      product += weight[i] * x * (series.at[i] - mean);
    }
    return square > 0.0 ? Look{product * product / square, product / square} : Look{};
  };
  const Look slope = look([&](std::size_t i) { return series.time[i] - series.time.front(); });
  std::vector<Look> changes(n);
  std::size_t best = 1;
  for (std::size_t at = 1; at < n; ++at) {
    changes[at] = look([at](std::size_t i) { return i >= at ? 1.0 : 0.0; });
    if (changes[at].gain > changes[best].gain) best = at;
  }
  const bool steady = slope.gain >= changes[best].gain;
  const double gain = std::max(slope.gain, changes[best].gain);
  result.p = std::min(1.0, static_cast<double>(n) * t_tail(std::sqrt(gain), scatter.degrees));
  result.kind = steady ? DriftKind::slope : DriftKind::change;
  if (steady) {
    result.per_day = slope.coefficient;
    result.size = slope.coefficient * (series.time.back() - series.time.front());
    result.since = series.time.front();
    result.until = series.time.back();
    return result;
  }
  result.size = changes[best].coefficient;
  // The moments within chi^2's 95 % of the best one; each lies between two logs.
  constexpr double within = 3.84;
  result.since = std::numeric_limits<double>::infinity();
  result.until = -result.since;
  for (std::size_t at = 1; at < n; ++at)
    if (changes[at].gain > changes[best].gain - within) {
      result.since = std::min(result.since, series.time[at - 1]);
      result.until = std::max(result.until, series.time[at]);
    }
  return result;
}

/// Holm's step-down: which of many tests stand at a family-wise error of `level`.
inline std::vector<bool> holm(const std::vector<double>& p, double level) {
  std::vector<std::size_t> order(p.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });
  std::vector<bool> stands(p.size(), false);
  for (std::size_t place = 0; place < order.size(); ++place) {
    if (!(p[order[place]] * static_cast<double>(p.size() - place) <= level)) break;
    stands[order[place]] = true;
  }
  return stands;
}

}  // namespace thermopower::gap::pool
