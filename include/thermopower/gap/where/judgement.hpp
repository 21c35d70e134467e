// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/where/projection.hpp>

#include <algorithm>
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
class Judgement {
public:
  /// @param slack  how far the balance's constants may be off, as a fraction
  Judgement(const plant::Balance& balance, double slack, const LocalisationThresholds& limit)
      : signal_(balance.signal), instrument_(balance.instrument), limit_(limit) {
    const std::unique_ptr<Projection> projection = projection_of(balance, limit_);
    if (projection->rows() < limit_.least_rows) return;
    floor_ = projection->floor();
    const Problem problem = problem_of(balance, *projection, slack);
    std::vector<Block> blocks;
    for (const plant::Freedom& freedom : balance.freedoms)
      blocks.push_back(block_of(freedom, *projection, problem));
    const BlockFitter fitter(problem, blocks);
    none_ = fitter.fit({});
    best_ = choice(fitter);
    Eigen::Index from = problem.nuisance.cols() + problem.free.cols();
    for (const std::size_t i : best_.blocks) {
      plant::Freedom freedom = balance.freedoms[i];
      freedom.directions = nullptr;
      std::string words = freedom.words_at ? freedom.words_at(blocks[i].at) : freedom.words;
      chosen_.push_back({std::move(freedom), std::move(words), 0.0, best_.coefficients[from]});
      from += blocks[i].columns.cols();
    }
    weigh(fitter);
  }

  /// The signal that the balance's residual shows in.
  const plant::SignalName& signal() const { return signal_; }
  /// The instrument that shows it.
  const plant::SubmodelName& instrument() const { return instrument_; }
  /// Whether the constants within their slack leave more than noise allows.
  bool gap() const {
    return none_.seen > limit_.gap_seen * floor_ && none_.unseen > limit_.gap_unseen * floor_;
  }
  /// At most two; the one that explains more alone first.
  const std::vector<ChosenFreedom>& chosen() const { return chosen_; }
  /// Whether there is a gap of which they explain more than a share.
  bool is_explained_beyond(double share) const { return gap() && !chosen_.empty() && explained() > share; }
  /// Share of the excess on unseen stretches that all of them explain, at most 1.
  double explained() const { return std::min(1.0, (none_.unseen - best_.unseen) / excess()); }
  /// The rest of the constants alone on unseen stretches, in floors.
  double before() const { return none_.unseen / floor_; }
  /// The rest of the chosen freedoms there, in floors.
  double left() const { return best_.unseen / floor_; }
  /// The cost of this account of the balance among its alternatives.
  double cost() const {
    return best_.unseen * (1.0 + limit_.per_block * static_cast<double>(best_.blocks.size()));
  }

private:
  double excess() const { return std::max(none_.unseen - floor_, std::numeric_limits<double>::min()); }

  /// Of all single blocks and all pairs, the fewest directions that leave no clearly more on unseen stretches than the best.
  BlockFit choice(const BlockFitter& fitter) const {
    // Stretches that bind a constant make the prediction of the unseen worse than what was seen: either may say that
    // nothing is missing.
    if (none_.seen <= limit_.nothing_seen * floor_ && none_.unseen <= limit_.nothing_unseen * floor_)
      return none_;
    const auto best_of = [](const std::vector<BlockFit>& fits) {
      return *std::min_element(fits.begin(), fits.end(),
                               [](const BlockFit& a, const BlockFit& b) { return a.unseen < b.unseen; });
    };
    const auto simplest_of = [&](const std::vector<BlockFit>& fits) {
      BlockFit pick = best_of(fits);
      const double enough = (1.0 + limit_.as_good) * pick.unseen + limit_.as_good_floor * floor_;
      for (const BlockFit& one : fits)
        if (one.directions < pick.directions && one.unseen <= enough) pick = one;
      return pick;
    };
    std::vector<BlockFit> singles, pairs;
    for (std::size_t i = 0; i < fitter.size(); ++i) singles.push_back(fitter.fit({i}));
    if (singles.empty()) return none_;
    const BlockFit single = simplest_of(singles);
    const double left = best_of(singles).unseen;
    if (single.unseen > limit_.no_help * none_.unseen) return none_;
    if (left <= limit_.needs_a_second * floor_) return single;
    for (std::size_t i = 0; i < fitter.size(); ++i)
      for (std::size_t k = i + 1; k < fitter.size(); ++k)
        pairs.push_back(singles[k].unseen < singles[i].unseen ? fitter.fit({k, i}) : fitter.fit({i, k}));
    // A second block must matter: next to the first, and next to all there was to explain.
    if (pairs.empty() ||
        left - best_of(pairs).unseen <
            std::max(limit_.second_gain * left, limit_.second_share * (none_.unseen - floor_)))
      return single;
    return simplest_of(pairs);
  }

  void weigh(const BlockFitter& fitter) {
    double sum = 0.0;
    for (std::size_t k = 0; k < chosen_.size(); ++k) {
      const double without = chosen_.size() == 1 ? none_.unseen : fitter.fit({best_.blocks[1 - k]}).unseen;
      sum += chosen_[k].worth = std::max(0.0, without - best_.unseen);
    }
    for (ChosenFreedom& one : chosen_) one.worth *= sum > 0.0 ? std::max(0.0, explained()) / sum : 0.0;
  }

  plant::SignalName signal_;
  plant::SubmodelName instrument_;
  LocalisationThresholds limit_;
  BlockFit none_, best_;  // the constants alone, and with the chosen freedoms
  std::vector<ChosenFreedom> chosen_;
  double floor_ = 1.0;
};

}  // namespace thermopower::gap::engine
