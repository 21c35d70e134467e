// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/compare/choice.hpp>
#include <thermopower/gap/compare/evidence.hpp>
#include <thermopower/gap/compare/gap_taken.hpp>
#include <thermopower/gap/compare/search.hpp>
#include <thermopower/gap/compare/thresholds.hpp>
#include <thermopower/gap/fit/fit_problem.hpp>
#include <thermopower/gap/report/parts.hpp>

#include <algorithm>
#include <array>
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

  /// The share of the held-out gap that the likeliest explanation leaves, as a gap is judged.
  double left() const {
    const Candidate& one = candidates[likeliest(candidates)];
    return one.held_out.any() ? left_over(one.held_out, reference.as_configured) : 1.0;
  }

  /// By how much its likeliest explanation is likelier than another attempt's, by the training data and what its freedom costs: twice
  /// log odds. Both are fitted to the same readings, in noise of their own.
  double likelier_than(const Attempt& other) const {
    const Candidate &here = candidates[likeliest(candidates)],
                    &there = other.candidates[likeliest(other.candidates)];
    SignalSums in_its_noise = here.train;
    std::array<double, signal_count> correlation{};
    for (std::size_t i = 0; i < signal_count; ++i) {
      in_its_noise.scale(i, problem.sigma[i] / other.problem.sigma[i]);
      correlation[i] = std::max(weight.correlation[i], other.weight.correlation[i]);
    }
    return there.penalty - here.penalty + misfit_of(there.train, correlation) -
           misfit_of(in_its_noise, correlation);
  }

  /// Whether it closes so much more of the gap in its shorter windows that these are believed instead.
  bool closes_more_than(const Attempt& longer) const {
    return left() < decision.short_windows_lower * longer.left();
  }
};

}  // namespace thermopower::gap::engine
