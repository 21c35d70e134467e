// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/noise.hpp>
#include <thermopower/gap/fit/attribution.hpp>
#include <thermopower/gap/report/noise_of_errors.hpp>
#include <thermopower/gap/report/score.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

/// @file fit_noise.hpp
/// The noise that the residuals of a fit are measured in.

namespace thermopower::gap::engine {

/// Noise of a signal beyond which the residuals of averages hold something else: where the power is another one in each of
/// them, an error of the current looks like noise. Infinite where the samples do not tell.
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

/// Takes what a candidate leaves for a witness of the noise.
/// @param recordings  that the problem is made of, for the steps of their channels
inline void measure_noise(FitProblem& problem, const Candidate& candidate,
                          const std::vector<Inputs>& recordings) {
  std::array<std::vector<bool>, signal_count> gaps;
  const auto residuals = Attribution::residuals(candidate, problem, candidate.fit.starts, &gaps);
  const std::array<double, signal_count> wander =
      wander_of_command(augmented(*problem.model, candidate.explanation, candidate.list, candidate.fit.point),
                        problem.segments, *problem.catalogue);
  for (std::size_t i = 0; i < signal_count; ++i) {
    if (residuals[i].empty()) continue;
    const auto signal = static_cast<Signal>(i);
    const bool is_averaged = problem.segments.front().inputs->repeats.size() > 0;
    const double quantum = is_averaged ? 0.0 : coarsest_quantum(recordings, signal) / problem.sigma[i];
    const double in_units = noise_sd(residuals[i], gaps[i], quantum, {}, problem.measured_of_axis(signal)),
                 sd = std::min(in_units * problem.sigma[i], most_noise(problem, signal)),
                 rms = rms_of(residuals[i]) * problem.sigma[i];
    problem.sigma[i] = std::max(with_wander(sd, wander[i], rms), 1e-9);
  }
}

}  // namespace thermopower::gap::engine
