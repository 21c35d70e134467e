// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <cmath>
#include <random>
#include <vector>

namespace test {

typedef std::mt19937 Random;  // its sequence is the standard's; the distributions are ours

/// A number with a normal distribution, mean 0 and variance 1 (Box and Muller).
inline double normal(Random& random) {
  const auto uniform = [&] { return (static_cast<double>(random()) + 0.5) / 4294967296.0; };
  return std::sqrt(-2.0 * std::log(uniform())) * std::cos(6.283185307179586 * uniform());
}

/// Noise of an AR(1). @param memory  from one sample to the next  @param sd  its standard deviation
inline std::vector<double> coloured(int count, double memory, Random& random, double sd = 1.0) {
  std::vector<double> x;
  double state = normal(random);
  for (int i = 0; i < count; ++i) {
    x.push_back(sd * state);
    state = memory * state + std::sqrt(1.0 - memory * memory) * normal(random);
  }
  return x;
}

}  // namespace test
