// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "nearest_name.hpp"
#include "plain_letters.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace thermopower::io {
namespace {

// How many letters are missing, too many or others (Levenshtein).
std::size_t distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t k = 0; k <= b.size(); ++k) row[k] = k;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t k = 1; k <= b.size(); ++k) {
      const std::size_t other = diagonal + (small(a[i - 1]) == small(b[k - 1]) ? 0 : 1);
      diagonal = std::exchange(row[k], std::min({other, row[k] + 1, row[k - 1] + 1}));
    }
  }
  return row[b.size()];
}

}  // namespace

std::string nearest_name(const std::string& given, const std::vector<std::string>& names) {
  constexpr std::size_t longest = 64;  // no name is longer
  if (given.size() > longest) return {};
  std::string nearest;
  std::size_t least = longest;
  for (const std::string& name : names) {
    const std::size_t apart = distance(given, name);
    if (apart < least && 4 * apart <= name.size()) least = apart, nearest = name;
  }
  return nearest;
}

}  // namespace thermopower::io
