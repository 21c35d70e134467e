// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/sort_by.hpp>
#include <thermopower/gap/compare/fitness.hpp>
#include <thermopower/gap/compare/thresholds.hpp>
#include <thermopower/gap/diagnosis.hpp>
#include <thermopower/gap/fit/attribution.hpp>
#include <thermopower/gap/fit/in_parallel.hpp>
#include <thermopower/gap/fit/segment_choice.hpp>

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace thermopower::gap::engine {

/// The submodels in which places say that something is missing, where there are several: then two causes may be.
inline std::vector<plant::SubmodelName> suspects_among(const std::vector<Location>& where) {
  std::vector<plant::SubmodelName> found;
  for (const Location& one : where)
    if (std::find(found.begin(), found.end(), one.submodel) == found.end()) found.push_back(one.submodel);
  return found.size() > 1 ? found : std::vector<plant::SubmodelName>();
}

/// The data of the first look at explanations. If all candidates leave far more than noise, half of an axis' windows is
/// enough to rank them.
struct FirstLook {
  FitProblem few;   ///< on which all are looked at
  FitProblem some;  ///< on which the best of those are

  /// @param so_far  the best candidate
  FirstLook(const Candidate& so_far, const Attribution& glimpse, const Attribution& coarse)
      : few(glimpse.problem()), some(coarse.problem()) {
    if (so_far.train.within(search_extent.plain_above)) return;
    for (FitProblem* one : {&few, &some}) one->segments = thinned_axis(one->segments, rows(*one) / 2);
  }

private:
  static Eigen::Index rows(const FitProblem& problem) {
    Eigen::Index count = 0;
    for (const Segment& one : problem.segments)
      if (one.axis && !one.warm_up) count += one.end - one.begin;
    return count;
  }
};

/// A set worth fitting.
struct Promise {
  LinearGuess guess;     ///< after one linear step; of a set that nobody looked at it is empty
  std::size_t near = 0;  ///< place among the candidates of the fit of a part of it
  Explanation together;  ///< that part and the addition
};

/// Finds the sets of causes that are worth a fit.
class PromisingSets {
public:
  /// The attributions must pose the same question to different parts of the data, and outlive this object.
  /// @param glimpse   few of the data, on which all are looked at
  /// @param coarse    more of them, on which the best of those are
  /// @param threads   1 or more; the result does not depend on it
  /// @param suspects  submodels in which the measured rows themselves say that something is missing
  PromisingSets(const Attribution& glimpse, const Attribution& coarse, unsigned threads,
                std::vector<plant::SubmodelName> suspects)
      : glimpse_(glimpse), coarse_(coarse), threads_(threads), suspects_(std::move(suspects)) {}

  /// The pairs of causes that promise most, the best first: the best single ones with every other one, ranked by one linear
  /// step. They refer to the candidates by their places.
  /// @param late  where given, single causes that came later: only pairs with one of them are looked at
  std::vector<Promise> pairs(const std::vector<Candidate>& candidates,
                             const std::vector<Explanation>& singles,
                             const std::vector<Explanation>& late = {}) const {
    const auto is_new = [&](const Explanation& one) {
      return late.empty() ||
             std::any_of(late.begin(), late.end(), [&](const Explanation& of) { return one.includes(of); });
    };
    std::vector<Promise> promises;
    for (const std::size_t near : seeds_of(candidates))
      for (Promise& one : all_with(candidates, near, singles))
        if (is_new(one.together)) promises.push_back(std::move(one));
    return most_promising(std::move(promises), candidates, 8);
  }

  /// A candidate with every further cause, as pairs() has them.
  /// @param near  its place
  std::vector<Promise> with_each(const std::vector<Candidate>& candidates, std::size_t near,
                                 const std::vector<Explanation>& singles) const {
    return most_promising(all_with(candidates, near, singles), candidates, 6);
  }

private:
  static std::vector<Promise> all_with(const std::vector<Candidate>& candidates, std::size_t near,
                                       const std::vector<Explanation>& singles) {
    std::vector<Promise> promises;
    assert(near < candidates.size());
    const Explanation& part = candidates[near].explanation;
    for (const Explanation& single : singles)
      if (!part.includes(single)) promises.push_back({{}, near, part.with(single)});
    return promises;
  }

  /// @param fitted  so many are kept at most, each set once
  std::vector<Promise> most_promising(std::vector<Promise> promises, const std::vector<Candidate>& candidates,
                                      std::size_t fitted) const {
    const std::size_t looked_at = 3 * fitted;
    const FirstLook look(fittest(candidates), glimpse_, coarse_);
    const Attribution glimpse(look.few), coarse(look.some, look.few);
    const auto rank = [&](const Attribution& on) {
      in_parallel(promises.size(), threads_, [&](std::size_t i) {
        Promise& one = promises[i];
        one.guess = one.guess.starts.empty() ? on.promise(one.together, candidates[one.near])
                                             : on.promise(one.together, one.guess.starts);
      });
      sort_by(promises, [](const Promise& one) { return one.guess.cost; });
    };
    if (&glimpse_ != &coarse_ && promises.size() > looked_at) {
      rank(glimpse);
      promises.resize(looked_at);
    }
    rank(coarse);
    std::set<std::vector<std::string>> seen;
    std::vector<Promise> kept;
    for (Promise& one : promises) {
      std::vector<std::string> ids = one.together.ids(*coarse_.problem().model);
      std::sort(ids.begin(), ids.end());
      if (kept.size() < fitted && seen.insert(ids).second) kept.push_back(std::move(one));
    }
    return kept;
  }

  /// Places of the best single causes, and of the best ones of every suspected submodel. Of two causes of one size neither
  /// does well alone. Another effect that makes up for some of both does. None that is out of reach.
  std::vector<std::size_t> seeds_of(const std::vector<Candidate>& candidates) const {
    constexpr std::size_t best_of_all = 5;
    constexpr int best_of_submodel = 2;
    std::vector<std::size_t> seeds, others;
    const Candidate& best = fittest(candidates);
    for (std::size_t index : by_fitness(candidates, 0))
      if (candidates[index].explanation.effects.size() == 1 && !is_out_of_reach(candidates[index], best))
        (seeds.size() < best_of_all ? seeds : others).push_back(index);
    for (const plant::SubmodelName& suspect : suspects_) {
      int found = 0;
      for (const std::size_t one : others)
        if (found < best_of_submodel &&
            candidates[one].explanation.effects.front()->info.submodel == suspect &&
            std::find(seeds.begin(), seeds.end(), one) == seeds.end())
          seeds.push_back(one), ++found;
    }
    return seeds;
  }

  const Attribution& glimpse_;
  const Attribution& coarse_;
  unsigned threads_;
  std::vector<plant::SubmodelName> suspects_;
};

}  // namespace thermopower::gap::engine
