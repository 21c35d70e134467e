// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

namespace thermopower::gap::engine {

/// Indices of numbers from the least to the largest; equal ones in the order in which they stand.
inline std::vector<std::size_t> ascending(const std::vector<double>& numbers) {
  std::vector<std::size_t> order(numbers.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return numbers[a] < numbers[b]; });
  return order;
}

/// Sorts items by a number that each has, the least first; equal ones stay in the order in which they stand.
/// @param key  makes the number of an item
template <class Item, class Key>
void sort_by(std::vector<Item>& items, Key&& key) {
  std::vector<double> numbers;
  for (const Item& one : items) {
    const double number = static_cast<double>(key(one));
    numbers.push_back(std::isnan(number) ? std::numeric_limits<double>::infinity() : number);
  }
  std::vector<Item> sorted;
  for (const std::size_t index : ascending(numbers)) sorted.push_back(std::move(items[index]));
  items = std::move(sorted);
}

}  // namespace thermopower::gap::engine
