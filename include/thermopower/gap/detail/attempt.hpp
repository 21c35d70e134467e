// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/decide/evidence.hpp>
#include <thermopower/gap/decide/gap_taken.hpp>
#include <thermopower/gap/decide/search.hpp>
#include <thermopower/gap/decide/thresholds.hpp>
#include <thermopower/gap/fit/fit_problem.hpp>
#include <thermopower/gap/report/parts.hpp>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace thermopower::gap::engine {

/// What a search for causes came to.
struct Attempt {
  double horizon_s = 0.0;  ///< length of the windows
  FitProblem problem;      ///< of training data
  std::vector<Candidate> candidates;
  Weight weight;
  Reference reference;
  Model recalibrated;  ///< the model with its constants refitted

  /// The candidate that fits best, whatever its size.
  const Candidate& best() const { return fittest(candidates); }

  /// The most by which the best candidate is above the noise, over the signals.
  double best_noise_multiple() const { return largest_noise_multiple(best()); }

  /// Whether long windows may do harm.
  bool is_far() const { return best_noise_multiple() > decision.far_for_long_windows; }

  /// Whether it is so much nearer to the noise in its shorter windows that these are believed instead.
  bool is_nearer_than(const Attempt& longer) const {
    return best_noise_multiple() < decision.short_windows_lower * longer.best_noise_multiple();
  }
};

}  // namespace thermopower::gap::engine
