// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/fit/attribution.hpp>
#include <thermopower/gap/fit/segment_choice.hpp>
#include <thermopower/gap/compare/evidence.hpp>
#include <thermopower/gap/report/estimates.hpp>
#include <thermopower/gap/compare/fit_noise.hpp>

#include <algorithm>
#include <string>
#include <vector>

/// @file last_fit.hpp
/// The fit that the reported parameters come from, where the search looked at averages.

namespace thermopower::gap::engine {

/// Whether what a search fitted are averages of a fast recording of an axis.
inline bool is_averaged(const FitProblem& searched) {
  return std::any_of(searched.segments.begin(), searched.segments.end(),
                     [](const Segment& one) { return one.axis && one.inputs->repeats.size() > 0; });
}

/// When a fit to rows ends: as a search does, since it begins close to the end.
inline FitOptions last_fit() {
  FitOptions options;
  options.iterations = 15;
  options.relative_decrease = 1e-7;
  return options;
}

/// The rows as recorded, whose averages a search fitted, in windows of the same length. And the candidate fitted to them
/// from where the search ended.
/// @param recordings as recorded, which the averages are made of
/// @param horizon_s  length of the windows
/// @param rows       about so many of them
inline FitProblem fitted_to_rows(Candidate& candidate, const FitProblem& searched,
                                 const std::vector<Inputs>& recordings, double horizon_s, Eigen::Index rows) {
  FitProblem problem = searched;
  problem.segments =
      thinned_axis(cut(recordings, horizon_s, searched.plant()), rows, search_extent.windows_together);
  Attribution(problem).polish(candidate, last_fit());
  return problem;
}

/// Fits an explanation once more, to the rows as they were recorded, where the search fitted averages of a fast recording.
///
/// A mean command over some rows is the command only to a model that is linear in it. Inside a deadband, where a friction
/// turns, or where sides meet and part, averages leave a bias that no number of rows makes smaller. Intervals that tell of
/// the noise alone do not hold it.
/// @param result     its ranking says the same then
/// @param searched   what the search fitted
/// @param recordings as recorded, which that is made of
/// @param horizon_s  length of the windows
/// @param weight     receives what the rows' residuals say of their correlation
inline void fit_to_rows(Diagnosis& result, Candidate& candidate, const FitProblem& searched,
                        const std::vector<Inputs>& recordings, double horizon_s, Weight& weight) {
  constexpr Eigen::Index most_rows = 20000;  // a second's work at most; of 1 kHz, all of 20 s
  if (!is_averaged(searched)) return;
  FitProblem problem = fitted_to_rows(candidate, searched, recordings, horizon_s, most_rows);
  measure_noise(problem, candidate, recordings);
  const Weight of_rows = correlation_of(candidate, problem);
  problem.correlation = mean_correlation(of_rows);
  FitOptions options = last_fit();
  options.curvature = true;
  Attribution(problem).polish(candidate, options);
  weight.correlation = of_rows.correlation;
  for (RankedExplanation& entry : result.ranking)
    if (entry.effects == candidate.explanation.ids(*problem.model))
      describe_fit(entry, candidate, *problem.model, weight);
}

}  // namespace thermopower::gap::engine
