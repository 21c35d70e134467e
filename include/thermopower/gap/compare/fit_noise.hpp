// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/observe/noise.hpp>
#include <thermopower/gap/fit/attribution.hpp>
#include <thermopower/gap/compare/noise_of_errors.hpp>
#include <thermopower/gap/compare/rate_beside_angle.hpp>
#include <thermopower/gap/compare/score.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>
#include <vector>

/// @file fit_noise.hpp
/// The noise that the residuals of a fit are measured in.

namespace thermopower::gap::engine {

/// Noise of a signal beyond which the residuals of averages hold something else. If each average has another power, an
/// error of the current looks like noise. Infinite where the samples do not tell.
inline double most_noise(const FitProblem& problem, Signal signal) {
  double most = 0.0;
  for (const Segment& segment : problem.segments) {
    if (!segment.inputs->judged(signal)) continue;
    const double of_samples = segment.inputs->sample_noise[static_cast<std::size_t>(signal)];
    if (!(of_samples > 0.0)) return std::numeric_limits<double>::infinity();
    most = std::max(most, of_samples);
  }
  return most_of_a_mean() * most;
}

/// The residuals of a candidate on the data that it was fitted to, in the signals' units. Those of averages are scaled to
/// one sample.
inline Errors errors_left(const FitProblem& problem, const Candidate& candidate) {
  Errors left;
  left.time_constant_s = problem.model->time_constant_s();
  problem.evaluate(candidate.explanation, candidate.list, candidate.fit.point, candidate.fit.starts, false,
                   [&](std::size_t segment, const FitProblem::Residuals& one) {
                     assert(one.signal.size() == one.row.size() &&
                            one.value.size() == static_cast<Eigen::Index>(one.row.size()));
                     for (std::size_t i = 0; i < one.row.size(); ++i) {
                       const auto at = static_cast<std::size_t>(one.signal[i]);
                       left.of[at].push_back(one.value[static_cast<Eigen::Index>(i)] * problem.sigma[at]);
                       left.segment[at].push_back(static_cast<int>(segment));
                       left.row[at].push_back(one.row[i]);
                     }
                   });
  return left;
}

/// The part of a candidate's residuals that is taken for noise.
enum class TakenForNoise {
  what_looks_like_it,  ///< in each signal: a motion that is missed counts, too, where it looks like noise that remembers
  what_differs,  ///< no more than what a rate and the angle beside it do not show alike
};

/// Noise of each signal, as what a candidate leaves tells it; that of the problem where it says nothing of a signal.
/// @param recordings  that the problem is made of, for the steps of their channels
inline std::array<double, signal_count> noise_left(const FitProblem& problem, const Candidate& candidate,
                                                   const std::vector<Inputs>& recordings,
                                                   TakenForNoise taken = TakenForNoise::what_looks_like_it) {
  assert(!problem.segments.empty());
  const bool is_averaged = problem.segments.front().inputs->repeats.size() > 0;
  const Errors left = errors_left(problem, candidate);
  RateBesideAngle::Most of_motion;
  if (taken == TakenForNoise::what_differs && !is_averaged)
    of_motion = RateBesideAngle(left, problem.segments).most_noise();
  const std::array<double, signal_count> wander =
      wander_of_command(augmented(*problem.model, candidate.explanation, candidate.list, candidate.fit.point),
                        problem.segments, *problem.catalogue);
  std::array<double, signal_count> sigma = problem.sigma;
  for (std::size_t i = 0; i < signal_count; ++i) {
    if (left.of[i].empty()) continue;
    const auto signal = static_cast<Signal>(i);
    const double quantum = is_averaged ? 0.0 : coarsest_quantum(recordings, signal),
                 sd = std::min(noise_sd(left.of[i], left.gaps(signal), quantum, {},
                                        problem.measured_where_smooth(signal),
                                        most_noise_of(signal, left, problem.segments, of_motion)),
                               most_noise(problem, signal));
    sigma[i] = std::max(with_wander(sd, wander[i], left.rms(signal)), 1e-9);
  }
  return sigma;
}

/// Takes what a candidate leaves for a witness of the noise: all that looks like it.
inline void measure_noise(FitProblem& problem, const Candidate& candidate,
                          const std::vector<Inputs>& recordings) {
  problem.sigma = noise_left(problem, candidate, recordings);
}

}  // namespace thermopower::gap::engine
