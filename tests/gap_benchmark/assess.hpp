// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "effect.hpp"

namespace gap_benchmark {

/// How plainly a case shows its cause, found with the plant itself and nothing of the library.
struct Assessment {
  double visible_train = 0.0;    ///< RMS over the floor, best signal, after re-calibration within the slack
  double visible_heldout = 0.0;  ///< the same on the held-out recording
  double confusability = 0.0;    ///< how well the best wrong cause passes for the true one, 0..1
  std::string confused_with;     ///< that cause
  double left_over = 0.0;        ///< RMS over the floor that the best wrong cause, or two of them, leave
  std::vector<std::pair<std::string, double>> others;  ///< every suspect and how well it passes

  /// No cause of the catalogue, nor two of them, come near the floor or explain most of it.
  bool beyond_catalogue() const { return confusability < 0.9 && left_over > 2.5 && left_over > 0.25 * visible_train; }

  /// Keeps, for every suspect, the lesser of two likenesses: one view that tells them apart is enough.
  void least(const Assessment& other) {
    for (auto& suspect : others)
      for (const auto& same : other.others)
        if (same.first == suspect.first) suspect.second = std::min(suspect.second, same.second);
    std::sort(others.begin(), others.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
    if (others.empty()) return;
    confused_with = others.front().first;
    confusability = others.front().second;
  }
};

/// Noise-free residuals of one recording for given parameters, in units of each signal's floor.
/// `Values` is the plant's parameter array; signals are stacked, `rows_per_signal` apart.
template <class Values>
struct Scenario {
  std::function<Eigen::VectorXd(const Values&)> residuals;
  Eigen::Index signals = 1;

  double worst_rms(const Eigen::VectorXd& r) const {
    const Eigen::Index rows = r.size() / signals;
    double worst = 0.0;
    for (Eigen::Index s = 0; s < signals; ++s)
      worst = std::max(worst, std::sqrt(r.segment(s * rows, rows).squaredNorm() / static_cast<double>(rows)));
    return worst;
  }

  struct Explained {
    double sum_of_squares, worst_rms;
  };

  /// What is left when the model's free numbers are fitted.
  Explained explained(const Values& model, const std::vector<Free>& free, int iterations) const {
    const auto with = [&](const std::vector<double>& values) {
      Values p = model;
      for (std::size_t j = 0; j < free.size(); ++j) p[static_cast<std::size_t>(free[j].index)] = values[j];
      return p;
    };
    const Fit best = fit_from_best_starts([&](const std::vector<double>& v) { return residuals(with(v)); }, free, iterations, 1e-3);
    return {best.sum_of_squares, worst_rms(residuals(with(best.values)))};
  }
};

/// The union of several lists of free numbers; a later entry for the same number replaces an earlier one.
inline std::vector<Free> joined(std::vector<Free> all, const std::vector<Free>& more) {
  for (const auto& f : more) {
    const auto same = std::find_if(all.begin(), all.end(), [&](const Free& g) { return g.index == f.index; });
    if (same == all.end())
      all.push_back(f);
    else
      *same = f;
  }
  return all;
}

/// Judges a drawn case.
/// @param truth ids of the causes at work; empty for none and for causes without a name
/// @param thorough whether to look for the best wrong cause, which takes most of the time
/// @param hopeless a likeness from which on the case will be drawn again, so that no more need be known
/// @param only_these suspects to look at; all when empty
template <class Context, class Values>
Assessment assess(const Scenario<Values>& train, const Scenario<Values>& heldout, const Context& context,
                  const std::vector<Effect<Context, Values>>& effects, const std::vector<Free>& slack,
                  const std::vector<std::string>& truth, bool thorough, double gate, double hopeless = 2.0,
                  const std::vector<std::string>& only_these = {}) {
  Assessment result;
  const auto only = [&](const std::vector<std::string>& ids) {
    std::vector<Free> free = slack;
    for (const auto& id : ids) free = joined(free, named(effects, id).suspect(context));
    return free;
  };
  // With two causes each has to be visible beside the other.
  std::vector<std::vector<std::string>> kept = {{}};
  if (truth.size() == 2) kept = {{truth[0]}, {truth[1]}};
  std::vector<typename Scenario<Values>::Explained> without;
  result.visible_train = result.visible_heldout = 1e9;
  for (const auto& ids : kept) {
    without.push_back(train.explained(context.model, only(ids), 12));
    result.visible_train = std::min(result.visible_train, without.back().worst_rms);
    if (result.visible_train < gate) return result;
    result.visible_heldout = std::min(result.visible_heldout, heldout.explained(context.model, only(ids), 12).worst_rms);
    if (result.visible_heldout < gate) return result;
  }
  if (!thorough) return result;
  for (const auto& suspect : effects) {
    if (!suspect.possible(context) || std::count(truth.begin(), truth.end(), suspect.id)) continue;
    const bool richer = std::any_of(truth.begin(), truth.end(), [&](const std::string& id) {
      return std::count(suspect.contains.begin(), suspect.contains.end(), id) > 0;
    });
    if (richer || (!only_these.empty() && !std::count(only_these.begin(), only_these.end(), suspect.id))) continue;
    double likeness = 0.0, left = 1e9;
    for (std::size_t i = 0; i < kept.size(); ++i) {
      auto ids = kept[i];
      ids.push_back(suspect.id);
      const auto explained = train.explained(context.model, only(ids), truth.size() == 2 ? 6 : 8);
      const double cosine = std::sqrt(std::max(0.0, 1.0 - explained.sum_of_squares / without[i].sum_of_squares));
      likeness = std::max(likeness, cosine);
      left = std::min(left, explained.worst_rms);
    }
    result.others.emplace_back(suspect.id, likeness);
    if (result.confused_with.empty() || likeness > result.confusability) {
      result.confusability = likeness;
      result.confused_with = suspect.id;
      result.left_over = left;
    }
    if (likeness >= hopeless) return result;
  }
  std::sort(result.others.begin(), result.others.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  if (truth.empty() && result.beyond_catalogue()) {
    // A cause without a name: two named ones together must not do either.
    for (std::size_t first = 0; first < std::min<std::size_t>(2, result.others.size()); ++first)
      for (std::size_t second = first + 1; second < std::min<std::size_t>(8, result.others.size()); ++second)
        result.left_over = std::min(result.left_over, train.explained(context.model, only({result.others[first].first, result.others[second].first}), 6).worst_rms);
  }
  return result;
}

}  // namespace gap_benchmark
