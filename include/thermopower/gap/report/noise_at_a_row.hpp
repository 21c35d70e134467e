// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/robust.hpp>
#include <thermopower/plant/rows.hpp>

#include <Eigen/Core>

#include <array>
#include <cassert>
#include <cmath>
#include <vector>

namespace thermopower::gap::engine {

/// How large the noise of a column was in single rows, of which the rows around tell. A simulation that starts from the
/// measurement errs by the noise there. A few dozen starts from noise with heavy tails can have twice the noise of all
/// rows.
///
/// A parabola through the four rows before and after, and the row itself, leaves r of it. For white Gaussian noise of
/// standard deviation sigma, the noise there has, given r, the mean square r^2 + h sigma^2. Here h is the weight of the row
/// in its own smoothed value (Savitzky and Golay 1964, Anal. Chem. 36); over all rows its mean is sigma^2. Held by
/// tests/gap/data/noise_test.cpp.
class NoiseAtARow {
public:
  /// @param values  of the column, NaN where missing; kept by reference
  /// @param runs    inside which rows follow on each other
  NoiseAtARow(const Eigen::VectorXd& values, const std::vector<plant::RunSpan>& runs) : values_(values) {
    double sum = 0.0, count = 0.0;
    for (const plant::RunSpan& run : runs) {
      assert(run.begin >= 0 && run.end <= values.size());
      for (Eigen::Index row = run.begin + around; row + around < run.end; ++row) {
        const double left = left_at(row);
        if (std::isfinite(left)) sum += left * left, count += 1.0;
      }
    }
    if (count > 0.0) variance_ = sum / count / (1.0 - own);
    // Steps that the noise hardly crosses are rounded alike in neighbouring rows, which tell nothing of it then.
    constexpr double crossed = 0.5;
    if (std::sqrt(variance_) < crossed * quantum_of(values)) variance_ = 0.0;
  }

  /// Standard deviation of the noise, as what parabolas leave tells it: of a motion that bends within nine rows it is too much.
  double sd() const { return std::sqrt(variance_); }

  /// Magnitude of the noise in a row of a run, as a share of the standard deviation of all. It is 1 if the rows around do
  /// not tell.
  double share_at(Eigen::Index row, const plant::RunSpan& run) const {
    assert(run.begin >= 0 && run.end <= values_.size());
    if (!(variance_ > 0.0) || row - around < run.begin || row + around >= run.end) return 1.0;
    const double left = left_at(row);
    return std::isfinite(left) ? std::sqrt(left * left / variance_ + own) : 1.0;
  }

private:
  static constexpr Eigen::Index around = 4;
  static constexpr std::array<double, 5> weights{59.0 / 231.0, 54.0 / 231.0, 39.0 / 231.0, 14.0 / 231.0,
                                                 -21.0 / 231.0};
  static constexpr double own = weights[0];

  double left_at(Eigen::Index row) const {
    double smoothed = own * values_[row];
    for (Eigen::Index k = 1; k <= around; ++k)
      smoothed += weights[static_cast<std::size_t>(k)] * (values_[row - k] + values_[row + k]);
    return values_[row] - smoothed;
  }

  const Eigen::VectorXd& values_;
  double variance_ = 0.0;
};

}  // namespace thermopower::gap::engine
