// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/sort_by.hpp>
#include <thermopower/gap/compare/evidence.hpp>
#include <thermopower/gap/compare/gap_taken.hpp>
#include <thermopower/gap/diagnosis.hpp>

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <string>
#include <vector>

/// @file choice.hpp
/// Which explanation is the answer, of those that were weighed: a class of explanations that predict alike.

namespace thermopower::gap::engine {

/// The explanation that is reported, with what stands beside it.
struct Answer {
  std::size_t chosen = 0;                 ///< index of the candidate
  double probability = 0.0;               ///< of its class
  double together = 0.0;                  ///< of its class and the alternatives
  std::vector<std::size_t> alternatives;  ///< candidates of other classes, likeliest first
};

/// Whether a set reaches the noise with constants as they are known, while a part of it reaches the noise only with
/// constants far off. For example, a current sensor's gain is a re-scaling of resistance, heat capacity and conductance.
inline bool spares_the_constants(const Candidate& set, const Candidate& part, const Model& model) {
  return largest_noise_multiple(set.held_out) <= decision.near_floor &&
         price_of_constants(part, model) - price_of_constants(set, model) > decision.dear_constants;
}

/// Multiple of the noise above which a part of a set leaves room for a further cause. It is lower where the part reaches
/// the noise only with constants far off.
inline double least_room_beside(const Candidate& part, const Model& model) {
  const bool far_off = price_of_constants(part, model) > usual_rarity + decision.dear_constants;
  return far_off ? decision.room_beside_dear_constants : decision.room_for_second;
}

/// The smallest part of a set of causes that does its work. A further cause is named only if the set without it stays
/// clearly above the noise. It must also take away at least half of what is left. Otherwise it mends small errors of the
/// others' equations.
inline std::size_t parsimonious(const std::vector<Candidate>& candidates, std::size_t chosen,
                                const Model& model) {
  assert(chosen < candidates.size());
  for (bool smaller = true; smaller;) {
    smaller = false;
    std::size_t part = 0;
    const Candidate& whole = candidates[chosen];
    for (std::size_t i = 1; i < candidates.size(); ++i) {
      const bool within = candidates[i].explanation.size() + 1 == whole.explanation.size() &&
                          whole.explanation.includes(candidates[i].explanation);
      if (within && !candidates[i].on_bounds && candidates[i].held_out.any() &&
          (part == 0 || candidates[i].deviance < candidates[part].deviance))
        part = i;
    }
    if (part != 0 && !whole.explanation.effects.empty() &&
        !spares_the_constants(whole, candidates[part], model) &&
        (largest_noise_multiple(candidates[part].held_out) < least_room_beside(candidates[part], model) ||
         excess(whole) > decision.second_takes * excess(candidates[part]))) {
      chosen = part;
      smaller = true;
    }
  }
  return chosen;
}

/// The likeliest candidate.
inline std::size_t likeliest(const std::vector<Candidate>& candidates) {
  assert(!candidates.empty());
  std::size_t chosen = 0;
  for (std::size_t i = 1; i < candidates.size(); ++i)
    if (candidates[i].probability > candidates[chosen].probability) chosen = i;
  return chosen;
}

/// Indices of the candidates, those of the least deviance first.
inline std::vector<std::size_t> by_deviance(const std::vector<Candidate>& candidates) {
  std::vector<std::size_t> order(candidates.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  sort_by(order, [&](std::size_t i) { return candidates[i].deviance; });
  return order;
}

/// Probability of all candidates that hold an explanation, itself included.
inline double probability_of_all_with(const std::vector<Candidate>& candidates, const Explanation& part) {
  double sum = 0.0;
  for (const Candidate& one : candidates)
    if (one.explanation.includes(part)) sum += one.probability;
  return sum;
}

/// Probability that no effect acts: nothing is missing, or constants alone are off.
inline double probability_of_constants(const std::vector<Candidate>& candidates) {
  double sum = 0.0;
  for (const Candidate& one : candidates)
    if (one.explanation.effects.empty()) sum += one.probability;
  return sum;
}

/// The answer. Where no explanation is likely, but likely ones share some causes, these are it.
inline Answer choose(const std::vector<Candidate>& candidates, const Model& model) {
  assert(!candidates.empty());
  Answer choice;
  const std::size_t best = likeliest(candidates);
  choice.chosen = parsimonious(candidates, best, model);
  const auto class_of = [&](std::size_t i) {
    const Explanation& one = candidates[i].explanation;
    return one.effects.empty() ? probability_of_constants(candidates)
                               : probability_of_all_with(candidates, one);
  };
  choice.probability = class_of(choice.chosen);
  if (choice.probability < 0.5) {
    for (std::size_t i = 1; i < candidates.size(); ++i) {
      const Candidate& one = candidates[i];
      if (one.explanation.effects.empty() || !in_the_running(one)) continue;
      const double shared = class_of(i);
      if (shared >= 0.5 && shared > choice.probability) {
        choice.chosen = i;
        choice.probability = shared;
      }
    }
  }
  const Explanation& answer = candidates[choice.chosen].explanation;
  choice.together = choice.probability;
  std::vector<std::size_t> order = by_deviance(candidates);
  sort_by(order, [&](std::size_t i) { return -candidates[i].probability; });
  for (const std::size_t i : order) {
    const Candidate& one = candidates[i];
    // Constants that moved are another answer than an effect, but not than other constants.
    const bool nested = one.explanation.effects.empty()
                            ? answer.effects.empty() || one.explanation.released.empty()
                            : one.explanation.includes(answer);
    if (i == choice.chosen || nested ||
        one.probability <= decision.alternative * candidates[best].probability)
      continue;
    choice.alternatives.push_back(i);
    choice.together += one.probability;
  }
  assert(!(choice.together < choice.probability) && choice.alternatives.size() < candidates.size());
  return choice;
}

}  // namespace thermopower::gap::engine
