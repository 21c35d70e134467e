// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/mask_thresholds.hpp>

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <vector>

namespace thermopower::gap::engine {

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

/// Whether far more samples have an extreme than the value next to it.
inline bool piles_up(const Extreme& one) {
  constexpr MaskThresholds limit;
  return one.count >= limit.least_clipped && one.value != 0.0 &&
         static_cast<double>(one.count) >= limit.clip_ratio * static_cast<double>(one.beside);
}

}  // namespace thermopower::gap::engine
