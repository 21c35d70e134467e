// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/fit/fit_problem.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace thermopower::gap {

/// Keeps some of the segments on the bench, spread over all, with about `rows` rows in total; all of them
/// where there are few, or little is gained. Segments of a moving axis are all kept.
inline std::vector<Segment> thinned_runs(const std::vector<Segment>& segments, Eigen::Index rows) {
  constexpr std::size_t few = 6;
  Eigen::Index total = 0;
  std::size_t runs = 0;
  for (const Segment& segment : segments)
    if (!segment.axis) total += segment.end - segment.begin, ++runs;
  if (2 * total <= 3 * rows || runs <= few) return segments;
  const double share = std::max(static_cast<double>(rows) / static_cast<double>(total),
                                static_cast<double>(few) / static_cast<double>(runs));
  // By multiples of the golden ratio: no period of the experiment falls in step with what is kept.
  constexpr double golden = 0.6180339887498949;
  std::vector<Segment> kept;
  double place = 0.0;
  for (const Segment& segment : segments) {
    if (segment.axis || place < share) kept.push_back(segment);
    if (!segment.axis) place = std::fmod(place + golden, 1.0);
  }
  return kept;
}

/// Keeps some of the segments of a moving axis, in contiguous stretches spread over the recording, with about
/// `rows` rows in total. Segments on the bench are all kept.
/// @param also  places of further segments to keep, in order; each with the one before it, which it carries on
inline std::vector<Segment> thinned_axis(const std::vector<Segment>& segments, Eigen::Index rows,
                                         const std::vector<std::size_t>& also = {}) {
  Eigen::Index total = 0, windows = 0;
  for (const Segment& segment : segments)
    if (segment.axis) total += segment.end - segment.begin, ++windows;
  if (total <= rows || windows < 4) return segments;
  constexpr Eigen::Index fewest = 12;  // windows: of fast recordings, too
  const Eigen::Index wanted = std::max(std::min(fewest, windows), windows * rows / total);
  const Eigen::Index stretches = std::min<Eigen::Index>(4, wanted / 2);
  const auto asked_for = [&](std::size_t place) {
    return std::binary_search(also.begin(), also.end(), place);
  };
  std::vector<Segment> kept;
  Eigen::Index index = 0, previous = -2;
  for (std::size_t place = 0; place < segments.size(); ++place) {
    const Segment& segment = segments[place];
    if (!segment.axis) {
      kept.push_back(segment);
      continue;
    }
    // Window `index` lies in the first part of its stretch.
    const Eigen::Index stretch = index * stretches / windows;
    const Eigen::Index first = (stretch * windows + stretches - 1) / stretches;
    const bool leads = place + 1 < segments.size() && segments[place + 1].carries_on && asked_for(place + 1);
    if (index - first < (wanted + stretches - 1) / stretches || asked_for(place) || leads) {
      kept.push_back(segment);
      kept.back().carries_on = segment.carries_on && previous == index - 1;
      kept.back().warm_up = segment.carries_on && previous != index - 1;
      previous = index;
    }
    ++index;
  }
  return kept;
}

}  // namespace thermopower::gap
