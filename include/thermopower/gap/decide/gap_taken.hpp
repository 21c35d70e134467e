// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/decide/evidence.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace thermopower::gap::engine {

/// What a cause is measured against: held-out scores without any, in units of the noise floor.
struct Reference {
  SignalSums as_configured;  ///< the model as its file has it
  SignalSums recalibrated;   ///< its constants refitted
};

/// Whether a candidate shrinks some signal's held-out score by more than the tolerance.
inline bool matters(const Candidate& candidate, const Candidate& than, double tolerance) {
  bool better = false;
  for (std::size_t i = 0; i < signal_count; ++i) {
    if (!(candidate.held_out.samples[i] > 0.0)) continue;
    const double ratio = std::sqrt(candidate.held_out.mean(i) / std::max(than.held_out.mean(i), 1e-12));
    better = better || ratio < 1.0 - tolerance;
  }
  return better;
}

/// Logarithm of the factor by which held-out scores shrink from one model to another, the mean over the signals
/// that are above the noise before, with its standard error over blocks.
inline Jackknifed shrinkage(const SignalSums& before, const SignalSums& after, const Weight& weight) {
  std::array<bool, signal_count> counts{};
  bool any = false;
  std::size_t merge = 1;
  for (std::size_t i = 0; i < signal_count; ++i) {
    counts[i] = before.samples[i] > 0.0 && noise_multiple(before, i) > decision.no_gap;
    any = any || counts[i];
    if (before.samples[i] > 0.0)
      merge = std::max(merge, blocks_to_merge(before.samples[i], weight.held_out[i]));
  }
  const auto logarithm = [&](const SignalSums& from, const SignalSums& to) {
    double sum = 0.0, signals = 0.0;
    for (std::size_t i = 0; i < signal_count; ++i) {
      if (!(from.samples[i] > 0.0) || (any && !counts[i])) continue;
      sum += 0.5 * std::log(std::max(from.mean(i), 1e-12) / std::max(to.mean(i), 1e-12));
      signals += 1.0;
    }
    return signals > 0.0 ? sum / signals : 0.0;
  };
  return block_jackknife(before, after, merge, logarithm);
}

/// Whether a cause takes a material and proven part of the held-out gap away, and makes no signal worse.
inline bool is_proven(const Candidate& candidate, const SignalSums& before, const Weight& weight) {
  for (std::size_t i = 0; i < signal_count; ++i) {
    const double grown = noise_multiple(candidate.held_out, i);
    if (grown > decision.no_gap && grown > (1.0 + decision.may_grow) * noise_multiple(before, i))
      return false;
  }
  const Jackknifed shrunk = shrinkage(before, candidate.held_out, weight);
  const double least = shrunk.value - decision.standard_errors * shrunk.standard_error;
  return 1.0 - std::exp(-shrunk.value) > decision.material && 1.0 - std::exp(-least) > decision.proven;
}

/// How far above the noise the worst signal of a candidate remains, as a share of what is there without it: 0 at
/// the noise, 1 where nothing was explained.
inline double left_over(const SignalSums& after, const SignalSums& before) {
  double worst = 0.0;
  for (std::size_t i = 0; i < signal_count; ++i) {
    if (!(after.samples[i] > 0.0)) continue;
    const double excess = std::max(after.mean(i) - 1.0, 0.0), whole = std::max(before.mean(i) - 1.0, 1e-12);
    if (whole > decision.some_gap) worst = std::max(worst, std::sqrt(excess / whole));
  }
  return std::min(worst, 1.0);
}

/// The same of the signals that are above the noise at all, against the larger of both shares: of a signal that hardly had a gap,
/// the last bit of noise is a large share.
inline double rest_above_noise(SignalSums after, const Reference& reference) {
  for (std::size_t i = 0; i < signal_count; ++i)
    if (noise_multiple(after, i) <= decision.no_gap) after.samples[i] = 0.0;
  return std::max(left_over(after, reference.as_configured), left_over(after, reference.recalibrated));
}

/// Sum over the signals of what is above the noise on held-out data, in units of its variance.
inline double excess(const Candidate& candidate) {
  double sum = 0.0;
  for (std::size_t i = 0; i < signal_count; ++i) sum += std::max(candidate.held_out.mean(i) - 1.0, 0.0);
  return sum;
}

/// Share of the blocks of held-out data in which one candidate is better than another, of those in which either is
/// above the noise: where the axis rests, or nothing heats, both are right.
inline double share_of_blocks(const Candidate& better, const Candidate& than) {
  double blocks = 0.0, won = 0.0;
  for (std::size_t k = 0; k < SignalSums::block_count; ++k) {
    double difference = 0.0;
    bool above = false;
    for (std::size_t i = 0; i < signal_count; ++i) {
      if (!(than.held_out.squares[i] > 0.0)) continue;
      const double ours = better.held_out.block_squares[i][k], theirs = than.held_out.block_squares[i][k];
      above = above ||
              std::max(ours, theirs) > decision.no_gap * decision.no_gap * than.held_out.block_samples[i][k];
      difference += (theirs - ours) / than.held_out.squares[i];
    }
    if (above && difference != 0.0) blocks += 1.0;
    if (above && difference > 0.0) won += 1.0;
  }
  return blocks > 0.0 ? won / blocks : 0.0;
}

}  // namespace thermopower::gap::engine
