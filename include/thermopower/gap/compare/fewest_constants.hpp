// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/fit/attribution.hpp>
#include <thermopower/gap/fit/candidate.hpp>

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <utility>
#include <vector>

namespace thermopower::gap::engine {

/// An explanation by constants alone in which all but some stand where they are configured.
inline Candidate with_only(const FitProblem& problem, const std::vector<int>& moving) {
  Candidate one;
  one.explanation.released = moving;
  one.list = coordinates(*problem.model, one.explanation, *problem.catalogue);
  for (std::size_t i = 0; i < one.list.size(); ++i)
    if (std::find(moving.begin(), moving.end(), static_cast<int>(i)) == moving.end())
      one.list[i].lower = one.list[i].upper = 0.0, one.list[i].still = true;
  return one;
}

/// The fewest constants that do what all of them do together. Many scalings of a plant predict alike, such as all torques
/// and inertias by one factor. The one that moves the fewest constants is named.
///
/// Forward selection: the constant that helps most is added until the training data are predicted as well as by `all`.
/// @param all      the fit of all constants
/// @param as_well  how many times its root mean square of each signal, or the noise where that is more, counts as well
/// @return     the fit with only those; `all` itself where no constant has slack
inline Candidate fewest_constants(const FitProblem& problem, const Candidate& all, double as_well) {
  const std::size_t count = problem.model->calibrated().size();
  assert(all.fit.point.size() >= static_cast<Eigen::Index>(count));
  const auto is_as_good = [&](const Candidate& one) {
    for (std::size_t i = 0; i < signal_count; ++i)
      if (one.train.mean(i) > as_well * as_well * std::max(all.train.mean(i), 1.0)) return false;
    return true;
  };
  FitOptions options;
  options.iterations = 30;
  std::vector<int> chosen;
  Candidate best = all;
  while (chosen.size() < count) {
    Candidate next;
    std::vector<int> with_next;
    for (int i = 0; i < static_cast<int>(count); ++i) {
      if (std::find(chosen.begin(), chosen.end(), i) != chosen.end()) continue;
      std::vector<int> moving = chosen;
      moving.push_back(i);
      Candidate one = with_only(problem, moving);
      if (!(one.list[static_cast<std::size_t>(i)].upper > one.list[static_cast<std::size_t>(i)].lower))
        continue;
      assert(one.list.size() == count);
      Fitter fitter(problem, one.explanation, one.list);
      Eigen::VectorXd from = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(count));
      one.fit = fitter.minimise(from, options);
      for (const int k : moving) from[k] = all.fit.point[k];
      FitResult other = fitter.minimise(from, options);
      if (other.cost < one.fit.cost) one.fit = std::move(other);
      one.train = one.fit.sums;
      if (with_next.empty() || one.fit.cost < next.fit.cost)
        next = std::move(one), with_next = std::move(moving);
    }
    if (with_next.empty()) return all;
    best = std::move(next);
    chosen = std::move(with_next);
    if (is_as_good(best)) break;
  }
  if (chosen.size() > 1) std::sort(best.explanation.released.begin(), best.explanation.released.end());
  return best;
}

}  // namespace thermopower::gap::engine
