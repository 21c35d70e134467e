// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/compare/fitness.hpp>
#include <thermopower/gap/compare/promises.hpp>
#include <thermopower/gap/compare/thresholds.hpp>
#include <thermopower/gap/fit/attribution.hpp>
#include <thermopower/gap/fit/in_parallel.hpp>
#include <thermopower/gap/fit/segment_choice.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <utility>
#include <vector>

namespace thermopower::gap::engine {

/// Whether a set of causes is among candidates.
inline bool is_known(const std::vector<Candidate>& candidates, const Explanation& set) {
  return std::any_of(candidates.begin(), candidates.end(), [&](const Candidate& one) {
    return one.explanation.size() == set.size() && one.explanation.includes(set);
  });
}

/// Finds the explanations worth weighing: none, every single one, and the sets that promise most.
///
/// Everything is first tried on a small part of the data (`coarse`). The windows of a moving axis are then so short that
/// even friction that holds and lets go is nearly linear in its parameters. Effects with states that nobody measures are
/// tried in longer windows (`longer`). The best ones are fitted to more of the data (`fine`). Every candidate it returns
/// has its residuals on the fine data. Which sets are worth that is first looked at in few of the short windows
/// (`glimpse`).
class Search {
public:
  /// The attributions must pose the same question to different parts of the data, and outlive this object.
  /// @param threads   1 or more; the result does not depend on it
  /// @param suspects  submodels in which the measured rows themselves say that something is missing
  Search(const Attribution& glimpse, const Attribution& coarse, const Attribution& longer,
         const Attribution& fine, unsigned threads, std::vector<plant::SubmodelName> suspects = {})
      : glimpse_(glimpse),
        coarse_(coarse),
        longer_(longer),
        fine_(fine),
        threads_(threads),
        promising_(glimpse, coarse, threads, std::move(suspects)) {}

  /// The empty explanation and every single one, fitted to the first look's data alone.
  std::vector<Candidate> try_singles(const std::vector<Explanation>& singles) const {
    std::vector<Candidate> tried{fit(coarse_, {}, quick())};
    for (Candidate& one : fit_all(singles, tried.front())) tried.push_back(std::move(one));
    return tried;
  }

  /// Further single explanations, fitted to the first look's data alone.
  std::vector<Candidate> try_further(const std::vector<Explanation>& singles,
                                     const std::vector<Candidate>& candidates) const {
    return fit_all(singles, fittest(candidates));
  }

  /// Adds candidates that were tried to others, and fits the best of all to the fine data.
  void add(std::vector<Candidate>& candidates, const std::vector<Candidate>& tried) const {
    const std::size_t first = candidates.size();
    candidates.insert(candidates.end(), tried.begin(), tried.end());
    take_along(candidates, first);
    finish(candidates, 7);
  }

  /// Takes candidates to fine data that have become others, and fits the best of them there.
  /// @param hopeless  cost of a fit so far from which on a candidate is taken as it stands
  void take_over(std::vector<Candidate>& candidates, double hopeless) const {
    for (Candidate& one : candidates) one.settled = false;
    take_along(candidates, 0, hopeless);
    finish(candidates, fitted_to_the_end);
  }

  /// Looks at the details of the effects of the best candidates, if these leave more than noise. A second harmonic is one
  /// only after the first is found. A detail stays where it takes away most of the rest.
  /// @return whether the best one has changed
  bool refine_shapes(std::vector<Candidate>& candidates) const {
    constexpr std::size_t looked_at = 3;
    FitOptions options;
    options.iterations = 15;
    std::vector<std::size_t> order = by_fitness(candidates, 0);
    order.resize(std::min(looked_at, order.size()));
    assert(!order.empty());
    in_parallel(order.size(), threads_,
                [&](std::size_t i) { fine_.refine(candidates[order[i]], decision.second_takes, options); });
    return candidates[order.front()].explanation.refined;
  }

  /// The sets of causes that promise most.
  const PromisingSets& promising() const { return promising_; }

  /// Adds sets of causes, fitted to the first look's data and taken to the fine data. Their residuals there tell the noise;
  /// only then it is worth fitting them to the end.
  /// @param sets  the most promising one first
  void add_sets(std::vector<Candidate>& candidates, const std::vector<Promise>& sets) const {
    const FirstLook look(fittest(candidates), glimpse_, coarse_);
    add_fitted(candidates, sets, Attribution(look.some, look.few));
  }

  /// The same, fitted to the end, those that keep states among them even where the best candidate leaves no more than noise.
  void add_whatever_the_room(std::vector<Candidate>& candidates, const std::vector<Promise>& sets) const {
    const FirstLook look(fittest(candidates), glimpse_, coarse_);
    add_fitted(candidates, sets, Attribution(look.some, look.few));
    finish(candidates, sets.size() + fitted_to_the_end);
  }

  /// Fits candidates of as many causes as the best ones, or fewer, once more from the ends of those in sight of the very
  /// best. A smaller explanation loses to a larger one only after it has been fitted from there. Often the larger one has
  /// only found better constants.
  void refit_rivals(std::vector<Candidate>& candidates) const {
    FitOptions finish;
    finish.iterations = 12;
    finish.relative_decrease = 1e-5;
    const std::vector<std::size_t> order = by_fitness(candidates, 0);
    constexpr std::size_t looked_at = 6, related_to = 2;
    std::vector<char> is_lost(candidates.size(), 0);
    for (std::size_t place = 0; place < std::min(looked_at, order.size()); ++place) {
      const double farthest = Attribution::out_of_sight * fittest(candidates).train.total();
      if (candidates[order[place]].train.total() > farthest) continue;
      const Candidate leader = candidates[order[place]];
      std::vector<std::size_t> rivals;
      std::size_t related = 0;
      for (std::size_t index : order) {
        if (index == order[place] || index == 0 || is_lost[index]) continue;
        if (candidates[index].train.total() <= leader.train.total()) continue;  // nothing to learn there
        if (leader.explanation.includes(candidates[index].explanation) ||
            (place < related_to &&
             is_simpler_counterpart(candidates[index].explanation, leader.explanation)) ||
            (place < related_to && is_related(candidates[index].explanation, leader.explanation) &&
             related++ < 3))
          rivals.push_back(index);
      }
      in_parallel(rivals.size(), threads_, [&](std::size_t i) {
        is_lost[rivals[i]] = !fine_.refit_from(candidates[rivals[i]], leader, finish, decision.second_takes);
      });
    }
  }

  /// Brings constants of the best candidates back that are far off without need. If a cause and the constants do the same
  /// to the data, the cost lies in a long flat valley, along which only the prior pulls. A fit ends anywhere in it.
  void settle_constants(std::vector<Candidate>& candidates, const Model& model) const {
    constexpr std::size_t looked_at = 8;
    FitOptions finest;
    finest.iterations = 15;
    finest.relative_decrease = 1e-7;
    const double farthest = Attribution::out_of_sight * fittest(candidates).train.total();
    std::vector<std::size_t> far_off;
    for (const std::size_t index : by_fitness(candidates, 0)) {
      const Candidate& one = candidates[index];
      if (!one.explanation.effects.empty() && price_of_constants(one, model) > usual_rarity &&
          !(one.train.total() > farthest))
        far_off.push_back(index);
      if (far_off.size() == looked_at) break;
    }
    in_parallel(far_off.size(), threads_,
                [&](std::size_t i) { fine_.polish(candidates[far_off[i]], finest); });
  }

  /// Fits the best candidates anew: the noise has changed.
  /// @param by  what residuals in units of the noise are multiplied with for that, by signal
  void renew(std::vector<Candidate>& candidates, const std::array<double, signal_count>& by) const {
    for (Candidate& one : candidates) {
      one.settled = false;
      for (std::size_t i = 0; i < signal_count; ++i) one.train.scale(i, by[i]);
    }
    finish(candidates, fitted_to_the_end);
  }

private:
  static constexpr std::size_t fitted_to_the_end = 5;

  static FitOptions quick() {
    FitOptions options;
    options.iterations = 10;
    options.relative_decrease = 1e-3;
    return options;
  }

  /// A first fit, away from the fine data.
  Candidate fit(const Attribution& coarse, const Explanation& explanation, const FitOptions& options,
                const Candidate* near = nullptr, const std::vector<Eigen::VectorXd>& starts = {}) const {
    const bool longer = wants_longer(explanation);
    FitOptions on_longer = options;
    on_longer.hopeless = FitOptions{}.hopeless;  // that was a cost on other data
    if (starts.empty())
      return longer ? longer_.fit(explanation, on_longer, near) : coarse.fit(explanation, options, near);
    Candidate found = coarse.fit_from(explanation, starts, options);
    return longer ? longer_.fit(explanation, on_longer, near, &found.fit.point) : found;
  }

  /// Whether an explanation is fitted to longer segments.
  bool wants_longer(const Explanation& explanation) const {
    if (&longer_ == &coarse_) return false;
    return std::any_of(explanation.effects.begin(), explanation.effects.end(),
                       [](const CatalogueEntry* entry) { return remembers(*entry); });
  }

  /// @param so_far  the best candidate
  std::vector<Candidate> fit_all(const std::vector<Explanation>& explanations,
                                 const Candidate& so_far) const {
    const FirstLook look(so_far, glimpse_, coarse_);
    const Attribution coarse(look.some, look.few);
    std::vector<Candidate> candidates(explanations.size());
    in_parallel(explanations.size(), threads_,
                [&](std::size_t i) { candidates[i] = fit(coarse, explanations[i], quick()); });
    return candidates;
  }

  /// Whether each of a few causes is of a submodel that the other explanation blames, too.
  static bool is_related(const Explanation& few, const Explanation& all) {
    if (few.effects.empty() || few.size() > all.size()) return false;
    for (const CatalogueEntry* one : few.effects) {
      bool related = false;
      for (const CatalogueEntry* other : all.effects)
        related = related || one->info.submodel == other->info.submodel;
      if (!related) return false;
    }
    return true;
  }

  /// Whether a set has as many effects of the same submodels as another one, with fewer parameters.
  static bool is_simpler_counterpart(const Explanation& simple, const Explanation& rich) {
    return simple.effects.size() == rich.effects.size() &&
           simple.parameter_count() < rich.parameter_count() && is_related(simple, rich) &&
           is_related(rich, simple);
  }

  /// Takes candidates from index `first` on to the fine data.
  /// @param hopeless  cost of a first fit from which on a candidate is taken there as it stands
  void take_along(std::vector<Candidate>& candidates, std::size_t first,
                  double hopeless = FitOptions{}.hopeless) const {
    assert(first <= candidates.size());
    FitOptions look;
    look.iterations = 1;
    in_parallel(candidates.size() - first, threads_, [&](std::size_t i) {
      Candidate& one = candidates[first + i];
      if (one.fit.cost > hopeless && !wants_longer(one.explanation)) fine_.adopt(one);
      else fine_.polish(one, look);
    });
  }

  /// Fits the `count` best of all to the end: those that after some steps are in sight of the best one.
  void finish(std::vector<Candidate>& candidates, std::size_t count) const {
    std::vector<std::size_t> order = by_fitness(candidates, 0);
    order.resize(std::min(count, order.size()));
    if (std::find(order.begin(), order.end(), std::size_t{0}) == order.end()) order.push_back(0);
    FitOptions some, rest;
    some.iterations = 10;
    rest.iterations = 15;
    FitOptions in_sight = some;
    const Candidate& so_far = fittest(candidates);
    in_sight.hopeless = Attribution::out_of_sight * so_far.train.total();
    const double lost = Attribution::lost_from * so_far.train.total();
    order.erase(std::remove_if(order.begin(), order.end(),
                               [&](std::size_t i) {
                                 return i != 0 && (is_out_of_reach(candidates[i], so_far) ||
                                                   candidates[i].train.total() > lost);
                               }),
                order.end());
    in_parallel(order.size(), threads_, [&](std::size_t i) {
      Candidate& one = candidates[order[i]];
      if (one.settled) return;
      // The result of constants alone is reported in any case.
      fine_.polish(one, one.explanation.effects.empty() ? some : in_sight);
      one.settled = one.fit.iterations < some.iterations;
    });
    constexpr double out_of_sight = 1.4;  // of fitness per sample: residuals twice as large
    const Candidate& leader = fittest(candidates);
    const double samples = leader.train.count();
    const double least = fitness(leader);
    std::vector<std::size_t> unfinished;
    for (std::size_t index : order) {
      const Candidate& one = candidates[index];
      if (!one.settled && (index == 0 || fitness(one) - least < out_of_sight * samples))
        unfinished.push_back(index);
    }
    in_parallel(unfinished.size(), threads_, [&](std::size_t i) {
      Candidate& one = candidates[unfinished[i]];
      fine_.polish(one, rest);
      one.settled = one.fit.iterations < rest.iterations;
    });
  }

  /// Fits sets from the fits of their parts, and takes them among the candidates. The first is fitted to the end, the
  /// others as long as they are in its sight.
  void add_fitted(std::vector<Candidate>& candidates, const std::vector<Promise>& sets,
                  const Attribution& coarse) const {
    if (sets.empty()) return;
    assert(std::all_of(sets.begin(), sets.end(),
                       [&](const Promise& one) { return one.near < candidates.size(); }));
    std::vector<Candidate> found(sets.size());
    FitOptions options = quick();
    options.iterations = 12;
    const auto fit_one = [&](std::size_t i) {
      found[i] = fit(coarse, sets[i].together, options, &candidates[sets[i].near], sets[i].guess.starts);
    };
    fit_one(0);
    if (!wants_longer(sets.front().together))
      options.hopeless = Attribution::out_of_sight * found.front().fit.cost;
    in_parallel(sets.size() - 1, threads_, [&](std::size_t i) { fit_one(i + 1); });
    const std::size_t first = candidates.size();
    for (Candidate& one : found) candidates.push_back(std::move(one));
    take_along(candidates, first, options.hopeless);
  }

  const Attribution& glimpse_;
  const Attribution& coarse_;
  const Attribution& longer_;
  const Attribution& fine_;
  unsigned threads_;
  PromisingSets promising_;
};

}  // namespace thermopower::gap::engine
