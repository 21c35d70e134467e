// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "case.hpp"

namespace gap_benchmark {

/// A part of the benchmark with cases, seeds and rows of its own.
enum class Part {
  none,
  beginner,  ///< wrong constants, a sensor that is not attached, a factor that is common to several constants
  closed_loops,  ///< joints under a controller, with target, effort and motion in the log
  slow_logs      ///< one sample a second of a loop that is ten times as fast
};

inline const char* name(Part part) {
  static const char* const names[] = {"none", "beginner", "closed_loops", "slow_logs"};
  return names[static_cast<int>(part)];
}

/// The part of that name; Part::none where there is none.
inline Part part_of(const std::string& text) {
  for (const Part part : {Part::beginner, Part::closed_loops, Part::slow_logs})
    if (text == name(part)) return part;
  return Part::none;
}

/// What is right about a case of a part.
struct PartTruth {
  std::string title;                ///< of the case, for people
  std::vector<std::string> causes;  ///< that act, constants included
  /// Sets of causes that are right as an answer, each with nothing besides.
  std::vector<std::vector<std::string>> accept;
  std::vector<std::string> family;  ///< effects of which one at least, and no other, is right
  bool refuse = false;              ///< right is to name nothing, and to say what is wrong with the data
  bool common_factor = false;       ///< right is to explain it by no set of constants

  /// Writes it down.
  nlohmann::ordered_json label(Part part, const std::string& kind) const {
    nlohmann::ordered_json j;
    j["kind"] = kind;
    j["half"] = name(part);
    j["title"] = title;
    j["effects"] = causes;
    j["unknown"] = nullptr;
    j["accept"] = accept;
    j["family"] = family;
    j["refuse"] = refuse;
    j["common_factor"] = common_factor;
    return j;
  }
};

/// The number of five digits that somebody writes into a file.
inline double five_digits(double value) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.5g", value);
  return std::stod(digits);
}

/// A factor that a constant is wrong by: 0.1 to 10, and at least a third up or a quarter down.
inline double wrong_by(Random& random) {
  constexpr double least = 1.33, most = 10.0;
  const double factor = random.log_uniform(least, most);
  return random.chance(0.5) ? factor : 1.0 / factor;
}

}  // namespace gap_benchmark
