// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace thermopower::design {

/// Names in a row: `a, b and c`.
inline std::string in_a_row(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 < names.size() ? ", " : " and ") + names[i];
  return text;
}

/// The members of a class in words: the first, and how many others look alike.
inline std::string words_of(const std::vector<std::vector<std::string>>& members) {
  std::vector<std::string> names;
  for (const std::vector<std::string>& ids : members) {
    std::string name;
    for (const std::string& id : ids) name += (name.empty() ? "" : " with ") + id;
    names.push_back(name.empty() ? "nothing is missing" : name);
  }
  constexpr std::size_t shown = 2;
  if (names.size() > shown + 1) {
    const std::string more = std::to_string(names.size() - shown) + " others";
    names.resize(shown);
    names.push_back(more);
  }
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : " or ") + name;
  return text;
}

/// A probability with two digits; 1 is never claimed.
inline std::string two_digits(double probability) {
  char text[16];
  std::snprintf(text, sizeof text, "%.2f", std::min(probability, 0.99));
  return text;
}

/// A share as a whole number of per cent; 100 is never claimed.
inline std::string percent(double share) {
  char text[16];
  std::snprintf(text, sizeof text, "%.0f %%", std::min(100.0 * share, 99.0));
  return text;
}

}  // namespace thermopower::design
