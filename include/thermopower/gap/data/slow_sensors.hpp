// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/finding_list.hpp>
#include <thermopower/gap/data/neighbour_motion.hpp>
#include <thermopower/gap/data/robust.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <vector>

/// @file slow_sensors.hpp
/// Sensors that speak less often than a log has rows: those whose last word is repeated until the next, those
/// between whose words somebody drew straight lines, and an angle and a rate that never stand in the same row.

namespace thermopower::gap::engine {

/// Thresholds of the question whether a column is held between updates of a slower sensor.
/// Held by tests/gap/data/slow_sensors_test.cpp.
struct SlowSensorThresholds {
  std::size_t least_updates = 30;  ///< fewer do not tell
  double repeated = 0.5;           ///< repeats for each update: less is chance
  double regular = 0.85;  ///< share of updates as many rows apart, or one more or less: a clock of its own
  Eigen::Index most_rows = 40;  ///< between updates: slower, and it may be what it is driven by that holds
  double by_one_quantum =
      0.3;  ///< largest share of updates by one quantum, as something steady changes in a coarse reading
  double on_line =
      0.8;  ///< of the rows that straight lines leave on the line between their neighbours, the least share
  double pairs = 0.1;  ///< share of readings that bend the line twice where they were not taken at the rows
  double kink = 5.0;   ///< roundings that most kinks are larger than
  double one_size = 0.3;  ///< largest share of kinks of the same size, as coarse steps are
  double apart = 0.1;     ///< share of the sparser of two columns that stands in a row with the other one
  double nearest = 3.0;   ///< usual distances between samples that are neighbours
};

/// A column whose sensor is slower than the rows.
struct SlowColumn {
  RowMask between;          ///< rows that say nothing new
  Eigen::Index rows_apart;  ///< between most updates
};

/// How many rows most updates lie apart.
class UpdateClock {
public:
  /// Counts a distance between two updates.
  void add(Eigen::Index rows) { ++apart_[rows], ++updates_; }
  /// Distances counted.
  std::size_t updates() const { return updates_; }
  /// The distance of most; 0 where they do not come as a clock does, or faster than every second row, or very seldom.
  Eigen::Index rows_apart() const {
    constexpr SlowSensorThresholds limit;
    if (updates_ < limit.least_updates) return 0;
    const auto most = std::max_element(apart_.begin(), apart_.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
    const Eigen::Index rows = most->first;
    const auto of = [&](Eigen::Index at) { return apart_.count(at) > 0 ? apart_.at(at) : std::size_t{0}; };
    const std::size_t regular = most->second + std::max(of(rows - 1), of(rows + 1));
    // Two rows apart now and then is what chance does to a reading that is new in each row.
    const bool by_clock = static_cast<double>(regular) >= limit.regular * static_cast<double>(updates_);
    return by_clock && rows >= 2 && rows <= limit.most_rows ? rows : 0;
  }

private:
  std::map<Eigen::Index, std::size_t> apart_;
  std::size_t updates_ = 0;
};

/// Finds a column that is updated every second row or less often, by a clock, and repeats its value in between.
inline std::optional<SlowColumn> held_between_updates(const Eigen::VectorXd& values,
                                                      const std::vector<RunSpan>& runs) {
  constexpr SlowSensorThresholds limit;
  SlowColumn held{RowMask(static_cast<std::size_t>(values.size()), 0), 1};
  const double quantum = quantum_of(values);
  UpdateClock clock;
  std::size_t repeats = 0, by_quantum = 0;
  for (const RunSpan& run : runs) {
    Eigen::Index last = -1, updated = -1;
    for (Eigen::Index i = run.begin; i < run.end; ++i) {
      if (!std::isfinite(values[i])) continue;
      if (last >= 0 && values[i] == values[last]) {
        held.between[static_cast<std::size_t>(i)] = 1;
        ++repeats;
      } else if (last >= 0) {
        if (updated >= 0) {
          clock.add(i - updated);
          by_quantum += std::abs(values[i] - values[last]) < 1.5 * quantum ? 1 : 0;
        }
        updated = i;
      }
      last = i;
    }
  }
  held.rows_apart = clock.rows_apart();
  const double updates = static_cast<double>(clock.updates());
  if (held.rows_apart == 0 || static_cast<double>(repeats) < limit.repeated * updates ||
      static_cast<double>(by_quantum) > limit.by_one_quantum * updates)
    return std::nullopt;
  return held;
}

/// The unit to which each value of a column is rounded: a power of ten for all from one power of ten to the next,
/// since who writes six digits rounds 99.9 and 100.1 differently; or what a double holds. 0 of zeros and of what is
/// missing.
inline Eigen::VectorXd roundings_of(const Eigen::VectorXd& values) {
  std::map<int, std::vector<Eigen::Index>> decades;
  for (Eigen::Index i = 0; i < values.size(); ++i)
    if (std::isfinite(values[i]) && values[i] != 0.0)
      decades[static_cast<int>(std::floor(std::log10(std::abs(values[i]))))].push_back(i);
  Eigen::VectorXd units = Eigen::VectorXd::Zero(values.size());
  for (const auto& [decade, rows] : decades) {
    const double largest = std::abs(values[rows.front()]), smallest = 1e-9 * largest;
    double unit = 10.0;
    const auto is_multiple = [&](Eigen::Index i) {
      return std::abs(values[i] / unit - std::round(values[i] / unit)) < 1e-6;
    };
    while (unit > smallest && !std::all_of(rows.begin(), rows.end(), is_multiple)) unit *= 0.1;
    for (const Eigen::Index i : rows) units[i] = std::max(unit, smallest);
  }
  return units;
}

/// Finds a column of a sensor slower than the rows between whose readings straight lines were drawn, as who merges two
/// streams of data does: most rows then lie on the line between their neighbours, and the others are apart by a clock.
inline std::optional<SlowColumn> straight_between_updates(const Eigen::VectorXd& t_s,
                                                          const Eigen::VectorXd& values,
                                                          const std::vector<RunSpan>& runs) {
  constexpr SlowSensorThresholds limit;
  SlowColumn straight{RowMask(static_cast<std::size_t>(values.size()), 0), 1};
  const Eigen::VectorXd roundings = roundings_of(values);
  UpdateClock clock;
  std::vector<double> kinks;
  double rows = 0.0, on_line = 0.0, pairs = 0.0, coarsest = 0.0;
  for (const RunSpan& run : runs) {
    Eigen::Index kink = -1;
    for (Eigen::Index i = run.begin + 1; i + 1 < run.end; ++i) {
      const double share = (t_s[i] - t_s[i - 1]) / (t_s[i + 1] - t_s[i - 1]);
      const double off = std::abs(values[i] - values[i - 1] - share * (values[i + 1] - values[i - 1]));
      if (!std::isfinite(off)) continue;
      ++rows;
      const double rounded = 2.0 * roundings.segment(i - 1, 3).maxCoeff();
      const bool is_kink = off > rounded, is_second = is_kink && kink == i - 1;
      if (is_kink) {
        kinks.push_back(off);
        coarsest = std::max(coarsest, rounded);
      } else {
        ++on_line;
      }
      if (is_second) ++pairs;  // a reading between two rows bends the line at both
      if (!is_kink || is_second) {
        straight.between[static_cast<std::size_t>(i)] = 1;
        continue;
      }
      if (kink >= 0) clock.add(i - kink);
      kink = i;
    }
  }
  straight.rows_apart = clock.rows_apart();
  if (straight.rows_apart == 0) return std::nullopt;
  // Where each row is new, every second one looks like the second bend of a pair.
  const double readings = static_cast<double>(kinks.size()) - pairs,
               apart = static_cast<double>(straight.rows_apart),
               bent = pairs > limit.pairs * readings ? 2.0 : 1.0;
  if (apart <= bent || on_line < limit.on_line * (1.0 - bent / apart) * rows) return std::nullopt;
  const double usual = median_of(kinks);
  const auto same_size = std::count_if(kinks.begin(), kinks.end(),
                                       [&](double one) { return std::abs(one - usual) < 0.01 * usual; });
  if (usual < limit.kink * coarsest ||
      static_cast<double>(same_size) > limit.one_size * static_cast<double>(kinks.size()))
    return std::nullopt;
  return straight;
}

/// Whether two columns hardly ever stand in one row.
inline bool are_apart(const Eigen::VectorXd& first, const Eigen::VectorXd& second) {
  constexpr SlowSensorThresholds limit;
  const auto first_known = first.array().isFinite(), second_known = second.array().isFinite();
  const Eigen::Index fewer = std::min(first_known.count(), second_known.count());
  return fewer > 0 && static_cast<double>((first_known && second_known).count()) <
                          limit.apart * static_cast<double>(fewer);
}

/// Usual distance between a column's samples in s; 0 where there are no two in a run.
inline double median_distance_s(const Eigen::VectorXd& t_s, const std::vector<RunSpan>& runs,
                                const Eigen::VectorXd& values) {
  std::vector<double> distances;
  for_each_in_order<2>(values, runs,
                       [&](const Eigen::Index* rows) { distances.push_back(t_s[rows[1]] - t_s[rows[0]]); });
  return median_of(distances);
}

/// The values of a column in the rows in which it has no sample: on the cubic through two samples before and two
/// after, inside a run.
/// @return NaN where there are no such samples, and where they lie further apart than usual
inline Eigen::VectorXd between_samples(const Eigen::VectorXd& t_s, const std::vector<RunSpan>& runs,
                                       const Eigen::VectorXd& values) {
  constexpr SlowSensorThresholds limit;
  const double longest_s = limit.nearest * median_distance_s(t_s, runs, values);
  Eigen::VectorXd result = Eigen::VectorXd::Constant(values.size(), missing);
  for_each_in_order<4>(values, runs, [&](const Eigen::Index* rows) {
    if (t_s[rows[3]] - t_s[rows[0]] > 3.0 * longest_s) return;
    for (Eigen::Index i = rows[1] + 1; i < rows[2]; ++i) {
      std::array<double, 4> where{}, what{};
      for (std::size_t k = 0; k < 4; ++k) where[k] = t_s[rows[k]] - t_s[i], what[k] = values[rows[k]];
      result[i] = polynomial_at_zero(where, what);
    }
  });
  return result;
}

}  // namespace thermopower::gap::engine
