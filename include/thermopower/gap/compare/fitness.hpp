// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/sort_by.hpp>
#include <thermopower/gap/compare/thresholds.hpp>
#include <thermopower/gap/fit/candidate.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <vector>

namespace thermopower::gap::engine {

/// Sum over the signals of samples times the logarithm of the mean square. That is twice the negative log likelihood if the
/// noise of every signal is unknown. No credit is given below the noise.
inline double fitness(const Candidate& candidate) {
  double sum = 0.0;
  for (std::size_t i = 0; i < signal_count; ++i)
    if (candidate.train.samples[i] > 0.0)
      sum += candidate.train.samples[i] * std::log(std::max(candidate.train.mean(i), 1e-6));
  return sum;
}

/// The candidate with the least deviance, whatever its size.
inline const Candidate& fittest(const std::vector<Candidate>& candidates) {
  assert(!candidates.empty());
  const Candidate* least = &candidates.front();
  for (const Candidate& one : candidates)
    if (fitness(one) < fitness(*least)) least = &one;
  return *least;
}

/// Whether a candidate's residuals are some five times those of the best one, which itself leaves far more than noise. Such
/// a candidate is not half of what is missing, and some steps of a fit do not make it the better one.
inline bool is_out_of_reach(const Candidate& one, const Candidate& best) {
  if (best.train.within(search_extent.plain_above)) return false;
  return fitness(one) - fitness(best) > std::log(search_extent.out_of_reach) * best.train.count();
}

/// Indices of the candidates from index `first` on, the fittest first.
inline std::vector<std::size_t> by_fitness(const std::vector<Candidate>& candidates, std::size_t first) {
  std::vector<std::size_t> order;
  for (std::size_t i = first; i < candidates.size(); ++i) order.push_back(i);
  sort_by(order, [&](std::size_t i) { return fitness(candidates[i]); });
  return order;
}

/// Of the candidates that fit nearly as well as the best, those whose constants moved least. Constants that ran far off
/// together in place of the missing effect, and any effect beside them, fit a little better than it.
inline std::vector<std::size_t> modest(const std::vector<Candidate>& candidates, const Model& model) {
  assert(!candidates.empty());
  constexpr double nearly = 0.02;  // of what the best gains
  constexpr std::size_t some = 4;
  double best = fitness(candidates.front()), worst = best;
  for (const Candidate& one : candidates) {
    best = std::min(best, fitness(one));
    worst = std::max(worst, fitness(one));
  }
  std::vector<std::size_t> list;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    if (fitness(candidates[i]) - best <= nearly * (worst - best)) list.push_back(i);
  sort_by(list, [&](std::size_t i) { return price_of_constants(candidates[i], model); });
  list.resize(std::min(list.size(), some));
  return list;
}

}  // namespace thermopower::gap::engine
