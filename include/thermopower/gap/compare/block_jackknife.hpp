// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/normal_equations.hpp>
#include <thermopower/gap/fit/signal_sums.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <vector>

namespace thermopower::gap::engine {

/// A statistic of the data's blocks with its standard error.
struct Jackknifed {
  double value = 0.0;           ///< with all blocks
  double standard_error = 0.0;  ///< from leaving out one block after another
  std::size_t blocks = 0;       ///< how many there were
};

/// Blocks to merge so that each holds several samples that count.
/// @param samples      in total
/// @param correlation  samples that count as one
inline std::size_t blocks_to_merge(double samples, double correlation) {
  assert(!(correlation <= 0.0));
  constexpr std::size_t coarsest = 4;  // leaves six blocks
  std::size_t merge = 1;
  while (merge < coarsest &&
         samples / correlation < 2.0 * static_cast<double>(SignalSums::block_count / merge))
    merge *= 2;
  return merge;
}

/// Delete-one-block jackknife (jackknife_error()) of a statistic of two models' residuals.
/// @param merge      neighbouring blocks taken as one, a divisor of SignalSums::block_count
/// @param statistic  (a, b) -> value, of sums over some of the blocks
template <class Statistic>
Jackknifed block_jackknife(const SignalSums& a, const SignalSums& b, std::size_t merge,
                           Statistic&& statistic) {
  assert(merge > 0 && SignalSums::block_count % merge == 0);
  Jackknifed result;
  result.value = statistic(a, b);
  std::vector<double> left_out;
  for (std::size_t first = 0; first < SignalSums::block_count; first += merge) {
    SignalSums rest_a = a, rest_b = b;
    bool any = false;
    for (std::size_t i = 0; i < signal_count; ++i)
      for (std::size_t k = first; k < first + merge; ++k) {
        rest_a.squares[i] -= a.block_squares[i][k];
        rest_a.samples[i] -= a.block_samples[i][k];
        rest_b.squares[i] -= b.block_squares[i][k];
        rest_b.samples[i] -= b.block_samples[i][k];
        any = any || a.block_samples[i][k] > 0.0;
      }
    if (any) left_out.push_back(statistic(rest_a, rest_b));
  }
  result.blocks = left_out.size();
  result.standard_error = jackknife_error(left_out);
  return result;
}

/// How much better one candidate fits than another where every block has a noise of its own.
///
/// The difference of two pooled deviances is a function of two mean squares. A model may run away in one block, for example
/// at a resonance that it does not have. Its mean square is then that block's, and leaving the block out takes most of the
/// logarithm away. The other model would not be better beyond doubt, though it is a hundred times better in every block.
/// Block by block it is.
class BlockByBlock {
public:
  /// Adds data. @param a, b  the worse one's sums and the better one's
  /// @param merge            neighbouring blocks that count as one
  /// @param correlation      readings of each signal that count as one
  void add(const SignalSums& a, const SignalSums& b, std::size_t merge,
           const std::array<double, signal_count>& correlation) {
    constexpr double least = 1e-6,  // mean square in units of the noise: below, nothing is told any more
        above_the_noise = 1.5;      // the same
    assert(merge > 0 && SignalSums::block_count % merge == 0);
    std::vector<double> blocks;
    for (std::size_t first = 0; first < SignalSums::block_count; first += merge) {
      double sum = 0.0;
      bool any = false;
      for (std::size_t i = 0; i < signal_count; ++i) {
        double samples = 0.0, of_a = 0.0, of_b = 0.0;
        for (std::size_t k = first; k < first + merge; ++k) {
          samples += b.block_samples[i][k];
          of_a += a.block_squares[i][k];
          of_b += b.block_squares[i][k];
        }
        if (!(samples > 0.0)) continue;
        any = true;
        assert(!(correlation[i] <= 0.0));
        const double counted = samples / correlation[i];
        const double better =
            counted * std::log(std::max(of_a / samples, least) / std::max(of_b / samples, least));
        sum += better;
        if (of_a > above_the_noise * samples) readings_ += counted, clearly_ += better;
      }
      if (any) blocks.push_back(sum);
    }
    const double count = static_cast<double>(blocks.size());
    double value = 0.0;
    for (double one : blocks) {
      value += one;
      against_ += std::max(-one, 0.0);
    }
    value_ += value;
    for (double one : blocks)
      if (count > 1.0) variance_ += count / (count - 1.0) * (one - value / count) * (one - value / count);
  }

  /// Sum over the blocks of log(squares of a / squares of b) times the readings, as many as count as one.
  double value() const { return value_; }
  /// Its standard error: from how much the blocks differ.
  double standard_error() const { return std::sqrt(variance_); }

  /// Whether that decides. Only if hardly any block speaks against it: a model that is better here and worse there has to
  /// be weighed by how much. And only if it is at least twice as good in the blocks in which the other is above the noise.
  /// A tenth may come from an error that all blocks share. Not where the better one leaves the noise alone everywhere: then
  /// what the other has above it is the other's error.
  /// @param leaves_noise  whether the better one does
  bool decides(bool leaves_noise = false) const {
    constexpr double hardly_any = 0.05,  // of what speaks for it
        twice_as_good = 1.386;           // per reading: log of a quarter of the squares
    return readings_ > 0.0 && variance_ > 0.0 && against_ <= hardly_any * (value_ + against_) &&
           (leaves_noise || clearly_ >= twice_as_good * readings_);
  }

private:
  double value_ = 0.0, variance_ = 0.0, against_ = 0.0;
  double readings_ = 0.0, clearly_ = 0.0;  // in blocks where `a` is above the noise
};

}  // namespace thermopower::gap::engine
