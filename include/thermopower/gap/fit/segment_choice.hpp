// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/fit/fit_problem.hpp>
#include <thermopower/plant/catalogue.hpp>
#include <thermopower/plant/samples.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace thermopower::gap::engine {

/// Says of one item after another whether it is kept, so that a given share is kept. It uses multiples of the golden ratio,
/// so that no period of an experiment falls in step.
class GoldenSpread {
public:
  /// @param share  of all, 0..1
  explicit GoldenSpread(double share) : share_(share) {}
  /// Whether the next one is kept.
  bool next() {
    constexpr double golden = 0.6180339887498949;
    const bool kept = place_ < share_;
    place_ = std::fmod(place_ + golden, 1.0);
    return kept;
  }

private:
  double share_, place_ = 0.0;
};

/// Keeps some of the segments on the bench, spread over all, with about `rows` rows in total. It keeps all of them if they
/// are few or little is gained. Segments of a moving axis are all kept.
inline std::vector<Segment> thinned_runs(const std::vector<Segment>& segments, Eigen::Index rows) {
  constexpr std::size_t few = 6;
  Eigen::Index total = 0;
  std::size_t runs = 0;
  for (const Segment& segment : segments)
    if (!segment.axis) total += segment.end - segment.begin, ++runs;
  if (2 * total <= 3 * rows || runs <= few) return segments;
  const double share = std::max(static_cast<double>(rows) / static_cast<double>(total),
                                static_cast<double>(few) / static_cast<double>(runs));
  GoldenSpread spread(share);
  std::vector<Segment> kept;
  for (const Segment& segment : segments)
    if (segment.axis || spread.next()) kept.push_back(segment);
  return kept;
}

/// Keeps some of the windows of a moving axis, spread over the recording, with about `rows` rows in total. Each comes with
/// the one before it if it carries that one's states on. Windows that only bring such states about are not counted, nor
/// chosen. Segments on the bench are all kept.
/// @param together  so many windows in a row are kept or left out, > 0: states that nobody measures need some time
inline std::vector<Segment> thinned_axis(const std::vector<Segment>& segments, Eigen::Index rows,
                                         Eigen::Index together = 1) {
  const auto counts = [](const Segment& one) { return one.axis && !one.warm_up; };
  Eigen::Index total = 0, windows = 0;
  for (const Segment& segment : segments)
    if (counts(segment)) total += segment.end - segment.begin, ++windows;
  if (total <= rows || windows < 4) return segments;
  constexpr Eigen::Index fewest = 12;  // windows: of fast recordings, too
  const Eigen::Index wanted = std::max(std::min(fewest, windows), windows * rows / total);
  // A few long stretches would all show the same part of a motion that repeats, or one direction of it.
  GoldenSpread spread(static_cast<double>(wanted) / static_cast<double>(windows));
  std::vector<bool> chosen;
  bool in_group = false;
  Eigen::Index window = 0;
  for (std::size_t place = 0; place < segments.size(); ++place) {
    const bool is_window = counts(segments[place]);
    if (is_window && window++ % together == 0) in_group = spread.next();
    chosen.push_back(!segments[place].axis || (is_window && in_group));
  }
  std::vector<Segment> kept;
  for (std::size_t place = 0; place < segments.size(); ++place) {
    const bool leads = place + 1 < segments.size() && chosen[place + 1] && segments[place + 1].carries_on;
    if (!chosen[place] && !leads) continue;
    kept.push_back(segments[place]);
    kept.back().warm_up = !chosen[place];
    kept.back().carries_on = segments[place].carries_on && place > 0 && (chosen[place] || chosen[place - 1]);
  }
  return kept;
}

/// Whether an effect brings states of a moving axis that nobody measures: the far side of a spring, a bristle.
inline bool remembers(const CatalogueEntry& entry) {
  return !entry.info.states.empty() || entry.hooks.axis_structure;
}

/// Length in s of windows so short that a simulation hardly leaves the measurement: a fifth of `short_s`, with 16 rows at
/// least. It is `short_s` itself if the model has states that nobody measures, or there is no axis.
inline double shortest_window_s(const Model& model, const Catalogue& catalogue,
                                const std::vector<Inputs>& recordings, double short_s) {
  constexpr double share = 0.2, rows = 16.0;
  bool remembering = model.own.has_value();
  for (const auto& effect : model.effects) {
    const CatalogueEntry* entry = catalogue.find(effect.first);
    remembering = remembering || entry == nullptr || remembers(*entry);
  }
  double interval_s = 0.0;
  for (const Inputs& one : recordings)
    if (one.axis()) interval_s = std::max(interval_s, plant::median_interval_s(one.t_s, one.runs));
  if (remembering || interval_s == 0.0) return short_s;
  return std::min(std::max(share * short_s, rows * interval_s), short_s);
}

}  // namespace thermopower::gap::engine
