// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

namespace thermopower::gap::engine {

/// A unit that stamps may be in where they should be in seconds.
struct TimeUnit {
  const char* option;  ///< as --column has it
  const char* words;   ///< as sentences have it
  double in_s;         ///< how long one is
};

/// Those that are looked for.
inline constexpr TimeUnit time_units[] = {{"ms", "milliseconds", 1e-3},
                                          {"us", "microseconds", 1e-6},
                                          {"ns", "nanoseconds", 1e-9},
                                          {"min", "minutes", 60.0},
                                          {"h", "hours", 3600.0}};

}  // namespace thermopower::gap::engine
