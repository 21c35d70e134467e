// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace thermopower::gap::engine {

/// A number that recordings tell, and its standard error.
struct Estimate {
  double value = 0.0;  ///< in its unit
  double error = 0.0;  ///< in the same unit
};

/// Thresholds of a regression whose error a jackknife tells.
/// Held by tests/gap/observe/command_test.cpp and tests/gap/observe/lagging_output_test.cpp.
struct JackknifeThresholds {
  std::size_t least_rows = 300;  ///< of a regression: fewer do not tell
  std::size_t blocks = 20;       ///< of the rows
};

/// Standard error of a statistic by the delete-one-block jackknife (Efron & Tibshirani 1993, chapter 11).
/// @param left_out  the statistic with one block of the data left out after another, in its unit
/// @return in the same unit; 0 of fewer than two values, NaN where one of them is not finite
inline double jackknife_error(const std::vector<double>& left_out) {
  if (left_out.size() < 2) return 0.0;
  const double count = static_cast<double>(left_out.size());
  double mean = 0.0, square = 0.0;
  for (const double one : left_out) mean += one / count;
  for (const double one : left_out) square += (one - mean) * (one - mean);
  return std::sqrt((count - 1.0) / count * square);
}

}  // namespace thermopower::gap::engine
