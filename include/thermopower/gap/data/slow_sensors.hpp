// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/finding_list.hpp>
#include <thermopower/gap/data/robust.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <vector>

/// @file slow_sensors.hpp
/// Sensors that speak less often than a log has rows: those whose last word is repeated until the next, and an angle and a
/// rate that never stand in the same row.

namespace thermopower::gap::engine {

/// Thresholds of the question whether a column is held between updates of a slower sensor.
struct SlowSensorThresholds {
  std::size_t least_updates = 30;  ///< fewer do not tell
  double repeated = 0.5;           ///< repeats for each update: less is chance
  double regular = 0.85;  ///< share of updates as many rows apart, or one more or less: a clock of its own
  Eigen::Index most_rows = 40;  ///< between updates: slower, and it may be what it is driven by that holds
  double by_one_quantum =
      0.3;  ///< largest share of updates by one quantum, as something steady changes in a coarse reading
  double apart = 0.1;    ///< share of the sparser of two columns that stands in a row with the other one
  double nearest = 3.0;  ///< usual distances between samples that are neighbours
};

/// A column whose sensor is slower than the rows.
struct HeldColumn {
  RowMask repeats;          ///< rows that repeat the last update
  Eigen::Index rows_apart;  ///< between most updates
};

/// Finds a column that is updated every second row or less often, by a clock, and repeats its value in between.
inline std::optional<HeldColumn> held_between_updates(const Eigen::VectorXd& values,
                                                      const std::vector<RunSpan>& runs) {
  constexpr SlowSensorThresholds limit;
  HeldColumn held{RowMask(static_cast<std::size_t>(values.size()), 0), 1};
  const double quantum = quantum_of(values);
  std::map<Eigen::Index, std::size_t> apart;
  std::size_t updates = 0, repeats = 0, by_quantum = 0;
  for (const RunSpan& run : runs) {
    Eigen::Index last = -1, updated = -1;
    for (Eigen::Index i = run.begin; i < run.end; ++i) {
      if (!std::isfinite(values[i])) continue;
      if (last >= 0 && values[i] == values[last]) {
        held.repeats[static_cast<std::size_t>(i)] = 1;
        ++repeats;
      } else if (last >= 0) {
        if (updated >= 0) {
          ++updates;
          ++apart[i - updated];
          by_quantum += std::abs(values[i] - values[last]) < 1.5 * quantum ? 1 : 0;
        }
        updated = i;
      }
      last = i;
    }
  }
  if (updates < limit.least_updates ||
      static_cast<double>(repeats) < limit.repeated * static_cast<double>(updates))
    return std::nullopt;
  const auto most = std::max_element(apart.begin(), apart.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  held.rows_apart = most->first;
  const auto of = [&](Eigen::Index rows) { return apart.count(rows) > 0 ? apart.at(rows) : std::size_t{0}; };
  const std::size_t regular = most->second + std::max(of(held.rows_apart - 1), of(held.rows_apart + 1));
  const double count = static_cast<double>(updates);
  // Two rows apart now and then is what chance does to a reading that is new in each row.
  if (held.rows_apart < 2 || held.rows_apart > limit.most_rows ||
      static_cast<double>(regular) < limit.regular * count ||
      static_cast<double>(by_quantum) > limit.by_one_quantum * count)
    return std::nullopt;
  return held;
}

/// Whether two columns hardly ever stand in one row.
inline bool are_apart(const Eigen::VectorXd& first, const Eigen::VectorXd& second) {
  constexpr SlowSensorThresholds limit;
  const auto first_known = first.array().isFinite(), second_known = second.array().isFinite();
  const Eigen::Index fewer = std::min(first_known.count(), second_known.count());
  return fewer > 0 && static_cast<double>((first_known && second_known).count()) <
                          limit.apart * static_cast<double>(fewer);
}

/// What a column is in the rows in which it has no sample: on the cubic through two samples before and two after, inside a run.
/// @return NaN where there are no such samples, and where they lie further apart than usual
inline Eigen::VectorXd between_samples(const Eigen::VectorXd& t_s, const std::vector<RunSpan>& runs,
                                       const Eigen::VectorXd& values) {
  constexpr SlowSensorThresholds limit;
  std::vector<double> distances;
  for_each_in_order<2>(values, runs,
                       [&](const Eigen::Index* rows) { distances.push_back(t_s[rows[1]] - t_s[rows[0]]); });
  const double longest_s = limit.nearest * median_of(distances);
  Eigen::VectorXd result = Eigen::VectorXd::Constant(values.size(), missing);
  for_each_in_order<4>(values, runs, [&](const Eigen::Index* rows) {
    if (t_s[rows[3]] - t_s[rows[0]] > 3.0 * longest_s) return;
    for (Eigen::Index i = rows[1] + 1; i < rows[2]; ++i) {
      result[i] = 0.0;
      for (int k = 0; k < 4; ++k) {  // Lagrange
        double weight = 1.0;
        for (int other = 0; other < 4; ++other)
          if (other != k) weight *= (t_s[i] - t_s[rows[other]]) / (t_s[rows[k]] - t_s[rows[other]]);
        result[i] += weight * values[rows[k]];
      }
    }
  });
  return result;
}

}  // namespace thermopower::gap::engine
