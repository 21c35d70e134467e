// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <cstddef>

/// @file thresholds.hpp
/// All thresholds of the test of units.

namespace thermopower::gap::engine {

/// Prices are in nats: the logarithm of how much rarer one thing is than another.
/// Held by tests/gap/units/unit_posterior_test.cpp, tests/gap/data/units_test.cpp and tests/gap/data/scale_test.cpp.
struct UnitThresholds {
  double unit = 3.0;  ///< price of a column in another unit: one log in twenty
  double sign = 3.5;  ///< price of a turned sign: rarer still
  double detail =
      0.5;            ///< price of a second column that shares a mistake, or of the less usual of two columns
  double odd = 2.0;   ///< price of a recording or run that differs from the others
  double sure = 2.0;  ///< lead from which a hypothesis stops a diagnosis: seven to one
  double misplaced = 8.0;    ///< price of columns that fit in each other's place and not as recorded
  double impossible = 30.0;  ///< price of what cannot be
  double farthest = 30.0;    ///< factor that a constant is off by at most, as KnownConstants::farthest_factor
  double near_motion = 1.6;  ///< factor that the constants of an axis may be off beside a wrong unit
  double near_heat = 6.0;    ///< the same of a body or circuit, which hides heat from its thermometer
  double alike_heat = 3.0;  ///< factor by which a body may warm otherwise than it cools, beside a wrong clock
  double most_sign = 12.0;  ///< nats that one recording says of a sign at most
  double alike = 0.75;      ///< correlation, beside all else, from which a regression tells a coefficient
  double same = 0.97;       ///< correlation of two columns of which one is the other's slope
  std::size_t windows = 40;  ///< that a regression has at least
  double common = 1.5;       ///< factor shared by several constants that is worth a word
};

}  // namespace thermopower::gap::engine
