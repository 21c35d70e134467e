// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/mask_thresholds.hpp>

#include <algorithm>
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

/// The largest value of a column, or the least. @param sorted  its samples, ascending, at least one  @param top  the largest
inline Extreme extreme_of(const std::vector<double>& sorted, bool top) {
  Extreme one;
  one.value = top ? sorted.back() : sorted.front();
  one.count = std::count(sorted.begin(), sorted.end(), one.value);
  const auto last = static_cast<std::ptrdiff_t>(sorted.size()) - 1;
  const std::ptrdiff_t at = std::min(one.count, last);
  one.next = sorted[static_cast<std::size_t>(top ? last - at : at)];
  one.beside = std::count(sorted.begin(), sorted.end(), one.next);
  return one;
}

/// Whether far more samples have an extreme than the value next to it.
inline bool piles_up(const Extreme& one) {
  constexpr MaskThresholds limit;
  return one.count >= limit.least_clipped && one.value != 0.0 &&
         static_cast<double>(one.count) >= limit.clip_ratio * static_cast<double>(one.beside);
}

}  // namespace thermopower::gap::engine
