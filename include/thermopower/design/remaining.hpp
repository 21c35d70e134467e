// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/design/diagnosed.hpp>
#include <thermopower/design/possible.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace thermopower::design {

/// An explanation that is still possible, and whether it predicts all data as well as the likeliest one.
struct StillOpen {
  Possible explanation;  ///< that is still open
  bool tied = false;     ///< whatever its probability: only what was known before the data speaks against it
};

/// The explanations that an experiment has to tell apart: those that have one per cent or more, those that predict held-out data as
/// well as the likeliest one, and where none is sure the likeliest curve, which stands for every cause that nobody has named. At most six,
/// likeliest first.
/// @param catalogue  must outlive them; so must `gap`
inline std::vector<StillOpen> still_open(const DiagnosedGap& gap, const Catalogue& catalogue) {
  constexpr double likely = 0.01, as_well = 1.01;
  constexpr double hardly_less_likely = 10.0;  // twice a log: what a parameter or two are charged with
  constexpr double sure = 0.95, closes_half = 0.5;
  constexpr std::size_t most = 6;
  std::vector<const RankedExplanation*> order;
  for (const RankedExplanation& one : gap.ranking) order.push_back(&one);
  const auto ratio = [](const RankedExplanation& one) {
    return std::isfinite(one.held_out_ratio) ? one.held_out_ratio : 1e9;
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](const RankedExplanation* one, const RankedExplanation* other) {
                     const bool likelier = one->probability >= likely || other->probability >= likely;
                     return likelier ? one->probability > other->probability : ratio(*one) < ratio(*other);
                   });
  const bool is_sure = !order.empty() && order.front()->probability >= sure;
  std::vector<StillOpen> all;
  bool has_curve = false;
  for (const RankedExplanation* one : order) {
    if (one->at_bound && one->probability < likely) continue;
    const auto possible = Possible::of(gap.model, catalogue, *one);
    if (!possible) continue;
    // A curve can be like any cause of its place: that it predicts as well says nothing against the cause.
    const bool tied = !all.empty() && !possible->is_curve() &&
                      ratio(*one) <= as_well * ratio(*order.front()) &&
                      one->train_gain >= order.front()->train_gain - hardly_less_likely;
    const bool is_first_curve = possible->is_curve() && !has_curve && ratio(*one) < closes_half && !is_sure;
    const bool is_open = (one->probability >= likely || tied) && all.size() < most;
    if (!is_open && !is_first_curve && !all.empty()) continue;
    has_curve = has_curve || possible->is_curve();
    all.push_back({*possible, tied});
  }
  return all;
}

/// Weights that sum up to 1. None is below two per cent: a diagnosis that is wrong by more than it says is what an experiment is for.
inline std::vector<double> weights_of(const std::vector<Possible>& explanations) {
  constexpr double least = 0.02;
  std::vector<double> weights;
  double sum = 0.0;
  for (const Possible& one : explanations) sum += weights.emplace_back(std::max(one.probability(), least));
  for (double& one : weights) one /= sum;
  return weights;
}

}  // namespace thermopower::design
