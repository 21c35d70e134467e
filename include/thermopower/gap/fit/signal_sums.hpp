// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/inputs.hpp>

#include <cassert>
#include <array>
#include <cstddef>
#include <numeric>
#include <vector>

namespace thermopower::gap::engine {

/// Squared residuals by signal, in units of the noise, in total and in contiguous blocks of equal length. The scatter of
/// the blocks shows how sure a difference of two totals is.
struct SignalSums {
  static constexpr std::size_t block_count = 24;  ///< a day has as many hours; merged where few count

  /// A sum over the residuals of one block.
  typedef std::array<std::array<double, block_count>, signal_count> Blocks;

  std::array<double, signal_count> squares{};  ///< sum of squares, indexed by Signal
  std::array<double, signal_count> samples{};  ///< how many were summed, indexed by Signal
  Blocks block_squares{};                      ///< the same block by block
  Blocks block_samples{};                      ///< the same block by block

  /// Mean square of a signal; 0 without samples.
  double mean(std::size_t signal) const {
    return samples[signal] > 0.0 ? squares[signal] / samples[signal] : 0.0;
  }

  /// Whether anything was summed.
  bool any() const { return count() > 0.0; }
  /// How many were summed, of all signals.
  double count() const { return std::accumulate(samples.begin(), samples.end(), 0.0); }
  /// Sum of the squares of all signals.
  double total() const { return std::accumulate(squares.begin(), squares.end(), 0.0); }

  /// Whether no signal's mean square is above this.
  bool within(double mean_square) const {
    for (std::size_t i = 0; i < signal_count; ++i)
      if (!(mean(i) <= mean_square)) return false;
    return true;
  }

  /// Residuals of a signal become so many times as large. @param by  0 or more
  void scale(std::size_t signal, double by) {
    assert(signal < signal_count && by >= 0.0);
    squares[signal] *= by * by;
    for (double& of_block : block_squares[signal]) of_block *= by * by;
  }

  /// Sets a signal's sums. @param unit  residuals are divided by it, > 0
  void set(std::size_t signal, const std::vector<double>& residuals, double unit = 1.0) {
    assert(signal < signal_count && !(unit <= 0.0));
    squares[signal] = samples[signal] = 0.0;
    block_squares[signal].fill(0.0);
    block_samples[signal].fill(0.0);
    for (std::size_t i = 0; i < residuals.size(); ++i) {
      const double scaled = residuals[i] / unit;
      const std::size_t block = i * block_count / residuals.size();
      block_squares[signal][block] += scaled * scaled;
      block_samples[signal][block] += 1.0;
      squares[signal] += scaled * scaled;
      samples[signal] += 1.0;
    }
  }
};

}  // namespace thermopower::gap::engine
