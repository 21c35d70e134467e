// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/compare/evidence.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace thermopower::gap::engine {

/// The reference of a cause: held-out scores without any cause, in units of the noise floor.
struct Reference {
  SignalSums as_configured;  ///< the model as its file has it
  SignalSums recalibrated;   ///< its constants refitted
};

/// How far above the noise the worst signal of a candidate remains, as a share of that without it. At the noise it is 0,
/// and 1 if nothing was explained.
inline double left_over(const SignalSums& after, const SignalSums& before) {
  double worst = 0.0;
  for (std::size_t i = 0; i < signal_count; ++i) {
    if (!(after.samples[i] > 0.0)) continue;
    const double excess = std::max(after.mean(i) - 1.0, 0.0), whole = std::max(before.mean(i) - 1.0, 1e-12);
    if (whole > decision.some_gap) worst = std::max(worst, std::sqrt(excess / whole));
  }
  return std::min(worst, 1.0);
}

/// Sum over the signals of the excess above the noise on held-out data, in units of its variance.
inline double excess(const Candidate& candidate) {
  double sum = 0.0;
  for (std::size_t i = 0; i < signal_count; ++i) sum += std::max(candidate.held_out.mean(i) - 1.0, 0.0);
  return sum;
}

}  // namespace thermopower::gap::engine
