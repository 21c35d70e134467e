// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <utility>
#include <vector>

namespace thermopower::gap::engine {

/// A list that is sorted from its least value on, as far as somebody looks: of a hundred thousand steps a few thousand tell.
class SortedFromBelow {
public:
  /// @param list  no value of it may be NaN
  explicit SortedFromBelow(std::vector<double> list) : list_(std::move(list)) {}

  /// How many there are.
  std::size_t size() const { return list_.size(); }

  /// The one that has `at` before it, below size().
  double operator[](std::size_t at) {
    assert(at < list_.size());
    if (at >= sorted_) sort_beyond(at);
    return list_[at];
  }

private:
  void sort_beyond(std::size_t at) {
    constexpr std::size_t few = 256;
    const std::size_t to = std::min(list_.size(), std::max(at + few, 2 * sorted_));
    const auto begin = list_.begin() + static_cast<std::ptrdiff_t>(sorted_),
               end = list_.begin() + static_cast<std::ptrdiff_t>(to);
    if (end != list_.end()) std::nth_element(begin, end, list_.end());
    std::sort(begin, end);
    sorted_ = to;
  }

  std::vector<double> list_;
  std::size_t sorted_ = 0;  ///< so many are in their places
};

}  // namespace thermopower::gap::engine
