// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace thermopower::gap::engine {

/// A low-pass without delay: Butterworth's of second order, run forwards and backwards.
///
/// Effort and motion go through the same one, so that the equation between them stays as it is.
class LowPass {
public:
  /// @param cutoff  as a share of the sampling rate, above 0 and below 0.5
  explicit LowPass(double cutoff) : reach_(static_cast<Eigen::Index>(std::ceil(memory_ / cutoff))) {
    assert(cutoff > 0.0 && cutoff < 0.5);
    const double k = std::tan(3.14159265358979323846 * cutoff), q = std::sqrt(2.0);
    const double scale = 1.0 / (1.0 + q * k + k * k);
    b_ = k * k * scale;
    a1_ = 2.0 * (k * k - 1.0) * scale;
    a2_ = (1.0 - q * k + k * k) * scale;
  }

  /// Filters equally spaced values in place. The ends are continued by their mirror image, so that a slope stays one.
  template <class Values>
  void operator()(Values&& values) const {
    const Eigen::Index n = values.size();
    if (n < 2) return;
    const Eigen::Index edge = std::min<Eigen::Index>(n - 1, reach_);
    Eigen::VectorXd padded(n + 2 * edge);
    for (Eigen::Index i = 0; i < edge; ++i) {
      padded[i] = 2.0 * values[0] - values[edge - i];
      padded[n + edge + i] = 2.0 * values[n - 1] - values[n - 2 - i];
    }
    padded.segment(edge, n) = values;
    const Eigen::Index size = padded.size();
    pass(size, [&](Eigen::Index i) -> double& { return padded[i]; });
    pass(size, [&](Eigen::Index i) -> double& { return padded[size - 1 - i]; });
    values = padded.segment(edge, n);
  }

private:
  static constexpr double memory_ = 3.0;  ///< periods of the cutoff that a pass remembers

  template <class At>
  void pass(Eigen::Index n, At&& at) const {
    const double first = at(0);  // settled at the first value
    double z2 = first * (b_ - a2_), z1 = first * (2.0 * b_ - a1_) + z2;
    for (Eigen::Index i = 0; i < n; ++i) {
      const double x = at(i), y = b_ * x + z1;
      z1 = 2.0 * b_ * x - a1_ * y + z2;
      z2 = b_ * x - a2_ * y;
      at(i) = y;
    }
  }

  Eigen::Index reach_;  ///< rows that a pass remembers
  double b_ = 1.0, a1_ = 0.0, a2_ = 0.0;
};

}  // namespace thermopower::gap::engine
