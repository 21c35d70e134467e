// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <cstdint>

/// @file random.hpp
/// Random numbers that are the same on every machine.

namespace thermopower::simulation {

/// SplitMix64 (Steele, Lea, Flood, OOPSLA 2014): a seed gives the same numbers everywhere, which `<random>`'s
/// distributions do not promise.
///
/// @snippet simulation_examples.cpp random
/// How to: @ref rig.
class Random {
public:
  /// @param seed  any; equal seeds give equal numbers
  explicit Random(std::uint64_t seed) noexcept : state_(seed) {}

  /// Next 64 bits.
  std::uint64_t next() noexcept {
    std::uint64_t mixed = (state_ += 0x9e3779b97f4a7c15u);
    mixed = (mixed ^ (mixed >> 30)) * 0xbf58476d1ce4e5b9u;
    mixed = (mixed ^ (mixed >> 27)) * 0x94d049bb133111ebu;
    return mixed ^ (mixed >> 31);
  }

  /// @return from <= number < to
  double between(double from, double to) noexcept {
    return from + (to - from) * (static_cast<double>(next() >> 11) * (1.0 / 9007199254740992.0));
  }

private:
  std::uint64_t state_;
};

}  // namespace thermopower::simulation
