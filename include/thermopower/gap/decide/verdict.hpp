// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/diagnosis.hpp>
#include <thermopower/gap/decide/evidence.hpp>
#include <thermopower/gap/options.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace thermopower::gap {

/// What the weighing of the candidates amounts to.
struct Conclusion {
  Verdict verdict = Verdict::insufficient;  ///< in one word
  std::size_t chosen = 0;                   ///< index of the candidate
  std::vector<std::size_t> alternatives;    ///< indices, likeliest first
  double none_of_these = 0.0;               ///< probability that the cause is outside the catalogue
  std::string reason;                       ///< one sentence in plain words
};

/// Whether a candidate shrinks some signal's score by more than the tolerance and none of its signals grows
/// by more, on held-out data.
inline bool matters(const Candidate& candidate, const Candidate& than, double tolerance) {
  bool better = false;
  for (std::size_t i = 0; i < signal_count; ++i) {
    if (!(candidate.held_out.samples[i] > 0.0)) continue;
    const double ratio = std::sqrt(candidate.held_out.mean(i) / std::max(than.held_out.mean(i), 1e-12));
    better = better || ratio < 1.0 - tolerance;
  }
  return better;
}

/// How far above the noise the worst signal of a candidate remains, as a share of what the empty explanation
/// leaves: 0 at the noise, 1 where nothing was explained.
inline double left_over(const Candidate& candidate, const Candidate& empty) {
  double worst = 0.0;
  for (std::size_t i = 0; i < signal_count; ++i) {
    if (!(candidate.train.samples[i] > 0.0)) continue;
    const double excess = std::max(level(candidate, i) * level(candidate, i) - 1.0, 0.0);
    const double whole = std::max(level(empty, i) * level(empty, i) - 1.0, 1e-12);
    if (whole > 0.1) worst = std::max(worst, std::sqrt(excess / whole));
  }
  return worst;
}

/// The largest root mean square of a candidate over its signals, in units of the noise.
inline double worst_level(const Candidate& candidate) {
  double worst = 0.0;
  for (std::size_t i = 0; i < signal_count; ++i) worst = std::max(worst, level(candidate, i));
  return worst;
}

/// Sum over the signals of what is above the noise, in units of its variance.
inline double excess(const Candidate& candidate) {
  double sum = 0.0;
  for (std::size_t i = 0; i < signal_count; ++i)
    sum += std::max(level(candidate, i) * level(candidate, i) - 1.0, 0.0);
  return sum;
}

/// The smallest part of a set of causes that does its work: a further cause is only named where the set
/// without it stays clearly above the noise and the further one takes away at least half of what is left.
/// Otherwise it mends small errors of the others' equations.
inline std::size_t parsimonious(const std::vector<Candidate>& candidates, std::size_t chosen) {
  for (bool smaller = true; smaller;) {
    smaller = false;
    std::size_t part = 0;
    for (std::size_t i = 1; i < candidates.size(); ++i) {
      const bool within = candidates[i].explanation.size() + 1 == candidates[chosen].explanation.size() &&
                          candidates[chosen].explanation.includes(candidates[i].explanation);
      if (within && !candidates[i].on_bounds &&
          (part == 0 || candidates[i].deviance < candidates[part].deviance))
        part = i;
    }
    if (part != 0 && (worst_level(candidates[part]) < 1.4 ||
                      excess(candidates[chosen]) > 0.5 * excess(candidates[part]))) {
      chosen = part;
      smaller = true;
    }
  }
  return chosen;
}

/// The largest probability among explanations that are no larger than one: what its rivals are measured
/// against.
inline double likeliest_of(const std::vector<Candidate>& candidates, const Candidate& chosen) {
  double largest = 0.0;
  for (const Candidate& one : candidates)
    if (one.explanation.size() <= chosen.explanation.size()) largest = std::max(largest, one.probability);
  return largest;
}

/// The conclusion that the simulation holds.
inline Conclusion nothing_missing() {
  Conclusion result;
  result.verdict = Verdict::no_gap;
  result.reason = "with its constants within their slack the simulation scores what the noise allows";
  return result;
}

/// Draws the conclusion. `candidates` are weighed; the first one is the empty explanation.
inline Conclusion conclude(const std::vector<Candidate>& candidates, const Options& options) {
  Conclusion result;
  const Candidate& empty = candidates.front();
  for (std::size_t i = 1; i < candidates.size(); ++i)
    if (candidates[i].probability > candidates[result.chosen].probability) result.chosen = i;
  if (result.chosen != 0) result.chosen = parsimonious(candidates, result.chosen);
  const Candidate& best = candidates[result.chosen];
  if (result.chosen == 0 || !matters(best, empty, options.tolerance)) {
    // Nothing helps: either nothing is missing, or nothing known.
    if (worst_level(empty) < 1.25) return nothing_missing();
    result.chosen = 0;
    result.verdict = Verdict::unexplained;
    result.none_of_these = 0.98;
    result.reason = "there is a gap, and no effect of the catalogue lowers it on held-out data";
    return result;
  }
  const double level_left = worst_level(best), share_left = left_over(best, empty);
  // Half way between "at the noise" and "clearly not": a factor 1.6 of the noise and a seventh of the gap; of
  // two causes, which bend to more, a twentieth.
  const double share_allowed = best.explanation.size() > 1 ? 0.05 : 0.15;
  double doubt = std::min(4.0 * (level_left - 1.5), 30.0 * (share_left - share_allowed));
  // Far above the noise no share is small enough: something with a structure of its own is left.
  doubt = std::max(doubt, 2.0 * (level_left - 6.0));
  result.none_of_these = 1.0 / (1.0 + std::exp(-std::clamp(doubt, -30.0, 30.0)));
  // Of hundreds of pairs one or the other can pass for a single cause that the catalogue lacks.
  constexpr double pair_for_unknown = 0.15;
  if (best.explanation.size() > 1)
    result.none_of_these = 1.0 - (1.0 - result.none_of_these) * (1.0 - pair_for_unknown);
  if (doubt > 0.0) {
    result.verdict = Verdict::unexplained;
    result.reason = "there is a gap, and the best explanation of the catalogue leaves too much of it";
    return result;
  }
  std::vector<std::size_t> order;
  for (std::size_t i = 1; i < candidates.size(); ++i)
    if (i != result.chosen && candidates[i].probability > 0.02 * likeliest_of(candidates, best) &&
        candidates[i].explanation.size() <= best.explanation.size())
      order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return candidates[a].probability > candidates[b].probability;
  });
  result.alternatives = order;
  result.verdict = order.empty() ? Verdict::explained : Verdict::ambiguous;
  result.reason = order.empty() ? "the named cause brings held-out data near the noise, and nothing else does"
                                : "several explanations bring held-out data near the noise";
  return result;
}

}  // namespace thermopower::gap
