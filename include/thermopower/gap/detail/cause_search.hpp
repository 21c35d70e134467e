// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/decide/evidence.hpp>
#include <thermopower/gap/decide/search.hpp>
#include <thermopower/gap/detail/posing.hpp>
#include <thermopower/gap/fit/overlooked.hpp>
#include <thermopower/gap/fit/short_windows.hpp>
#include <thermopower/gap/fit/single_causes.hpp>
#include <thermopower/gap/report/fit_noise.hpp>
#include <thermopower/gap/report/last_fit.hpp>
#include <thermopower/gap/report/parts.hpp>
#include <thermopower/gap/report/score.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace thermopower::gap::engine {

/// What a search for causes came to.
struct Attempt {
  double horizon_s = 0.0;    ///< length of the windows
  FitProblem problem;        ///< of training data
  std::vector<Segment> all;  ///< what it has a part of
  std::vector<Candidate> candidates;
  Weight weight;
  Reference reference;
  Model recalibrated;  ///< the model with its constants refitted

  /// The most by which the best candidate is above the noise, over the signals.
  double best_noise_multiple() const { return largest_noise_multiple(Search::best(candidates)); }
};

/// Searches the causes of what a model and its recordings differ by, and weighs what it finds.
///
/// In long windows at first: they tell more. Over such a window a small error can send an axis into the next dip of a load,
/// and short ones forgive that; where neither a single cause nor a set that promises much comes near the noise, the search goes
/// on in the short ones of the score, if it is nearer there.
class CauseSearch {
public:
  /// All of them must outlive this object.
  /// @param suspects  submodels in which the measured rows themselves say that something is missing
  CauseSearch(const Posing& posing, const std::vector<Inputs>& train, const std::vector<Inputs>& held_out,
              std::vector<plant::SubmodelName> suspects)
      : posing_(posing),
        model_(posing.model()),
        options_(posing.options()),
        catalogue_(posing.catalogue()),
        train_(train),
        held_out_(held_out),
        suspects_(std::move(suspects)) {}

  /// A search, and another one with the windows that the first overlooked.
  Attempt run() const {
    const double long_s = posing_.long_window_s();
    std::vector<std::size_t> worst;
    Attempt attempt = search(long_s, {}, &worst);
    if (worst.empty() && attempt.horizon_s == long_s) worst = overlooked_by(attempt);
    if (!worst.empty()) attempt = search(long_s, worst);
    if (attempt.horizon_s == long_s && may_be_shorter() && is_far(attempt)) {
      Attempt shorter = search(options_.horizon_s);
      if (is_nearer(shorter, attempt)) attempt = std::move(shorter);
    }
    return attempt;
  }

private:
  /// Whether there are windows that are shorter than the long ones.
  bool may_be_shorter() const {
    return train_.front().axis() && options_.horizon_s < posing_.long_window_s();
  }

  static bool is_far(const Attempt& attempt) {
    return attempt.best_noise_multiple() > decision.far_for_long_windows;
  }

  static bool is_nearer(const Attempt& shorter, const Attempt& longer) {
    return shorter.best_noise_multiple() < decision.short_windows_lower * longer.best_noise_multiple();
  }

  /// The windows that the best explanation of an attempt fits worst, of those that were not fitted.
  std::vector<std::size_t> overlooked_by(const Attempt& attempt) const {
    const Candidate& best = Search::best(attempt.candidates);
    // Where even the windows that were fitted are far above the noise, others tell no more.
    constexpr double fitted = decision.far_for_more_windows;
    if (!best.train.within(fitted * fitted)) return {};
    return overlooked(attempt.problem, attempt.all, best, options_.horizon_s);
  }

  /// @param also   windows to fit, too
  /// @param worst  where given, receives the windows that the single causes overlook; where there are such, the
  ///               attempt ends there
  Attempt search(double horizon_s, const std::vector<std::size_t>& also = {},
                 std::vector<std::size_t>* worst = nullptr) const {
    Attempt attempt;
    const auto fitted = [&](double window_s) {
      Posing::Extent extent = posing_.fitted(window_s);
      extent.together = search_extent.windows_together;
      if (window_s == horizon_s) extent.also = also;
      attempt.horizon_s = window_s;
      return posing_.pose(train_, extent, &attempt.all);
    };
    FitProblem& problem = attempt.problem = fitted(horizon_s);
    const double short_s = std::min(search_extent.tried_window_s, options_.horizon_s);
    FitProblem longer_problem = posing_.pose(
        train_, {short_s, search_extent.tried_bench_rows, search_extent.tried_axis_rows,
                 search_extent.windows_together, short_s == horizon_s ? also : std::vector<std::size_t>()});
    longer_problem.segments = thinned_runs(longer_problem.segments, search_extent.tried_bench_rows);
    FitProblem coarse_problem = longer_problem;
    FitProblem glimpse_problem = longer_problem;
    const double shortest_s = shortest_window_s(model_, catalogue_, train_, short_s);
    if (shortest_s < short_s) {
      const auto shortest = [&](Eigen::Index rows) {
        FitProblem posed = posing_.pose(train_, {shortest_s, search_extent.tried_bench_rows, rows, 1, {}});
        posed.segments = thinned_runs(posed.segments, search_extent.tried_bench_rows);
        return posed;
      };
      coarse_problem = shortest(search_extent.shortest_axis_rows);
      glimpse_problem = shortest(search_extent.glimpsed_axis_rows);
    }
    std::vector<Candidate>& candidates = attempt.candidates;
    const Attribution glimpse(glimpse_problem), coarse(coarse_problem, glimpse_problem),
        longer(longer_problem), fine(problem);
    for (int round = 0; round < 2; ++round) measure_noise(longer_problem, longer.fit({}, {}), train_);
    problem.sigma = glimpse_problem.sigma = coarse_problem.sigma = longer_problem.sigma;
    const bool in_short_windows = shortest_s < short_s;
    const Search searching(in_short_windows ? glimpse : coarse, coarse, in_short_windows ? longer : coarse,
                           fine, options_.threads, suspects_);
    std::vector<Explanation> causes, costly;
    for (Explanation& one : single_causes(model_, catalogue_, options_.without, train_)) {
      const bool is_costly = !one.effects.empty() && one.effects.front()->info.costly;
      (is_costly ? costly : causes).push_back(std::move(one));
    }
    std::vector<Candidate> tried = searching.try_singles(with_pairs_of_constants(causes));
    searching.add(candidates, tried);
    const auto renew = [&] {
      measure_noise(problem, Search::best(candidates), train_);
      glimpse_problem.sigma = coarse_problem.sigma = longer_problem.sigma = problem.sigma;
      problem.correlation = mean_correlation(correlation_of(Search::best(candidates), problem));
      searching.renew(candidates);
    };
    renew();
    const auto add_costly = [&] {
      const std::vector<Candidate> further = searching.try_further(costly, candidates);
      searching.add(candidates, further);
      tried.insert(tried.end(), further.begin(), further.end());
      causes.insert(causes.end(), costly.begin(), costly.end());
      costly.clear();
      renew();
    };
    if (!costly.empty() && !does_for_now(Search::best(candidates))) add_costly();
    const auto look_closely = [&] {
      if (searching.refine_shapes(candidates)) renew();
      if (searching.look_beside(candidates, decision.room_for_sets)) renew();
    };
    look_closely();
    if (worst != nullptr && !(*worst = overlooked_by(attempt)).empty()) return attempt;
    // Where averages leave the best explanation above the noise and the rows themselves do not, the rows are what is fitted to.
    const auto look_at_rows = [&] {
      constexpr double near = decision.near_floor;
      Candidate leader = Search::best(candidates);
      if (!is_averaged(problem) || leader.train.within(near * near)) return;
      const double hopeless = 2.0 * leader.fit.cost;
      FitProblem rows =
          fitted_to_rows(leader, problem, train_, attempt.horizon_s, search_extent.fitted_recorded_rows);
      if (!leader.train.within(near * near)) return;
      problem = std::move(rows);
      attempt.all = problem.segments;  // no window of averages is one of these
      searching.take_over(candidates, hopeless);
      renew();
    };
    look_at_rows();
    // Constants move in every explanation: only effects are joined.
    std::vector<Explanation> effects;
    for (const Explanation& one : causes)
      if (!one.effects.empty() && options_.effects_at_once > 1) effects.push_back(one);
    std::vector<Search::Promise> pairs;
    if (horizon_s > options_.horizon_s && may_be_shorter() && is_far(attempt)) {
      pairs = searching.promising_sets(candidates, effects, 2);
      if (!searching.come_near(pairs, decision.far_for_long_windows)) {
        Attempt in_long_windows = attempt;
        problem = fitted(options_.horizon_s);
        problem.sigma = in_long_windows.problem.sigma;
        candidates.clear();
        searching.add(candidates, tried);
        renew();
        look_closely();
        if (!is_nearer(attempt, in_long_windows)) {
          attempt = std::move(in_long_windows);
          glimpse_problem.sigma = coarse_problem.sigma = longer_problem.sigma = problem.sigma;
        }
      }
    }
    if (!effects.empty()) {
      searching.run_sets(candidates, effects, options_.effects_at_once, decision.room_for_sets,
                         std::move(pairs));
      renew();
      if (searching.refine_shapes(candidates)) renew();
      look_at_rows();
    }
    const auto decide = [&] {
      searching.refit_rivals(candidates);
      name_moved_constants(candidates, model_);
      attempt.weight = correlation_of(Search::best(candidates), problem);
      attempt.weight.shown = shown_by(train_);
      attempt.recalibrated = recalibrate(candidates, fine);
      judge(attempt, fine);
      weigh(candidates, attempt.weight, model_);
    };
    decide();
    // What fits the data it was fitted to, and fails on others, was a stand-in.
    constexpr double near = decision.near_floor;
    if (!costly.empty() && !Search::best(candidates).held_out.within(near * near)) {
      add_costly();
      decide();
    }
    return attempt;
  }

  /// Whether an explanation leaves no more than noise in the windows of its fit and, as a gap is judged, lowers it on
  /// the data it was fitted to. Rough motion that no window follows looks like noise in the first.
  bool does_for_now(const Candidate& one) const {
    constexpr double room = decision.room_for_costly, lowered = decision.lowered_without_costly;
    if (!one.train.within(room * room)) return false;
    if (one.explanation.effects.empty()) return true;
    const std::vector<Segment> segments = posing_.judged(train_);
    const Errors before = errors_of(model_, segments, catalogue_),
                 after = errors_of(augmented(model_, one.explanation, one.list, one.fit.point), segments,
                                   catalogue_);
    for (int i = 0; i < signal_count; ++i)
      if (after.rms(static_cast<Signal>(i)) < lowered * before.rms(static_cast<Signal>(i))) return true;
    return false;
  }

  /// The model with its constants refitted: the best explanation by constants alone, or as configured where that
  /// scores better on the very data.
  Model recalibrate(std::vector<Candidate>& candidates, const Attribution& fine) const {
    Candidate* best = &candidates.front();
    for (Candidate& one : candidates)
      if (one.explanation.effects.empty() && Search::fitness(one) < Search::fitness(*best)) best = &one;
    fine.polish(*best, {});
    const Model fitted = augmented(model_, best->explanation, best->list, best->fit.point);
    const std::vector<Segment> segments = posing_.judged(train_);
    const Errors before = errors_of(model_, segments, catalogue_),
                 after = errors_of(fitted, segments, catalogue_);
    double worse = 0.0;
    for (int i = 0; i < signal_count; ++i) {
      const Signal signal = static_cast<Signal>(i);
      if (before.rms(signal) > 0.0 && after.rms(signal) > 0.0)
        worse += std::log(after.rms(signal) / before.rms(signal));
    }
    return worse > 0.0 ? model_ : fitted;
  }

  /// Scores the empty explanation, those by constants alone, and the best ones on held-out data, as a gap is
  /// judged. The others are out of the running.
  void judge(Attempt& attempt, const Attribution& fine) const {
    std::vector<Candidate>& candidates = attempt.candidates;
    for (Candidate& one : candidates) {
      one.held_out = {};
      one.hidden_starts = 0;
    }
    const std::vector<Segment> segments = posing_.judged(held_out_);
    const auto model_of = [&](const Candidate& one) {
      return augmented(model_, one.explanation, one.list, one.fit.point);
    };
    const Model best = model_of(Search::best(candidates));
    const Model& witness = follows_its_data(Search::best(candidates)) ? best : model_;
    const Errors errors = errors_of(best, segments, catalogue_);
    const std::array<double, signal_count> sigma = noise_of(errors, segments, held_out_),
                                           floor = floor_of(witness, errors, sigma, segments, catalogue_);
    for (std::size_t i = 0; i < signal_count; ++i)
      if (!errors.of[i].empty()) attempt.weight.held_out[i] = correlation_samples(errors.of[i]);
    // Of two explanations one may fit starts that nobody measures: then both may move the measured one within its
    // noise, or a wrong first reading speaks for hidden nodes.
    const auto scored = [&](const Model& model) {
      const Errors own = errors_of(model, segments, catalogue_, &sigma);
      SignalSums sums;
      for (std::size_t i = 0; i < signal_count; ++i) sums.set(i, own.of[i], std::max(floor[i], 1e-12));
      return sums;
    };
    const std::vector<std::size_t> order = Search::by_fitness(candidates, 0);
    std::vector<std::size_t> looked_at;
    std::size_t single = 0;
    const std::vector<std::size_t> modest = Search::modest(candidates, model_);
    // A set that lost by far on what it was fitted to is in nobody's way.
    const double lost = Attribution::lost_from * Search::best(candidates).train.total();
    for (std::size_t place = 0; place < order.size(); ++place) {
      const Explanation& one = candidates[order[place]].explanation;
      const bool among_singles = one.size() == 1 && single++ < 7;
      const bool is_lost = one.effects.size() > 1 && candidates[order[place]].train.total() > lost;
      const bool is_modest = std::find(modest.begin(), modest.end(), order[place]) != modest.end();
      if ((place < 14 && !is_lost) || among_singles || is_modest || one.effects.empty())
        looked_at.push_back(order[place]);
    }
    in_parallel(looked_at.size(), options_.threads, [&](std::size_t i) {
      Candidate& one = candidates[looked_at[i]];
      const Model model = model_of(one);
      one.held_out = scored(model);
      fine.survey(one);
      const auto rollout = plant_of(model).rollout(model, catalogue_, {}, {}, SimulationMode::free_running);
      for (const Segment& segment : segments)
        one.hidden_starts += static_cast<int>(rollout->hidden_starts(segment).size());
    });
    attempt.reference.as_configured = scored(model_);
    attempt.reference.recalibrated = scored(attempt.recalibrated);
  }

  const Posing& posing_;
  const Model& model_;
  const Options& options_;
  const Catalogue& catalogue_;
  const std::vector<Inputs>& train_;
  const std::vector<Inputs>& held_out_;
  const std::vector<plant::SubmodelName> suspects_;
};

}  // namespace thermopower::gap::engine
