// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/neighbour_motion.hpp>
#include <thermopower/gap/data/robust.hpp>
#include <thermopower/gap/recording.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

/// @file clock.hpp
/// Stamps that jitter around a clock. A sensor is read by a timer and stamped later, by whoever had time: the
/// reading belongs to the timer's instant, and the stamp's error times the rate is an error of the angle that no
/// model explains. Stamps can also be right and the timer late. The readings tell which.

namespace thermopower::gap::engine {

/// Thresholds of the search for a clock.
/// Held by tests/gap/data/check_test.cpp.
struct ClockThresholds {
  Eigen::Index least_rows = 100;  ///< of a run: fewer tell neither a period nor whose readings are smooth
  double least_jitter = 0.01;     ///< periods: less is the rounding of stamps, and does no harm
  double most_jitter =
      0.3;  ///< periods that 99 of 100 stamps stay within: beyond, a row may be another tick's
  double smoother =
      0.95;  ///< how much nearer to their neighbours readings lie at the clock's ticks, as a share
  double standard_errors = 6.0;  ///< by which they lie nearer; neighbouring readings share their neighbours
  double outlier = 6.0;          ///< medians: a reading further off counts as that far off
};

/// Stamps on a clock, and what they are off.
struct ClockStamps {
  Eigen::VectorXd t_s;    ///< of every row
  double period_s = 0.0;  ///< of the clock
  double jitter_s = 0.0;  ///< standard deviation of the recorded stamps around it
};

/// The clock around which the stamps of one run jitter; nothing where they do not, or where there is none.
///
/// A row's tick is the nearest one, so that lost rows leave ticks out. Period and phase by least squares.
inline std::optional<ClockStamps> clock_of(const Eigen::VectorXd& t_s, const RunSpan& run) {
  constexpr ClockThresholds limit;
  if (run.size() < limit.least_rows) return std::nullopt;
  const auto stamp = t_s.segment(run.begin, run.size()).array();
  std::vector<double> steps = step_sizes(t_s, {run});
  ClockStamps clock;
  clock.period_s = median_of(steps);
  if (!(clock.period_s > 0.0)) return std::nullopt;
  Eigen::ArrayXd tick = Eigen::ArrayXd::Zero(run.size());
  for (Eigen::Index i = 1; i < tick.size(); ++i)
    tick[i] = tick[i - 1] + std::max(1.0, std::round((stamp[i] - stamp[i - 1]) / clock.period_s));
  const double count = static_cast<double>(run.size());
  double phase_s = 0.0;
  constexpr int rounds = 3;  // a better period may put a row on another tick
  for (int round = 0; round < rounds; ++round) {
    double mean_tick = 0.0, mean_s = 0.0, product = 0.0, square = 0.0;
    for (Eigen::Index i = 0; i < tick.size(); ++i) mean_tick += tick[i] / count, mean_s += stamp[i] / count;
    for (Eigen::Index i = 0; i < tick.size(); ++i) {
      const double off = tick[i] - mean_tick;
      product += off * (stamp[i] - mean_s);
      square += off * off;
    }
    clock.period_s = product / square;
    phase_s = mean_s - clock.period_s * mean_tick;
    tick = ((stamp - phase_s) / clock.period_s).round();
  }
  if (std::adjacent_find(tick.begin(), tick.end(), std::greater_equal<>()) != tick.end()) return std::nullopt;
  clock.t_s = phase_s + clock.period_s * tick;
  const Eigen::ArrayXd errors = stamp - clock.t_s.array();
  clock.jitter_s = std::sqrt(errors.square().mean());
  std::vector<double> sizes = finite_samples(errors.abs());
  if (clock.jitter_s < limit.least_jitter * clock.period_s ||
      quantile_of(sizes, 0.99) > limit.most_jitter * clock.period_s)
    return std::nullopt;
  return clock;
}

/// Collects how much nearer to their neighbours readings lie at one list of instants than at another.
class SmootherAt {
public:
  /// Adds a run's readings. @param recorded, clock  instants of all rows
  void add(const Eigen::VectorXd& values, const RunSpan& run, const Eigen::VectorXd& recorded,
           const Eigen::VectorXd& clock) {
    const OrderedSamples as_recorded(values, &recorded, run), at_ticks(values, &clock, run);
    std::vector<std::array<double, 2>> both;
    std::vector<double> sizes;
    for (std::size_t i = 2; i + 2 < as_recorded.size(); ++i) {
      if (as_recorded.rows[i + 2] - as_recorded.rows[i - 2] != 4) continue;  // a sample is missing
      both.push_back({std::abs(as_recorded.off_four(i)), std::abs(at_ticks.off_four(i))});
      sizes.push_back(both.back()[1]);
    }
    const double most = ClockThresholds().outlier * median_of(sizes);
    if (!(most > 0.0)) return;  // a column that stands still
    for (const std::array<double, 2>& one : both) {
      const double a = std::min(one[0], most) / most, b = std::min(one[1], most) / most;
      recorded_ += a;
      clock_ += b;
      square_ += (a - b) * (a - b);
    }
  }

  /// Whether they lie nearer at the clock's beyond doubt.
  bool at_the_clock() const {
    constexpr ClockThresholds limit;
    return clock_ < limit.smoother * recorded_ &&
           recorded_ - clock_ > limit.standard_errors * std::sqrt(square_);
  }

private:
  double recorded_ = 0.0, clock_ = 0.0, square_ = 0.0;
};

/// The stamps as a clock had them, where the recorded ones jitter around one and the outputs say that they were read at
/// its ticks; nothing else.
/// @param outputs  columns that are measured
inline std::optional<ClockStamps> clock_behind(const Eigen::VectorXd& t_s, const std::vector<RunSpan>& runs,
                                               const std::vector<const Eigen::VectorXd*>& outputs) {
  ClockStamps all{t_s, 0.0, 0.0};
  SmootherAt smoother;
  for (const RunSpan& run : runs) {
    const std::optional<ClockStamps> one = clock_of(t_s, run);
    if (!one) continue;
    all.t_s.segment(run.begin, run.size()) = one->t_s;
    for (const Eigen::VectorXd* values : outputs) smoother.add(*values, run, t_s, all.t_s);
    all.period_s = std::max(all.period_s, one->period_s);
    all.jitter_s = std::max(all.jitter_s, one->jitter_s);
  }
  if (!(all.period_s > 0.0) || !smoother.at_the_clock()) return std::nullopt;
  for (Eigen::Index i = 1; i < t_s.size(); ++i)
    if (t_s[i] > t_s[i - 1] && !(all.t_s[i] > all.t_s[i - 1])) return std::nullopt;
  return all;
}

}  // namespace thermopower::gap::engine
