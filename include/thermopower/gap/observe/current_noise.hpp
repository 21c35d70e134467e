// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/robust.hpp>
#include <thermopower/plant/rows.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

/// @file current_noise.hpp
/// The noise of a current sensor whose readings are the only heat that is known. Heat goes with the square, and the mean
/// square of a reading is that of the current and the noise's variance: a simulation is heated by what only the sensor saw.
/// Ripple of the current heats and must stay. Where nothing flows there is none: what is read there is the sensor's.

namespace thermopower::gap::engine {

/// Thresholds of the question how noisy a current sensor is. Held by tests/gap/observe/current_noise_test.cpp.
struct CurrentNoiseThresholds {
  Eigen::Index block_rows = 16;  ///< that tell a mean and a scatter of their own
  std::size_t least_blocks = 8;  ///< at rest: their scatter is then known to some 6 %
  double nothing_flows = 3.0;    ///< standard errors up to which a block's mean is 0
  double alike = 1.5;            ///< times the quietest quarter's scatter up to which a block is at rest
  double white = 0.25;  ///< share by which steps from row to row may differ from those of white noise
  double flows_elsewhere =
      4.0;  ///< times its variance that the mean square is at least: else there is no current to heat
  double of_the_heat =
      0.001;  ///< share of the mean square from which it matters: a twentieth of a kelvin in 50
};

/// Gathers the readings of one sensor, and tells its noise.
class CurrentNoise {
public:
  /// Adds readings. @param current_A  of each row
  void add(const Eigen::VectorXd& current_A, const std::vector<plant::RunSpan>& runs) {
    constexpr CurrentNoiseThresholds limit;
    for (const plant::RunSpan& run : runs)
      for (Eigen::Index begin = run.begin; begin + limit.block_rows <= run.end; begin += limit.block_rows) {
        const auto rows = current_A.segment(begin, limit.block_rows);
        if (!rows.array().isFinite().all()) continue;
        const double count = static_cast<double>(limit.block_rows), mean = rows.mean();
        squares_ += rows.squaredNorm();
        rows_ += count;
        Block block;
        block.variance = (rows.array() - mean).square().sum() / (count - 1.0);
        block.of_steps = (rows.tail(limit.block_rows - 1) - rows.head(limit.block_rows - 1)).squaredNorm() /
                         (2.0 * (count - 1.0));
        if (mean * mean * count <= limit.nothing_flows * limit.nothing_flows * block.variance &&
            block.variance > 0.0)
          still_.push_back(block);
      }
  }

  /// Standard deviation in A of what the sensor reads where nothing flows; nothing where the current never rests, or where its
  /// noise is too small to matter.
  std::optional<double> sd_A() const {
    constexpr CurrentNoiseThresholds limit;
    if (still_.size() < limit.least_blocks) return std::nullopt;
    std::vector<double> variances;
    for (const Block& one : still_) variances.push_back(one.variance);
    constexpr double quietest = 0.25;
    const double quiet = limit.alike * limit.alike * quantile_of(variances, quietest);
    double variance = 0.0, of_steps = 0.0, blocks = 0.0;
    for (const Block& one : still_) {
      if (one.variance > quiet) continue;
      variance += one.variance;
      of_steps += one.of_steps;
      blocks += 1.0;
    }
    if (blocks < static_cast<double>(limit.least_blocks)) return std::nullopt;
    variance /= blocks;
    of_steps /= blocks;
    const double mean_square = squares_ / rows_;
    if (std::abs(of_steps - variance) > limit.white * variance ||
        mean_square < limit.flows_elsewhere * variance || variance < limit.of_the_heat * mean_square)
      return std::nullopt;
    return std::sqrt(variance);
  }

private:
  struct Block {
    double variance = 0.0, of_steps = 0.0;
  };

  std::vector<Block> still_;  ///< in which nothing flows
  double squares_ = 0.0, rows_ = 0.0;
};

}  // namespace thermopower::gap::engine
