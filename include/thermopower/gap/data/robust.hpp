// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/recording.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <vector>

/// @file robust.hpp
/// Medians, quantiles, scales and quanta that a tenth of bad samples cannot move far.

namespace thermopower::gap::engine {

/// The quantile `share` (0..1) of finite values, 0 of none; reorders them.
inline double quantile_of(std::vector<double>& values, double share) {
  if (values.empty()) return 0.0;
  assert(share >= 0.0 && share <= 1.0);
  const auto at = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return values[at];
}

/// The median of finite values, 0 of none; reorders them.
inline double median_of(std::vector<double>& values) { return quantile_of(values, 0.5); }

/// 5th to 95th percentile of finite values, 0 of none; reorders them.
inline double middle_range_of(std::vector<double>& values) {
  return quantile_of(values, 0.95) - quantile_of(values, 0.05);
}

/// Root mean square; 0 of none.
inline double rms_of(const std::vector<double>& values) {
  double squares = 0.0;
  for (const double value : values) squares += value * value;
  return values.empty() ? 0.0 : std::sqrt(squares / static_cast<double>(values.size()));
}

/// The finite samples of a column, run after run.
inline std::vector<double> finite_samples(const Eigen::VectorXd& values) {
  std::vector<double> list;
  list.reserve(static_cast<std::size_t>(values.size()));
  for (const double value : values)
    if (std::isfinite(value)) list.push_back(value);
  return list;
}

/// The largest or the least value of a column.
struct Extreme {
  double value = 0.0;         ///< itself
  double next = 0.0;          ///< the one next to it
  std::ptrdiff_t count = 0;   ///< samples that have it
  std::ptrdiff_t beside = 0;  ///< samples that have the one next to it
};

/// The largest value of a column, or the least; where there is no other one, it is next to itself.
/// @param samples  at least one  @param top  the largest
inline Extreme extreme_of(const std::vector<double>& samples, bool top) {
  const auto is_beyond = [top](double one, double other) { return top ? one > other : one < other; };
  assert(!samples.empty());
  Extreme one;
  one.value = one.next = samples.front();
  for (const double sample : samples)
    if (is_beyond(sample, one.value)) one.value = sample;
  for (const double sample : samples)
    if (sample != one.value && (one.next == one.value || is_beyond(sample, one.next))) one.next = sample;
  one.count = std::count(samples.begin(), samples.end(), one.value);
  one.beside = std::count(samples.begin(), samples.end(), one.next);
  return one;
}

/// Hands each stretch of rows [begin, end) inside [from, to) in which `is(row)` holds to `use(begin, end)`.
template <class Is, class Use>
void for_each_stretch(Eigen::Index from, Eigen::Index to, Is&& is, Use&& use) {
  for (Eigen::Index begin = from; begin < to; ++begin) {
    if (!is(begin)) continue;
    Eigen::Index end = begin + 1;
    while (end < to && is(end)) ++end;
    use(begin, end);
    begin = end;  // in which it does not hold
  }
}

/// Hands the rows of `count` finite samples that follow on each other inside a run to `use(const Eigen::Index*
/// rows)`: rows next to each other, or, where a sensor speaks in so few rows that hardly any are, its samples in
/// order.
template <std::size_t count, class Use>
void for_each_in_order(const Eigen::VectorXd& values, const std::vector<RunSpan>& runs, Use&& use) {
  constexpr double hardly_any = 0.1;
  double finite = 0.0, together = 0.0;
  for (const RunSpan& run : runs)
    for (Eigen::Index i = run.begin; i < run.end; ++i) {
      if (!std::isfinite(values[i])) continue;
      finite += 1.0;
      together += i + 1 < run.end && std::isfinite(values[i + 1]) ? 1.0 : 0.0;
    }
  const bool skips = together < hardly_any * finite;
  for (const RunSpan& run : runs) {
    assert(run.begin >= 0 && run.end <= values.size());
    std::array<Eigen::Index, count> rows{};
    std::size_t known = 0;
    for (Eigen::Index i = run.begin; i < run.end; ++i) {
      if (!std::isfinite(values[i])) {
        if (!skips) known = 0;
        continue;
      }
      std::rotate(rows.begin(), rows.begin() + 1, rows.end());
      rows.back() = i;
      if (++known >= count) use(rows.data());
    }
  }
}

/// Magnitudes of the steps between finite neighbours inside the runs.
inline std::vector<double> step_sizes(const Eigen::VectorXd& values, const std::vector<RunSpan>& runs) {
  std::vector<double> list;
  for_each_in_order<2>(values, runs, [&](const Eigen::Index* rows) {
    list.push_back(std::abs(values[rows[1]] - values[rows[0]]));
  });
  return list;
}

/// Share of numbers that are 0, such as of steps between equal neighbours; 1 of none.
inline double equal_share_of(const std::vector<double>& steps) {
  const auto equal = std::count(steps.begin(), steps.end(), 0.0);
  return steps.empty() ? 1.0 : static_cast<double>(equal) / static_cast<double>(steps.size());
}

/// Scale of the noise on a smooth signal, as a standard deviation: the median second difference. No estimate of
/// the noise for a score (coloured noise is larger), but what an isolated bad sample is measured against.
inline double white_scale(const Eigen::VectorXd& values, const std::vector<RunSpan>& runs) {
  std::vector<double> list;
  for_each_in_order<3>(values, runs, [&](const Eigen::Index* rows) {
    list.push_back(std::abs(values[rows[0]] - 2.0 * values[rows[1]] + values[rows[2]]));
  });
  constexpr double normal_median = 0.6745, gain = 2.449489742783178;  // sqrt(1 + 4 + 1)
  return median_of(list) / (normal_median * gain);
}

/// The grid on which most samples of a channel stand: the least distance of values that recur, where all of these
/// lie a whole number of such distances apart. A logger that averages a coarse reading passes from one level to the
/// next by values of its own, so that few neighbours differ by the quantum. 0 where there is none.
inline double grid_of_levels(const Eigen::VectorXd& values) {
  constexpr double most = 0.5, on_grid = 0.02;
  constexpr std::size_t recurs = 3, few_levels = 4;
  constexpr Eigen::Index enough = 20000;
  std::vector<double> sorted = finite_samples(values.head(std::min(values.size(), enough)));
  std::sort(sorted.begin(), sorted.end());
  std::vector<double> levels;
  std::size_t held = 0;
  for (std::size_t from = 0, to = 0; from < sorted.size(); from = to) {
    while (to < sorted.size() && sorted[to] == sorted[from]) ++to;
    if (to - from >= recurs) levels.push_back(sorted[from]), held += to - from;
  }
  if (levels.size() < few_levels || static_cast<double>(held) < most * static_cast<double>(sorted.size()))
    return 0.0;
  double least = levels[1] - levels[0];
  for (std::size_t i = 2; i < levels.size(); ++i) least = std::min(least, levels[i] - levels[i - 1]);
  for (const double level : levels) {
    const double steps = (level - levels[0]) / least;
    if (std::abs(steps - std::round(steps)) > on_grid) return 0.0;
  }
  return least;
}

/// The smallest step between neighbours that occurs again and again (in at least a hundredth of all steps), so that
/// a few odd samples do not hide it. 0 where there is none: values that hardly ever differ by the same amount.
/// @param same  share by which steps of one quantum differ, because few digits of them were logged
inline double repeated_step(const Eigen::VectorXd& values, double same = 1e-3) {
  constexpr double often = 0.01, odd = 0.1;
  constexpr std::size_t enough = 20000;
  std::vector<double> steps;
  double previous = std::nan(""), largest = 0.0;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    const double step = std::abs(value - previous);
    largest = std::max(largest, std::abs(value));
    if (step > 1e-9 * largest) steps.push_back(step);
    previous = value;
    if (steps.size() >= enough) break;
  }
  std::vector<double>& sorted = steps;
  std::sort(sorted.begin(), sorted.end());
  constexpr std::size_t few = 10;
  if (sorted.size() < few) return sorted.empty() ? 0.0 : sorted[0];
  const double needed = std::max(2.0, often * static_cast<double>(sorted.size()));
  // Where many steps are smaller, one that repeats only happens to.
  for (std::size_t from = 0; static_cast<double>(from) <= odd * static_cast<double>(sorted.size());) {
    const double step = sorted[from];
    std::size_t to = from;
    while (to < sorted.size() && sorted[to] <= step * (1.0 + same)) ++to;
    if (static_cast<double>(to - from) >= needed) return step;
    from = to;
  }
  return 0.0;
}

/// Quantum of a channel: grid_of_levels(), or else repeated_step(); 0 where there is none.
inline double quantum_of(const Eigen::VectorXd& values) {
  const double grid = grid_of_levels(values);
  return grid > 0.0 ? grid : repeated_step(values);
}

}  // namespace thermopower::gap::engine
