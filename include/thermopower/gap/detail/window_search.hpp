// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/compare/covariance.hpp>
#include <thermopower/gap/compare/search.hpp>
#include <thermopower/gap/compare/thresholds.hpp>
#include <thermopower/gap/compare/choice.hpp>
#include <thermopower/gap/compare/effort_lead.hpp>
#include <thermopower/gap/detail/as_judged.hpp>
#include <thermopower/gap/detail/attempt.hpp>
#include <thermopower/gap/detail/posing.hpp>
#include <thermopower/gap/fit/attribution.hpp>
#include <thermopower/gap/fit/segment_choice.hpp>
#include <thermopower/gap/fit/judgeable.hpp>
#include <thermopower/gap/compare/fit_noise.hpp>
#include <thermopower/gap/report/last_fit.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace thermopower::gap::engine {

/// One search for causes, in windows of one length: single causes, sets of them, and what they weigh. Call its steps in the
/// order in which they stand here.
class WindowSearch {
public:
  /// All of them must outlive this object.
  /// @param as_judged  scores what was found
  /// @param suspects   submodels in which the measured rows themselves say that something is missing
  /// @param horizon_s  length of the windows
  WindowSearch(const Posing& posing, const AsJudged& as_judged, const std::vector<Inputs>& train,
               const std::vector<plant::SubmodelName>& suspects, double horizon_s)
      : posing_(posing),
        options_(posing.options()),
        as_judged_(as_judged),
        train_(train),
        horizon_s_(horizon_s) {
    attempt_.problem = fitted();
    pose_first_looks();
    glimpse_.emplace(glimpse_problem_);
    coarse_.emplace(coarse_problem_, glimpse_problem_);
    longer_.emplace(longer_problem_);
    fine_.emplace(attempt_.problem);
    for (int round = 0; round < 2; ++round) measure_noise(longer_problem_, longer_->fit({}, {}), train_);
    set_noise(longer_problem_.sigma);
    const bool in_short_windows = shortest_s_ < short_s_;
    search_.emplace(in_short_windows ? *glimpse_ : *coarse_, *coarse_, in_short_windows ? *longer_ : *coarse_,
                    *fine_, options_.threads, suspects);
    for (Explanation& one : single_causes(posing.model(), posing.catalogue(), options_.without, train_)) {
      const EffectInfo* info = one.effects.empty() ? nullptr : &one.effects.front()->info;
      (info == nullptr || !info->costly ? causes_
       : info->curve                    ? curves_
                                        : costly_)
          .push_back(std::move(one));
    }
  }

  WindowSearch(const WindowSearch&) = delete;  // its parts refer to each other
  WindowSearch& operator=(const WindowSearch&) = delete;

  /// What it came to so far.
  const Attempt& attempt() const { return attempt_; }
  /// The same, to keep. The search is over then.
  Attempt take() { return std::move(attempt_); }

  /// Every single cause, but for those that cost much to simulate: they wait until sets of the others have been tried.
  void try_singles() {
    search_->add(attempt_.candidates, search_->try_singles(with_pairs_of_constants(causes_)));
    renew();
    if (options_.effects_at_once < 2 && !costly_.empty() && !does_for_now(attempt_.best())) add_late(costly_);
    look_closely();
  }

  /// Where averages leave the best explanation above the noise and the rows themselves do not, the rows are what is fitted to. So they
  /// are where it turns out to be a simpler one on the rows: averages of a drag that turns over bend a friction by direction.
  void look_at_rows() {
    constexpr double near = decision.near_floor;
    Candidate leader = attempt_.best();
    const bool is_far = !leader.train.within(near * near);
    const auto may_be_simpler = [](const CatalogueEntry* one) { return one->info.where_equal.has_value(); };
    const std::vector<const CatalogueEntry*>& effects = leader.explanation.effects;
    if (!is_averaged(attempt_.problem) ||
        (!is_far && std::none_of(effects.begin(), effects.end(), may_be_simpler)))
      return;
    const double hopeless = 2.0 * leader.fit.cost;
    FitProblem rows = fitted_to_rows(leader, attempt_.problem, train_, attempt_.horizon_s,
                                     search_extent.fitted_recorded_rows);
    if (!leader.train.within(near * near) || (!is_far && !has_special_case(leader, posing_.model()))) return;
    attempt_.problem = std::move(rows);
    search_->take_over(attempt_.candidates, hopeless);
    renew();
  }

  /// Sets of causes, and then those that cost much to simulate, alone and in sets, where there is room for them.
  void try_sets() {
    if (options_.effects_at_once < 2) return;
    if (!has_room()) renew();  // once more: what is weighed in the end has seen the noise of the best one
    const auto promising = [&](const std::vector<Explanation>& late) {
      return search_->promising().pairs(attempt_.candidates, effects(), late);
    };
    if (has_room()) {
      add_sets(promising({}));
      if (!costly_.empty() && !does_for_now(attempt_.best())) {
        const std::vector<Explanation> late = costly_;
        add_late(costly_);
        if (has_room()) add_sets(promising(late));
      }
    }
    if (search_->refine_shapes(attempt_.candidates)) renew();
    look_at_rows();
  }

  /// What the effort tells, from where it has it: its set may hold a cause that alone does nothing for the motion.
  void try_told(const InverseScore& told) {
    if (told.effects.empty() || told.effects.size() > static_cast<std::size_t>(options_.effects_at_once))
      return;
    const Candidate start = candidate_of(told, attempt_.problem);
    if (is_known(attempt_.candidates, start.explanation)) return;
    search_->add_whatever_the_room(attempt_.candidates, {{{0.0, {start.fit.point}}, 0, start.explanation}});
    renew();
  }

  /// Curves, beside everything that has a name: they could bend to what one or two named causes do, and say less. Where one
  /// named cause does, none is asked for; where two are needed, one curve may be the simpler answer.
  void try_curves() {
    if (curves_.empty() || (does_for_now(attempt_.best()) && attempt_.best().explanation.effects.size() < 2))
      return;
    const std::vector<Explanation> late = curves_;
    add_late(curves_);
    if (options_.effects_at_once > 1 && has_room())
      add_sets(search_->promising().pairs(attempt_.candidates, effects(), late));
  }

  /// Weighs what was found on held-out data.
  void decide() {
    const bool has_less_noise = leave_only_noise();
    look_beside_blows();
    if (has_less_noise && options_.effects_at_once > 1 && has_room())
      add_sets(search_->promising().pairs(attempt_.candidates, effects()));
    weigh_all();
  }

  /// Those that cost much to simulate, where what fits the data it was fitted to fails on others: that was a stand-in.
  void try_late() {
    constexpr double near = decision.near_floor;
    if ((costly_.empty() && curves_.empty()) || attempt_.best().held_out.within(near * near)) return;
    if (!costly_.empty()) add_late(costly_);
    if (!curves_.empty()) add_late(curves_);
    weigh_all();
  }

  /// Where single causes reach the noise with constants so far off that a second one could stand in their place: the likeliest of
  /// them with each further cause.
  void try_beside_dear_constants() {
    constexpr std::size_t tried = 3;
    if (options_.effects_at_once < 2 ||
        attempt_.candidates[likeliest(attempt_.candidates)].explanation.size() != 1)
      return;
    std::vector<Promise> sets;
    std::size_t found = 0;
    for (const std::size_t place : by_deviance(attempt_.candidates)) {
      const Candidate& one = attempt_.candidates[place];
      if (one.explanation.effects.size() != 1 || !in_the_running(one) ||
          largest_noise_multiple(one.held_out) > decision.near_floor ||
          !(price_of_constants(one, posing_.model()) > usual_rarity + decision.dear_constants))
        continue;
      if (++found > tried) break;
      for (Promise& set : search_->promising().with_each(attempt_.candidates, place, effects()))
        sets.push_back(std::move(set));
    }
    if (sets.empty()) return;
    add_sets(sets);
    weigh_all();
  }

  /// Where a pair is the likeliest explanation, does what a second cause has to, and leaves room for a third one: it with
  /// each further cause. A joint has its weight, its friction and its cogs at once.
  void try_third_causes() {
    if (options_.effects_at_once < 3) return;
    const std::size_t place =
        parsimonious(attempt_.candidates, likeliest(attempt_.candidates), posing_.model());
    const Candidate& pair = attempt_.candidates[place];
    if (pair.explanation.effects.size() != 2 || !has_room() ||
        largest_noise_multiple(pair.held_out) < decision.room_for_second)
      return;
    add_sets(search_->promising().with_each(attempt_.candidates, place, effects()));
    weigh_all();
  }

  /// Where a cause of the likeliest set has a simpler relative: the set with that one in its place. Beside a second cause
  /// nobody has tried it, and both may do the same there.
  void try_simpler_relatives() {
    const std::size_t place = likeliest(attempt_.candidates);
    const Explanation set = attempt_.candidates[place].explanation;
    if (set.effects.size() < 2) return;
    std::vector<Promise> sets;
    for (std::size_t near = 1; near < attempt_.candidates.size(); ++near) {
      const Explanation& one = attempt_.candidates[near].explanation;
      if (one.effects.size() != 1 || set.includes(one)) continue;
      Explanation simpler = one;
      for (const CatalogueEntry* entry : set.effects)
        if (!entry->info.where_equal || entry->info.where_equal->cause != one.effects.front()->info.id)
          simpler.effects.push_back(entry);
      if (simpler.effects.size() == set.effects.size() && !is_known(attempt_.candidates, simpler))
        sets.push_back({{}, near, simpler});
    }
    if (sets.empty()) return;
    add_sets(sets);
    weigh_all();
  }

  /// Whether the best explanation leaves room for a further cause.
  bool has_room() const { return !attempt_.best().train.within(decision.room_for_sets); }

private:
  /// Single effects that may act together. Constants move in every explanation.
  std::vector<Explanation> effects() const {
    std::vector<Explanation> some;
    for (const Explanation& one : causes_)
      if (!one.effects.empty()) some.push_back(one);
    return some;
  }

  /// @param sets  the most promising one first
  void add_sets(const std::vector<Promise>& sets) {
    search_->add_sets(attempt_.candidates, sets);
    renew();
  }

  /// What explanations are fitted to in the end.
  FitProblem fitted() {
    Posing::Extent extent = posing_.fitted(horizon_s_);
    extent.together = search_extent.windows_together;
    attempt_.horizon_s = horizon_s_;
    return posing_.pose(train_, extent);
  }

  /// What they are first tried on.
  void pose_first_looks() {
    constexpr Eigen::Index bench_rows = search_extent.tried_bench_rows;
    const auto pose = [&](const Posing::Extent& extent) {
      FitProblem posed = posing_.pose(train_, extent);
      posed.segments = thinned_runs(posed.segments, bench_rows);
      return posed;
    };
    short_s_ = std::min({search_extent.tried_window_s, options_.horizon_s, horizon_s_});
    longer_problem_ =
        pose({short_s_, bench_rows, search_extent.tried_axis_rows, search_extent.windows_together});
    coarse_problem_ = glimpse_problem_ = longer_problem_;
    shortest_s_ = shortest_window_s(posing_.model(), posing_.catalogue(), train_, short_s_);
    if (!(shortest_s_ < short_s_)) return;
    coarse_problem_ = pose({shortest_s_, bench_rows, search_extent.shortest_axis_rows, 1});
    glimpse_problem_ = pose({shortest_s_, bench_rows, search_extent.glimpsed_axis_rows, 1});
  }

  void set_noise(const std::array<double, signal_count>& sigma) {
    attempt_.problem.sigma = glimpse_problem_.sigma = coarse_problem_.sigma = longer_problem_.sigma = sigma;
  }

  /// The noise is what the best explanation leaves; then all are looked at anew.
  void renew() {
    const std::array<double, signal_count> before = attempt_.problem.sigma;
    attempt_.problem.sigma = noise_left(attempt_.problem, attempt_.best(), train_, taken_for_noise_);
    std::array<double, signal_count> by;
    for (std::size_t i = 0; i < signal_count; ++i) by[i] = before[i] / attempt_.problem.sigma[i];
    set_noise(attempt_.problem.sigma);
    attempt_.problem.correlation = mean_correlation(correlation_of(attempt_.best(), attempt_.problem));
    search_->renew(attempt_.candidates, by);
  }

  /// Blows that an explanation misses a little look like noise that remembers, in each signal. While a search is far from them
  /// that is as well: it follows the motion between them. Where the best explanation strikes, and has found what it can, what
  /// angle and rate show alike is no noise any more. Beside any other, what is missed may have any cause, and counts for as little as
  /// noise does. @return whether that made a difference
  bool leave_only_noise() {
    if (!attempt_.best().explanation.strikes()) return false;
    constexpr double matters = 1.25;  // times the noise
    const std::array<double, signal_count> less =
        noise_left(attempt_.problem, attempt_.best(), train_, TakenForNoise::what_differs);
    bool is_less = false;
    for (std::size_t i = 0; i < signal_count; ++i) is_less |= attempt_.problem.sigma[i] > matters * less[i];
    if (!is_less) return false;
    taken_for_noise_ = TakenForNoise::what_differs;
    renew();
    return true;
  }

  /// Where the best explanation strikes, looks for a deeper hollow beside that in which its fit ended, as long as there is one.
  void look_beside_blows() {
    constexpr int times = 4;
    constexpr double deeper = 0.98;  // of the cost
    for (int i = 0; i < times; ++i) {
      const auto best = static_cast<std::size_t>(&attempt_.best() - attempt_.candidates.data());
      const std::vector<Eigen::VectorXd> places = places_beside(attempt_.candidates[best]);
      if (places.empty()) return;
      Candidate beside = fine_->fit_from(attempt_.candidates[best].explanation, places, {});
      if (!(beside.fit.cost < deeper * attempt_.candidates[best].fit.cost)) return;
      attempt_.candidates[best] = std::move(beside);
      renew();
    }
  }

  /// Takes causes that waited among those that are tried.
  void add_late(std::vector<Explanation>& waiting) {
    search_->add(attempt_.candidates, search_->try_further(waiting, attempt_.candidates));
    causes_.insert(causes_.end(), waiting.begin(), waiting.end());
    waiting.clear();
    renew();
  }

  void look_closely() {
    if (search_->refine_shapes(attempt_.candidates)) renew();
  }

  void weigh_all() {
    search_->settle_constants(attempt_.candidates, posing_.model());
    search_->refit_rivals(attempt_.candidates);
    name_moved_constants(attempt_.candidates, posing_.model());
    attempt_.weight = correlation_of(attempt_.best(), attempt_.problem);
    attempt_.weight.shown = shown_by(train_);
    attempt_.recalibrated = as_judged_.recalibrate(attempt_.candidates, *fine_);
    as_judged_.judge(attempt_, *fine_);
    mark_doubtful(attempt_.candidates, posing_.model(), attempt_.weight);
    weigh(attempt_.candidates, attempt_.weight, posing_.model());
  }

  /// Whether an explanation leaves no more than noise in the windows of its fit and, as a gap is judged, lowers it on
  /// the data it was fitted to. Rough motion that no window follows looks like noise in the first.
  bool does_for_now(const Candidate& one) const {
    constexpr double room = decision.room_for_costly;
    return one.train.within(room * room) && (one.explanation.effects.empty() || as_judged_.lowers(one));
  }

  const Posing& posing_;
  const Options& options_;
  const AsJudged& as_judged_;
  const std::vector<Inputs>& train_;
  double horizon_s_;

  double short_s_ = 0.0;     ///< of the windows of the first look
  double shortest_s_ = 0.0;  ///< of those in which friction that holds and lets go is nearly linear
  FitProblem glimpse_problem_, coarse_problem_, longer_problem_;
  std::optional<Attribution> glimpse_, coarse_, longer_, fine_;  ///< once the problems are posed
  std::optional<Search> search_;
  std::vector<Explanation> causes_, costly_, curves_;  ///< those that are tried, and those that wait
  TakenForNoise taken_for_noise_ = TakenForNoise::what_looks_like_it;
  Attempt attempt_;
};

}  // namespace thermopower::gap::engine
