// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace thermopower::gap {

/// Smallest step between different values of a channel: its quantum. 0 where it has only one value.
inline double quantum_of(const Eigen::VectorXd& values) {
  double smallest = std::numeric_limits<double>::infinity(), largest = 0.0, previous = std::nan("");
  for (double value : values) {
    if (!std::isfinite(value)) continue;
    const double step = std::abs(value - previous);
    largest = std::max(largest, std::abs(value));
    if (step > 1e-9 * largest && step < smallest) smallest = step;
    previous = value;
  }
  return std::isfinite(smallest) ? smallest : 0.0;
}

/// Standard deviation of the white part of a sequence, from its differences.
///
/// Differences of order k leave little of anything smooth and sqrt(binomial(2k, k)) of white noise; the least
/// of the orders 2 to 5 is taken, each from the smaller 97 % of its magnitudes, so that steps do not count.
/// `gaps[i]` true: entry i does not follow on entry i-1. @return 0 where there are too few samples
inline double white_sd(const std::vector<double>& sequence, const std::vector<bool>& gaps) {
  double least = std::numeric_limits<double>::infinity();
  std::vector<double> differences = sequence, magnitudes;
  std::vector<int> since_gap(sequence.size(), 0);
  for (std::size_t i = 1; i < sequence.size(); ++i) since_gap[i] = gaps[i] ? 0 : since_gap[i - 1] + 1;
  double gain = 1.0;
  for (int order = 1; order <= 5; ++order) {
    for (std::size_t i = differences.size(); i-- > 1;) differences[i] -= differences[i - 1];
    gain *= 2.0 * (2.0 * order - 1.0) / order;  // binomial(2k, k)
    if (order < 2) continue;
    magnitudes.clear();
    for (std::size_t i = 0; i < differences.size(); ++i)
      if (since_gap[i] >= order) magnitudes.push_back(std::abs(differences[i]));
    if (magnitudes.size() < 12) continue;
    const std::size_t kept = static_cast<std::size_t>(0.97 * static_cast<double>(magnitudes.size()));
    std::nth_element(magnitudes.begin(), magnitudes.begin() + static_cast<std::ptrdiff_t>(kept),
                     magnitudes.end());
    double sum = 0.0;
    for (std::size_t i = 0; i < kept; ++i) sum += magnitudes[i] * magnitudes[i];
    // 0.911: what the smaller 97 % of a normal distribution have for a standard deviation.
    const double sd = std::sqrt(sum / static_cast<double>(kept) / gain) / 0.911;
    least = std::min(least, sd);
  }
  return std::isfinite(least) ? least : 0.0;
}

/// How many samples in a row count as one: 1 + 2 sum of the autocorrelations, up to their first fall below
/// 0.05. At least 1, at most a quarter of the sequence.
inline double correlation_samples(const std::vector<double>& sequence) {
  const std::size_t count = sequence.size();
  if (count < 8) return 1.0;
  double mean = 0.0, variance = 0.0;
  for (double value : sequence) mean += value;
  mean /= static_cast<double>(count);
  for (double value : sequence) variance += (value - mean) * (value - mean);
  if (!(variance > 0.0)) return 1.0;
  double total = 1.0;
  // Lags grow by a quarter beyond 16, so that slow residuals cost no more than fast ones.
  for (std::size_t lag = 1, previous = 0; lag < count / 4;) {
    double product = 0.0;
    for (std::size_t i = lag; i < count; ++i) product += (sequence[i] - mean) * (sequence[i - lag] - mean);
    const double correlation = product / variance;
    if (correlation < 0.05) break;
    total += 2.0 * correlation * static_cast<double>(lag - previous);
    previous = lag;
    lag = lag < 16 ? lag + 1 : lag + lag / 4;
  }
  return std::min(total, static_cast<double>(count) / 4.0);
}

}  // namespace thermopower::gap
