// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/decide/evidence.hpp>
#include <thermopower/gap/decide/gap_taken.hpp>
#include <thermopower/gap/decide/search.hpp>
#include <thermopower/gap/decide/thresholds.hpp>
#include <thermopower/gap/fit/fit_problem.hpp>
#include <thermopower/gap/fit/overlooked.hpp>
#include <thermopower/gap/report/parts.hpp>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace thermopower::gap::engine {

/// What a search for causes came to.
struct Attempt {
  double horizon_s = 0.0;    ///< length of the windows
  FitProblem problem;        ///< of training data
  std::vector<Segment> all;  ///< what it has a part of
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

  /// The least share of the held-out gap that a candidate leaves, of those that were judged.
  double least_left() const {
    double least = 1.0;
    for (const Candidate& one : candidates)
      if (one.held_out.total() > 0.0)
        least = std::min(least, left_over(one.held_out, reference.as_configured));
    return least;
  }

  /// The windows that the best explanation fits worst, of those that were not fitted; none where even those that were are
  /// far above the noise: others tell no more then.
  /// @param window_s  length of the windows of the score
  std::vector<std::size_t> overlooked_windows(double window_s) const {
    constexpr double fitted = decision.far_for_more_windows;
    if (!best().train.within(fitted * fitted)) return {};
    return overlooked(problem, all, best(), window_s);
  }
};

}  // namespace thermopower::gap::engine
