// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/rows.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

/// @file samples.hpp
/// Sampled signals for balances: without holes, and with their noise.

namespace thermopower::plant {

/// Missing samples take the last one before them (the next one at the beginning of a run); a run without any
/// takes `otherwise`.
inline Eigen::VectorXd without_holes(const Eigen::VectorXd& values, const std::vector<RunSpan>& runs,
                                     double otherwise) {
  Eigen::VectorXd filled = values;
  for (const RunSpan& run : runs) {
    double last = otherwise;
    for (Eigen::Index i = run.end; i-- > run.begin;)
      if (std::isfinite(values[i])) last = values[i];
    for (Eigen::Index i = run.begin; i < run.end; ++i) {
      if (std::isfinite(values[i])) last = values[i];
      filled[i] = last;
    }
  }
  return filled;
}

/// Median interval between the rows of runs, in s; `otherwise` where no run has two rows.
inline double median_interval_s(const Eigen::VectorXd& t_s, const std::vector<RunSpan>& runs,
                                double otherwise = 1.0) {
  std::vector<double> steps;
  for (const RunSpan& run : runs)
    for (Eigen::Index i = run.begin; i + 1 < run.end; ++i) steps.push_back(t_s[i + 1] - t_s[i]);
  if (steps.empty()) return otherwise;
  const std::size_t middle = steps.size() / 2;
  std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(middle), steps.end());
  return steps[middle];
}

/// The response of a first-order lag of time constant `tau_s` to an input that is held over each interval. Each run starts
/// at 0 or at its first value.
inline Eigen::VectorXd lagged(const Eigen::VectorXd& input, double tau_s, bool from_zero,
                              const Eigen::VectorXd& t_s, const std::vector<RunSpan>& runs) {
  Eigen::VectorXd out(input.size());
  for (const RunSpan& run : runs) {
    double x = from_zero ? 0.0 : input[run.begin];
    for (Eigen::Index i = run.begin; i < run.end; ++i) {
      out[i] = x;
      if (i + 1 < run.end) x += (input[i] - x) * (1.0 - std::exp(-(t_s[i + 1] - t_s[i]) / tau_s));
    }
  }
  return out;
}

/// Standard deviation of the noise on a smooth signal: from second or fourth differences, whichever see less
/// of the signal, and no less than the quantum allows.
inline double sample_noise(const Eigen::VectorXd& values, const std::vector<RunSpan>& runs) {
  std::vector<double> second, fourth;
  double quantum = 0.0;
  for (const RunSpan& run : runs) {
    for (Eigen::Index i = run.begin + 2; i + 2 < run.end; ++i) {
      const double two = values[i - 1] - 2.0 * values[i] + values[i + 1];
      const double four =
          values[i - 2] - 4.0 * values[i - 1] + 6.0 * values[i] - 4.0 * values[i + 1] + values[i + 2];
      if (!std::isfinite(four)) continue;
      second.push_back(two * two / 6.0);
      fourth.push_back(four * four / 70.0);
      const double step = std::fabs(values[i + 1] - values[i]);
      if (step > 1e-12 && (quantum == 0.0 || step < quantum)) quantum = step;
    }
  }
  if (second.empty()) return 0.0;
  // A trimmed mean: steps of the input are no noise. The divisor is what the tail takes from a normal
  // sample's variance.
  const auto trimmed = [](std::vector<double>& squares) {
    const std::size_t kept = std::max<std::size_t>(1, squares.size() * 95 / 100);
    std::nth_element(squares.begin(), squares.begin() + static_cast<std::ptrdiff_t>(kept - 1), squares.end());
    double sum = 0.0;
    for (std::size_t i = 0; i < kept; ++i) sum += squares[i];
    return std::sqrt(sum / static_cast<double>(kept) / 0.79);
  };
  return std::max(std::min(trimmed(second), trimmed(fourth)), quantum / std::sqrt(12.0));
}

}  // namespace thermopower::plant
