// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/where/projection.hpp>

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

/// @file
/// The judgement of one balance: which freedoms of its plant, with no formula, predict what the baseline does not.

namespace thermopower::gap::engine {

/// A freedom that predicts what is missing in a balance.
struct ChosenFreedom {
  plant::Freedom freedom;    ///< without its directions: they hold the rows, and a recording may be long
  std::string words;         ///< its name, with the value that a scan found
  double worth = 0.0;        ///< share of the excess on unseen stretches that it explains, 0..1
  double coefficient = 0.0;  ///< its first
};

/// One balance, judged.
struct Judgement {
  plant::SubmodelName instrument;     ///< that shows the balance's signal
  bool gap = false;                   ///< the constants within their slack leave more than noise allows
  std::vector<ChosenFreedom> chosen;  ///< at most two; the one that explains more alone first
  double explained = 0.0;  ///< share of the excess on unseen stretches that all of them explain, at most 1
  double before = 0.0;     ///< rest of the constants alone on unseen stretches, in floors
  double left = 0.0;       ///< rest of the chosen freedoms there, in floors
  double cost = 0.0;       ///< of this account of the balance among its alternatives

  /// Whether there is a gap of which the chosen freedoms explain more than a share.
  bool is_explained_beyond(double share) const { return gap && !chosen.empty() && explained > share; }
};

namespace detail {

/// Of some fits the one that leaves least on unseen stretches.
inline const BlockFit& best_of(const std::vector<BlockFit>& fits) {
  return *std::min_element(fits.begin(), fits.end(),
                           [](const BlockFit& a, const BlockFit& b) { return a.unseen < b.unseen; });
}

/// Of some fits the fewest directions that leave no clearly more on unseen stretches than the best.
inline const BlockFit& simplest_of(const std::vector<BlockFit>& fits, double floor) {
  const BlockFit* pick = &best_of(fits);
  const double enough = (1.0 + where_limits.as_good) * pick->unseen + where_limits.as_good_floor * floor;
  for (const BlockFit& one : fits)
    if (one.directions < pick->directions && one.unseen <= enough) pick = &one;
  return *pick;
}

/// The simplest of all single blocks, or of all pairs where one block does not do. @param none  the constants alone
inline BlockFit best_fit(const BlockFitter& fitter, const BlockFit& none, double floor) {
  // Stretches that bind a constant make the prediction of the unseen worse than what was seen: either may say that
  // nothing is missing.
  if (fitter.size() == 0 ||
      (none.seen <= where_limits.nothing_seen * floor && none.unseen <= where_limits.nothing_unseen * floor))
    return none;
  std::vector<BlockFit> singles, pairs;
  for (std::size_t i = 0; i < fitter.size(); ++i) singles.push_back(fitter.fit({i}));
  const BlockFit& single = simplest_of(singles, floor);
  const double left = best_of(singles).unseen;
  if (single.unseen > where_limits.no_help * none.unseen) return none;
  if (left <= where_limits.needs_a_second * floor) return single;
  for (std::size_t i = 0; i < fitter.size(); ++i)
    for (std::size_t k = i + 1; k < fitter.size(); ++k)
      pairs.push_back(singles[k].unseen < singles[i].unseen ? fitter.fit({k, i}) : fitter.fit({i, k}));
  // A second block must matter: next to the first, and next to all there was to explain.
  if (pairs.empty() ||
      left - best_of(pairs).unseen <
          std::max(where_limits.second_gain * left, where_limits.second_share * (none.unseen - floor)))
    return single;
  return simplest_of(pairs, floor);
}

}  // namespace detail

/// Judges a balance. Of one that has too few rows nothing is said.
inline Judgement judged(const plant::Balance& balance) {
  Judgement result;
  result.instrument = balance.instrument;
  const std::unique_ptr<Projection> projection = projection_of(balance);
  if (projection->rows() < where_limits.least_rows) return result;
  const double floor = projection->floor();
  const Problem problem = problem_of(balance, *projection);
  std::vector<Block> blocks;
  for (const plant::Freedom& freedom : balance.freedoms)
    blocks.push_back(block_of(freedom, *projection, problem));
  const BlockFitter fitter(problem, blocks);
  const BlockFit none = fitter.fit({}), best = detail::best_fit(fitter, none, floor);
  const double gain = none.unseen - best.unseen,
               excess = std::max(none.unseen - floor, std::numeric_limits<double>::min());
  result.gap = none.seen > where_limits.gap_seen * floor && none.unseen > where_limits.gap_unseen * floor;
  result.explained = std::min(1.0, gain / excess);
  result.before = none.unseen / floor;
  result.left = best.unseen / floor;
  result.cost = best.unseen * (1.0 + where_limits.per_block * static_cast<double>(best.blocks.size()));
  assert(best.blocks.size() <= 2);
  Eigen::Index from = problem.nuisance.cols() + problem.free.cols();
  double sum = 0.0;
  for (std::size_t k = 0; k < best.blocks.size(); ++k) {
    const std::size_t i = best.blocks[k];
    plant::Freedom freedom = balance.freedoms[i];
    freedom.directions = nullptr;
    std::string words = freedom.words_at ? freedom.words_at(blocks[i].at) : freedom.words;
    const double without = best.blocks.size() == 1 ? none.unseen : fitter.fit({best.blocks[1 - k]}).unseen;
    result.chosen.push_back({std::move(freedom), std::move(words), std::max(0.0, without - best.unseen),
                             best.coefficients[from]});
    sum += result.chosen.back().worth;
    from += blocks[i].columns.cols();
  }
  for (ChosenFreedom& one : result.chosen)
    one.worth *= sum > 0.0 ? std::max(0.0, result.explained) / sum : 0.0;
  return result;
}

}  // namespace thermopower::gap::engine
