// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <cassert>
#include <cmath>
#include <random>

namespace thermopower::design {

/// Random numbers that are the same on every machine: the distributions of the standard library are not.
///
/// How to: @ref design_the_next_experiment.
class Random {
public:
  /// @param seed  the same seed draws the same numbers
  explicit Random(unsigned seed) : engine_(seed) {}

  /// From 0 to 1, 1 not included.
  double share() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  /// Between two values.
  double uniform(double low, double high) { return low + (high - low) * share(); }
  /// Between two values above 0, each factor as likely as another.
  double log_uniform(double low, double high) {
    assert(low > 0.0 && high > 0.0);
    return low * std::pow(high / low, share());
  }
  /// 0 to count - 1. @param count  above 0
  std::size_t index(std::size_t count) {
    assert(count > 0);
    return static_cast<std::size_t>(share() * static_cast<double>(count));
  }
  /// True in so many of all cases.
  bool chance(double of_one) { return share() < of_one; }
  /// Of a normal distribution around 0 with a standard deviation of 1 (Box and Muller 1958).
  double gauss() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - share()));
    return radius * std::cos(6.283185307179586 * share());
  }

private:
  std::mt19937_64 engine_;
};

}  // namespace thermopower::design
