// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace thermopower::gap::engine {

/// Filters equally spaced values in place, without delay: Butterworth's low-pass of second order, run forwards and backwards.
///
/// Effort and motion go through the same one, so that the equation between them stays as it is. The ends are continued by
/// their mirror image, so that a slope stays one.
/// @param cutoff  as a share of the sampling rate, above 0 and below 0.5
template <class Values>
void low_pass(Values&& values, double cutoff) {
  constexpr double memory = 3.0;  // periods of the cutoff that a pass remembers
  assert(cutoff > 0.0 && cutoff < 0.5);
  const Eigen::Index n = values.size();
  if (n < 2) return;
  const Eigen::Index edge =
      std::min<Eigen::Index>(n - 1, static_cast<Eigen::Index>(std::ceil(memory / cutoff)));
  const Eigen::Index size = n + 2 * edge;
  Eigen::VectorXd padded(size);
  for (Eigen::Index i = 0; i < edge; ++i) {
    padded[i] = 2.0 * values[0] - values[edge - i];
    padded[n + edge + i] = 2.0 * values[n - 1] - values[n - 2 - i];
  }
  padded.segment(edge, n) = values;
  const double k = std::tan(3.14159265358979323846 * cutoff), q = std::sqrt(2.0);
  const double scale = 1.0 / (1.0 + q * k + k * k);
  const double b = k * k * scale, a1 = 2.0 * (k * k - 1.0) * scale, a2 = (1.0 - q * k + k * k) * scale;
  const auto pass = [&](auto&& at) {
    const double first = at(0);  // settled at the first value
    double z2 = first * (b - a2), z1 = first * (2.0 * b - a1) + z2;
    for (Eigen::Index i = 0; i < size; ++i) {
      const double x = at(i), y = b * x + z1;
      z1 = 2.0 * b * x - a1 * y + z2;
      z2 = b * x - a2 * y;
      at(i) = y;
    }
  };
  pass([&](Eigen::Index i) -> double& { return padded[i]; });
  pass([&](Eigen::Index i) -> double& { return padded[size - 1 - i]; });
  values = padded.segment(edge, n);
}

}  // namespace thermopower::gap::engine
