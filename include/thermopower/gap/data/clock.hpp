// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/neighbour_motion.hpp>
#include <thermopower/gap/data/robust.hpp>
#include <thermopower/gap/recording.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

/// @file clock.hpp
/// Stamps that jitter around a clock. A sensor is read by a timer and stamped later, by whoever had time: the reading
/// belongs to the timer's instant, and the stamp's error times the rate is an error of the angle that no model explains.
/// Stamps can also be right and the timer late. The readings tell which.

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
  const auto stamp = [&](std::size_t i) { return t_s[run.begin + static_cast<Eigen::Index>(i)]; };
  std::vector<double> tick(static_cast<std::size_t>(run.size()), 0.0), steps = step_sizes(t_s, {run});
  ClockStamps clock;
  clock.period_s = median_of(steps);
  if (!(clock.period_s > 0.0)) return std::nullopt;
  for (std::size_t i = 1; i < tick.size(); ++i)
    tick[i] = tick[i - 1] + std::max(1.0, std::round((stamp(i) - stamp(i - 1)) / clock.period_s));
  const double count = static_cast<double>(run.size());
  double phase_s = 0.0;
  constexpr int rounds = 3;  // a better period may put a row on another tick
  for (int round = 0; round < rounds; ++round) {
    double mean_tick = 0.0, mean_s = 0.0;
    for (std::size_t i = 0; i < tick.size(); ++i) {
      mean_tick += tick[i] / count;
      mean_s += stamp(i) / count;
    }
    double product = 0.0, square = 0.0;
    for (std::size_t i = 0; i < tick.size(); ++i) {
      const double off = tick[i] - mean_tick;
      product += off * (stamp(i) - mean_s);
      square += off * off;
    }
    clock.period_s = product / square;
    phase_s = mean_s - clock.period_s * mean_tick;
    for (std::size_t i = 0; i < tick.size(); ++i) tick[i] = std::round((stamp(i) - phase_s) / clock.period_s);
  }
  clock.t_s.resize(run.size());
  std::vector<double> errors;
  double squares = 0.0;
  for (std::size_t i = 0; i < tick.size(); ++i) {
    if (i > 0 && !(tick[i] > tick[i - 1])) return std::nullopt;
    const double at_s = phase_s + clock.period_s * tick[i], error = stamp(i) - at_s;
    clock.t_s[static_cast<Eigen::Index>(i)] = at_s;
    errors.push_back(std::abs(error));
    squares += error * error;
  }
  clock.jitter_s = std::sqrt(squares / count);
  if (clock.jitter_s < limit.least_jitter * clock.period_s ||
      quantile_of(errors, 0.99) > limit.most_jitter * clock.period_s)
    return std::nullopt;
  return clock;
}

/// How far a reading lies from the cubic through two neighbours on either side, if these are its instants.
inline double off_its_neighbours(const std::array<double, 5>& at_s, const std::array<double, 5>& values) {
  std::array<double, 4> where{}, what{};
  for (std::size_t i = 0, k = 0; i < 5; ++i) {
    if (i == 2) continue;
    where[k] = at_s[i] - at_s[2];
    what[k++] = values[i];
  }
  return values[2] - polynomial_at_zero(where, what);
}

/// Collects how much nearer to their neighbours readings lie at one list of instants than at another.
class SmootherAt {
public:
  /// Adds a run's readings. @param recorded, clock  instants of the run's rows
  void add(const Eigen::VectorXd& values, const RunSpan& run, const Eigen::VectorXd& recorded,
           const Eigen::VectorXd& clock) {
    assert(recorded.size() >= run.size() && clock.size() >= run.size());
    std::vector<std::array<double, 2>> both;
    std::vector<double> sizes;
    for (Eigen::Index i = 2; i + 2 < run.size(); ++i) {
      std::array<double, 5> at{}, tick{}, value{};
      bool whole = true;
      for (std::size_t k = 0; k < 5; ++k) {
        const Eigen::Index row = i - 2 + static_cast<Eigen::Index>(k);
        value[k] = values[run.begin + row];
        at[k] = recorded[row];
        tick[k] = clock[row];
        whole = whole && std::isfinite(value[k]);
      }
      if (!whole) continue;
      both.push_back({std::abs(off_its_neighbours(at, value)), std::abs(off_its_neighbours(tick, value))});
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
    for (const Eigen::VectorXd* values : outputs)
      smoother.add(*values, run, t_s.segment(run.begin, run.size()), one->t_s);
    all.t_s.segment(run.begin, run.size()) = one->t_s;
    all.period_s = std::max(all.period_s, one->period_s);
    all.jitter_s = std::max(all.jitter_s, one->jitter_s);
  }
  if (!(all.period_s > 0.0) || !smoother.at_the_clock()) return std::nullopt;
  for (Eigen::Index i = 1; i < t_s.size(); ++i)
    if (t_s[i] > t_s[i - 1] && !(all.t_s[i] > all.t_s[i - 1])) return std::nullopt;
  return all;
}

}  // namespace thermopower::gap::engine
