// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "effect.hpp"

namespace gap_benchmark {

using Fitted = std::map<int, double>;

/// A wrong cause, and how well it passes for the true one.
struct Suspect {
  std::string id;
  double likeness = 0.0;       ///< 0..1
  std::vector<Fitted> fitted;  ///< what it takes, beside each cause that is kept
};

/// How plainly a case shows its cause, found with the plant itself and nothing of the library.
struct Assessment {
  double visible_train = 0.0;    ///< RMS over the floor, best signal, after re-calibration within the slack
  double visible_heldout = 0.0;  ///< the same on the held-out recording

  /// Whether the recording that shows less of it shows so much.
  bool is_within(double least, double most) const {
    const double shown = std::min(visible_train, visible_heldout);
    return shown >= least && shown <= most;
  }
  double left_over = 1e9;  ///< RMS over the floor that the best wrong cause, or two of them, leave
  std::vector<Suspect> suspects;

  /// The likeness of the best wrong cause.
  double confusability() const { return suspects.empty() ? 0.0 : suspects.front().likeness; }
  std::string confused_with() const { return suspects.empty() ? std::string() : suspects.front().id; }

  /// No cause of the catalogue, nor two of them, come near the floor or explain most of it.
  bool beyond_catalogue() const {
    return confusability() < 0.9 && left_over > 2.5 && left_over > 0.25 * visible_train;
  }

  void sort() {
    std::stable_sort(suspects.begin(), suspects.end(),
                     [](const Suspect& a, const Suspect& b) { return a.likeness > b.likeness; });
  }

  /// Keeps, for every suspect, the lesser of two likenesses: one view that tells them apart is enough.
  void least(const Assessment& other) {
    for (auto& suspect : suspects)
      for (const auto& same : other.suspects)
        if (same.id == suspect.id) suspect.likeness = std::min(suspect.likeness, same.likeness);
    sort();
  }
};

/// Noise-free residuals of one recording for given parameters, in units of each signal's floor.
/// `Values` is the plant's parameter array; the signals are stacked, with the same number of rows each.
template <class Values>
struct Scenario {
  std::function<Eigen::VectorXd(const Values&)> residuals;
  Eigen::Index signals = 1;

  struct Explained {
    double sum_of_squares = 0.0, worst_rms = 0.0;
    Fitted fitted;
  };

  /// What is left when the model's free numbers are fitted.
  /// @param seed a solution to try as well
  Explained explained(const Values& model, const std::vector<Free>& free, int iterations,
                      const Fitted& seed = {}) const {
    const auto with = [&](const std::vector<double>& values) {
      Values p = model;
      for (std::size_t j = 0; j < free.size(); ++j) p[static_cast<std::size_t>(free[j].index)] = values[j];
      return p;
    };
    const Residuals of = [&](const std::vector<double>& values) {
      Eigen::VectorXd r = residuals(with(values));
      // A replay that runs away is as wrong as can be, and no number.
      for (Eigen::Index i = 0; i < r.size(); ++i)
        r(i) = std::isfinite(r(i)) ? std::clamp(r(i), -1e6, 1e6) : 1e6;
      return r;
    };
    std::vector<double> seeded;
    for (const auto& f : free) {
      const auto known = seed.find(f.index);
      if (known != seed.end()) seeded.push_back(known->second);
    }
    if (seeded.size() != free.size()) seeded.clear();
    const Fit best = fit_from_best_starts(of, free, seeded, iterations, 1e-3);
    Explained result{best.sum_of_squares, worst_rms(of(best.values)), {}};
    for (std::size_t j = 0; j < free.size(); ++j) result.fitted[free[j].index] = best.values[j];
    return result;
  }

private:
  double worst_rms(const Eigen::VectorXd& r) const {
    const Eigen::Index rows = r.size() / signals;
    double worst = 0.0;
    for (Eigen::Index s = 0; s < signals; ++s)
      worst = std::max(worst, std::sqrt(r.segment(s * rows, rows).squaredNorm() / static_cast<double>(rows)));
    return worst;
  }
};

/// The union of several lists of free numbers; a later entry for the same number replaces an earlier one.
inline std::vector<Free> joined(std::vector<Free> all, const std::vector<Free>& more) {
  for (const auto& f : more) {
    const auto same = std::find_if(all.begin(), all.end(), [&](const Free& g) { return g.index == f.index; });
    if (same == all.end()) all.push_back(f);
    else *same = f;
  }
  return all;
}

/// What to look for.
struct Inquiry {
  std::vector<std::string>
      truth;              ///< ids of the causes at work; empty for none and for causes without a name
  bool thorough = true;   ///< whether to look for the best wrong cause, which takes most of the time
  double gate = 3.0;      ///< least RMS over the floor; below it nothing more is done
  double hopeless = 2.0;  ///< a likeness from which on the case is drawn again, so that no more need be known
  const Assessment* seeds =
      nullptr;  ///< an earlier look: only its suspects of likeness 0.9 and more, from what fitted there
};

/// Judges a drawn case.
template <class Context, class Values>
Assessment assess(const Scenario<Values>& train, const Scenario<Values>& heldout, const Context& context,
                  const std::vector<Effect<Context, Values>>& effects, const std::vector<Free>& slack,
                  const Inquiry& inquiry) {
  Assessment result;
  const auto& truth = inquiry.truth;
  // With two causes each has to be visible beside the other.
  std::vector<std::vector<Free>> kept = {slack};
  if (truth.size() == 2)
    kept = {joined(slack, named(effects, truth[0]).suspect(context)),
            joined(slack, named(effects, truth[1]).suspect(context))};
  std::vector<typename Scenario<Values>::Explained> without;
  result.visible_train = result.visible_heldout = 1e9;
  for (auto& free : kept) {
    without.push_back(train.explained(context.model, free, 12));
    result.visible_train = std::min(result.visible_train, without.back().worst_rms);
    if (result.visible_train < inquiry.gate) return result;
    if (!inquiry.seeds)
      result.visible_heldout =
          std::min(result.visible_heldout, heldout.explained(context.model, free, 12).worst_rms);
    if (result.visible_heldout < inquiry.gate) return result;
    for (auto& f : free)
      f.starts = {without.back().fitted[f.index]};  // a suspect begins where its absence ended
  }
  if (!inquiry.thorough) return result;
  for (const auto& effect : effects) {
    if (!effect.possible(context) || std::count(truth.begin(), truth.end(), effect.id)) continue;
    const bool richer = std::any_of(truth.begin(), truth.end(), [&](const std::string& id) {
      return std::count(effect.contains.begin(), effect.contains.end(), id) > 0;
    });
    if (richer) continue;
    const Suspect* seed = nullptr;
    if (inquiry.seeds) {
      for (const auto& earlier : inquiry.seeds->suspects)
        if (earlier.id == effect.id && earlier.likeness >= 0.9) seed = &earlier;
      if (!seed) continue;
    }
    Suspect suspect{effect.id, 0.0, {}};
    for (std::size_t i = 0; i < kept.size(); ++i) {
      const auto free = joined(kept[i], effect.suspect(context));
      auto explained =
          train.explained(context.model, free, truth.size() == 2 ? 6 : 8, seed ? seed->fitted[i] : Fitted{});
      suspect.likeness =
          std::max(suspect.likeness,
                   std::sqrt(std::max(0.0, 1.0 - explained.sum_of_squares / without[i].sum_of_squares)));
      suspect.fitted.push_back(explained.fitted);
      result.left_over = std::min(result.left_over, explained.worst_rms);
    }
    result.suspects.push_back(suspect);
    if (suspect.likeness >= inquiry.hopeless) break;
  }
  result.sort();
  if (truth.empty() && result.beyond_catalogue()) {
    // A cause without a name: two named ones together must not do either.
    const auto& all = result.suspects;
    for (std::size_t first = 0; first < std::min<std::size_t>(2, all.size()); ++first)
      for (std::size_t second = first + 1; second < std::min<std::size_t>(8, all.size()); ++second) {
        const auto free = joined(joined(kept[0], named(effects, all[first].id).suspect(context)),
                                 named(effects, all[second].id).suspect(context));
        result.left_over = std::min(result.left_over, train.explained(context.model, free, 6).worst_rms);
      }
  }
  return result;
}

}  // namespace gap_benchmark
