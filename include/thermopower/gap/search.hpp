// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/attribution.hpp>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace thermopower::gap {

/// How a search for explanations is limited.
struct SearchOptions {
  unsigned threads = 1;
  double enough = 1.1;    ///< mean square of every signal below which no further effect is looked for
};

/// Finds the explanations worth weighing: none, every single one, and the pairs that promise most.
class Search {
public:
  Search(const Attribution& attribution, const FitProblem& problem, const SearchOptions& options)
      : attribution_(attribution), problem_(problem), options_(options) {}

  /// The empty explanation and every single one, fitted.
  std::vector<Candidate> run_singles(const std::vector<Explanation>& singles) const {
    FitOptions quick;
    quick.iterations = 8;
    quick.relative_decrease = 1e-4;
    std::vector<Explanation> all{Explanation{}};
    all.insert(all.end(), singles.begin(), singles.end());
    std::vector<Candidate> candidates = attribution_.fit_all(all, quick);
    polish_best(candidates, 6);
    return candidates;
  }

  /// Adds sets of causes where single ones leave something.
  void run_sets(std::vector<Candidate>& candidates, const std::vector<Explanation>& singles, int largest) const {
    for (int size = 2; size <= largest; ++size) {
      if (satisfied(best(candidates))) break;
      join(candidates, singles, size);
    }
  }

  /// Fits the best candidates, and the empty one, anew: the noise has changed.
  void renew(std::vector<Candidate>& candidates) const {
    for (Candidate& one : candidates) one.train = Attribution::sums(one, problem_, &one.fit.starts);
    polish_best(candidates, 6);
  }

  /// The candidate with the least deviance, whatever its size.
  static const Candidate& best(const std::vector<Candidate>& candidates) {
    const Candidate* least = &candidates.front();
    for (const Candidate& one : candidates)
      if (fitness(one) < fitness(*least)) least = &one;
    return *least;
  }

  /// Sum over the signals of samples times the logarithm of the mean square: twice the negative log likelihood
  /// where the noise of every signal is unknown.
  static double fitness(const Candidate& candidate) {
    double sum = 0.0;
    for (std::size_t i = 0; i < signal_count; ++i)
      if (candidate.train.samples[i] > 0.0)
        sum += candidate.train.samples[i] * std::log(std::max(candidate.train.mean(i), 1e-6));
    return sum;
  }

private:
  bool satisfied(const Candidate& candidate) const {
    for (std::size_t i = 0; i < signal_count; ++i)
      if (candidate.train.mean(i) > options_.enough) return false;
    return true;
  }

  void polish_best(std::vector<Candidate>& candidates, std::size_t count) const {
    std::vector<std::size_t> order(candidates.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return fitness(candidates[a]) < fitness(candidates[b]);
    });
    order.resize(std::min(count, order.size()));
    FitOptions options;
    options.iterations = 25;
    options.relative_decrease = 1e-6;
    in_parallel(order.size(), options_.threads, [&](std::size_t i) { attribution_.polish(candidates[order[i]], options); });
  }

  /// Adds sets of `size` causes: the best sets of one fewer with every single one, ranked by the linear promise,
  /// the most promising fitted.
  void join(std::vector<Candidate>& candidates, const std::vector<Explanation>& singles, int size) const {
    std::vector<const Candidate*> seeds;
    for (const Candidate& one : candidates)
      if (static_cast<int>(one.explanation.size()) == size - 1) seeds.push_back(&one);
    std::stable_sort(seeds.begin(), seeds.end(),
                     [](const Candidate* a, const Candidate* b) { return fitness(*a) < fitness(*b); });
    if (seeds.size() > 5) seeds.resize(5);

    struct Promise {
      double cost;
      const Candidate* near;
      Explanation together;
    };
    std::vector<Promise> promises;
    std::set<std::vector<std::string>> seen;
    for (const Candidate* near : seeds)
      for (const Explanation& single : singles) {
        if (near->explanation.includes(single)) continue;
        const Explanation together = near->explanation.with(single);
        std::vector<std::string> ids = together.ids(*problem_.model);
        std::sort(ids.begin(), ids.end());
        if (seen.insert(ids).second) promises.push_back({0.0, near, together});
      }
    in_parallel(promises.size(), options_.threads, [&](std::size_t i) {
      promises[i].cost = attribution_.promise(*promises[i].near, promises[i].together);
    });
    std::stable_sort(promises.begin(), promises.end(), [](const Promise& a, const Promise& b) { return a.cost < b.cost; });
    if (promises.size() > 12) promises.resize(12);
    std::vector<Candidate> joined(promises.size());
    FitOptions options;
    options.iterations = 15;
    in_parallel(promises.size(), options_.threads, [&](std::size_t i) {
      joined[i] = attribution_.fit(promises[i].together, options, promises[i].near);
    });
    for (Candidate& one : joined) candidates.push_back(std::move(one));
  }

  const Attribution& attribution_;
  const FitProblem& problem_;
  SearchOptions options_;
};

}  // namespace thermopower::gap
