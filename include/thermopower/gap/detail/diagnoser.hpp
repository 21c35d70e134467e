// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/check.hpp>
#include <thermopower/gap/detail/enough_data.hpp>
#include <thermopower/gap/localise/localisation.hpp>
#include <thermopower/gap/localise/occurrence.hpp>
#include <thermopower/gap/localise/own_plant.hpp>
#include <thermopower/gap/fit/axis_averaging.hpp>
#include <thermopower/gap/fit/overlooked.hpp>
#include <thermopower/gap/options.hpp>
#include <thermopower/gap/report/fit_noise.hpp>
#include <thermopower/gap/report/held_out_predictions.hpp>
#include <thermopower/gap/report/last_fit.hpp>
#include <thermopower/gap/report/opposites.hpp>
#include <thermopower/gap/report/parts.hpp>
#include <thermopower/gap/report/score.hpp>
#include <thermopower/gap/fit/segment_choice.hpp>
#include <thermopower/gap/fit/short_windows.hpp>
#include <thermopower/gap/fit/single_causes.hpp>
#include <thermopower/gap/simulate.hpp>
#include <thermopower/gap/data/splitting.hpp>
#include <thermopower/gap/fit/thinning.hpp>
#include <thermopower/gap/decide/places_left.hpp>
#include <thermopower/gap/decide/verdict.hpp>

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>
#include <vector>

namespace thermopower::gap::engine {

/// One diagnosis under way.
class Diagnoser {
public:
  Diagnoser(const Model& model, const Options& options, const Catalogue& catalogue)
      : model_(model), options_(options), catalogue_(catalogue_of(model, catalogue)) {
    options.validate();
    if (const auto problem = model.validate()) throw InvalidInput("model '" + model.name + "': " + *problem);
  }

  Diagnosis run(const std::vector<Recording>& train, const std::vector<Recording>& held_out) {
    gather(train, held_out);
    stage("data gate");
    if (!enough_data(result_, model_, train_inputs_, held_out_inputs_, options_.horizon_s))
      return std::move(result_);
    Localisation found;
    if (model_.own) localise_own_plant(model_, catalogue_, train_inputs_, found);
    else found = localise(model_, train_recordings_, {}, catalogue_);
    if (!model_.own) add_occurrences(model_, train_recordings_, held_out_recordings_, {}, catalogue_, found);
    result_.where = std::move(found.where);
    result_.missing_quantities = std::move(found.quantities);
    stage("where");
    Attempt attempt = thorough_search(fit_horizon_s());
    if (train_inputs_.front().axis() && options_.horizon_s < fit_horizon_s() &&
        best_noise_multiple(attempt) > decision.far_for_long_windows) {
      // Over long windows small errors can send the axis into the next dip of a load: short ones forgive
      // that.
      Attempt shorter = search(options_.horizon_s);
      if (best_noise_multiple(shorter) < decision.short_windows_lower * best_noise_multiple(attempt))
        attempt = std::move(shorter);
    }
    stage("which");
    const Witness rows{[this](const Candidate& known, const plant::SubmodelName& submodel) {
                         return is_blamed(known, submodel);
                       },
                       [this](const Candidate& known) { return own_course_in(left_.beside(known)); },
                       result_.where, [this](const Candidate& known) { return left_.beside(known); },
                       [this](const Candidate& set) {
                         return are_opposites(augmented(model_, set.explanation, set.list, set.fit.point),
                                              set.explanation.ids(model_), judged_segments(held_out_inputs_),
                                              catalogue_);
                       }};
    Conclusion conclusion =
        conclude(attempt.candidates, attempt.reference, attempt.weight, options_, model_, rows);
    if (conclusion.second_is_open) {
      // What is left looks a little like several effects: it is named as a rest.
      std::vector<Candidate>& all = attempt.candidates;
      all.erase(std::remove_if(all.begin(), all.end(),
                               [](const Candidate& one) { return one.explanation.effects.size() > 1; }),
                all.end());
      weigh(all, attempt.weight, model_);
      conclusion = conclude(all, attempt.reference, attempt.weight, options_, model_, rows);
    }
    if (conclusion.verdict != Verdict::no_gap && constants_suffice(attempt, conclusion))
      conclusion = nothing_missing();
    report(attempt, conclusion);
    stage("how far");
    return std::move(result_);
  }

private:
  /// A search with windows of one length.
  struct Attempt {
    double horizon_s = 0.0;    ///< length of the windows
    FitProblem problem;        ///< of training data
    std::vector<Segment> all;  ///< what it has a part of
    std::vector<Candidate> candidates;
    Weight weight;
    Reference reference;
    Model recalibrated;  ///< the model with its constants refitted
  };

  /// Whether the model, its constants within their slack, scores what the noise allows on the data in full.
  /// The search looks at averages of many rows: what shows there may be too small for anybody to care. And
  /// training data over a narrow range leave constants open that the held-out data ask for: what fits both
  /// will do. Where constants are the answer, the model must hold as it is configured.
  bool constants_suffice(const Attempt& attempt, const Conclusion& conclusion) {
    const Candidate& empty = attempt.candidates.front();
    // What an explanation leaves may be less than rows tell of their noise. Where nothing explains, what the best of the
    // explanations leaves is no noise.
    const FitProblem* witness = conclusion.verdict == Verdict::unexplained ? nullptr : &attempt.problem;
    const auto is_enough = [&](const Model& model, const std::vector<Inputs>& inputs, bool chance) {
      return is_within_noise(model, inputs, witness, options_.horizon_s, catalogue_, false, chance);
    };
    // Where something explains what is left, that is a witness of it; else noise that remembers may be all of it, where
    // both parts say so: a few readings alone may be anything by chance.
    const bool chance = witness == nullptr;
    const auto fit_both_parts = [&](const Model& model) {
      return is_enough(model, held_out_inputs_, chance) && is_enough(model, train_inputs_, chance);
    };
    // Such windows may be longer than those that a gap is judged in: what holds in these as it is configured has none.
    if (largest_noise_multiple(empty) > decision.far_from_noise)
      return conclusion.verdict == Verdict::unexplained && fit_both_parts(model_);
    // A gap is measured on held-out data. Where they show none, what nothing explains is the training data's own.
    if (conclusion.verdict == Verdict::unexplained &&
        is_within_noise(model_, held_out_inputs_, nullptr, options_.horizon_s, catalogue_, true))
      return true;
    if (conclusion.chosen != 0 && attempt.candidates[conclusion.chosen].explanation.effects.empty())
      return fit_both_parts(model_);
    const bool is_cause = conclusion.verdict == Verdict::explained &&
                          are_dearer(empty, attempt.candidates[conclusion.chosen], model_);
    if (is_cause) return fit_both_parts(model_);
    const Model constants = augmented(model_, empty.explanation, empty.list, empty.fit.point);
    if (is_enough(constants, held_out_inputs_, false) || (chance && fit_both_parts(constants))) return true;
    // Where the training data are rough they leave constants open that the held-out data tell: what those ask for may do for both.
    std::vector<Inputs> all = train_inputs_;
    all.insert(all.end(), held_out_inputs_.begin(), held_out_inputs_.end());
    return fit_both_parts(refitted_to(all, attempt)) ||
           (chance && fit_both_parts(refitted_to(held_out_inputs_, attempt)));
  }

  /// The model with its constants, within their slack, fitted to some data; they begin where the search left them.
  Model refitted_to(const std::vector<Inputs>& inputs, const Attempt& attempt) {
    FitProblem problem =
        problem_of(inputs, search_extent.fitted_bench_rows, search_extent.fitted_axis_rows, fit_horizon_s());
    problem.sigma = attempt.problem.sigma;
    problem.correlation = attempt.problem.correlation;
    const Candidate first = Attribution(problem).fit({}, {}, &attempt.candidates.front());
    measure_noise(problem, first, inputs);
    const Candidate fitted = Attribution(problem).fit({}, {}, &first);
    return augmented(model_, fitted.explanation, fitted.list, fitted.fit.point);
  }

  /// Whether an explanation leaves no more than noise in the windows of its fit and, as a gap is judged, lowers it on
  /// the data it was fitted to. Rough motion that no window follows looks like noise in the first.
  bool does_for_now(const Candidate& one) const {
    constexpr double room = decision.room_for_costly, lowered = decision.lowered_without_costly;
    if (!one.train.within(room * room)) return false;
    if (one.explanation.effects.empty()) return true;
    const std::vector<Segment> segments = judged_segments(train_inputs_);
    const Errors before = errors_of(model_, segments, catalogue_),
                 after = errors_of(augmented(model_, one.explanation, one.list, one.fit.point), segments,
                                   catalogue_);
    for (int i = 0; i < signal_count; ++i)
      if (after.rms(static_cast<Signal>(i)) < lowered * before.rms(static_cast<Signal>(i))) return true;
    return false;
  }

  static double best_noise_multiple(const Attempt& attempt) {
    return largest_noise_multiple(Search::best(attempt.candidates));
  }

  void gather(const std::vector<Recording>& train, const std::vector<Recording>& held_out) {
    if (train.empty()) throw InvalidInput("there is no recording to train on");
    std::vector<Recording> first = train, last = held_out;
    if (held_out.empty())
      for (Recording& one : first) {
        if (const auto problem = one.validate())
          throw InvalidInput("recording '" + one.name + "': " + *problem);
        auto parts = split(one, options_.held_out_fraction);
        one = std::move(parts.first);
        last.push_back(std::move(parts.second));
      }
    CheckedRecordings checked = check(model_, std::move(first), std::move(last),
                                      {options_.horizon_s, options_.as_recorded}, catalogue_);
    result_.findings = std::move(checked.findings);
    for (PreparedRecording& one : checked.train) {
      train_recordings_.push_back(std::move(one).take_recording());
      train_inputs_.push_back(std::move(one).take_inputs());
    }
    for (PreparedRecording& one : checked.held_out) {
      held_out_rows_.push_back(rows_as_given(one));
      held_out_recordings_.push_back(std::move(one).take_recording());
      held_out_inputs_.push_back(std::move(one).take_inputs());
    }
    std::vector<const Inputs*> all;
    for (const auto* part : {&train_inputs_, &held_out_inputs_})
      for (const Inputs& one : *part) all.push_back(&one);
    result_.not_judged = not_judged_in(all);
    result_.augmented = result_.recalibrated = model_;
  }

  /// The thinned data of a fit. @param all  receives what it is a part of
  FitProblem problem_of(const std::vector<Inputs>& inputs, Eigen::Index bench_rows, Eigen::Index axis_rows,
                        double horizon_s, const std::vector<std::size_t>& also = {},
                        std::vector<Segment>* all = nullptr, Eigen::Index together = 1) {
    auto thin = std::make_shared<std::vector<Inputs>>();
    for (const Inputs& one : inputs) {
      const Eigen::Index share = std::max<Eigen::Index>(
          300, bench_rows * one.rows() / std::max<Eigen::Index>(1, total_rows(inputs)));
      if (one.axis()) thin->push_back(one.bench() ? one : AxisAveraging(one).run(options_.horizon_s));
      else thin->push_back(one.bench() ? thinned_bench(one, share, model_, catalogue_) : one);
    }
    FitProblem problem;
    problem.model = &model_;
    problem.catalogue = &catalogue_;
    problem.stop = options_.stop;
    std::vector<Segment> segments = cut(*thin, horizon_s, plant_of(model_));
    problem.segments = thinned_axis(segments, axis_rows, also, together);
    if (all != nullptr) *all = std::move(segments);
    kept_.push_back(std::move(thin));
    return problem;
  }

  /// Long windows tell more than the short ones of the score; the short ones keep a bad model near the data.
  double fit_horizon_s() const { return std::max(search_extent.fitted_window_s, options_.horizon_s); }

  /// A search, and another one with what the first overlooked.
  Attempt thorough_search(double horizon_s) {
    std::vector<std::size_t> worst;
    Attempt attempt = search(horizon_s, {}, &worst);
    if (worst.empty()) worst = overlooked_by(attempt);
    return worst.empty() ? attempt : search(horizon_s, worst);
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
                 std::vector<std::size_t>* worst = nullptr) {
    Attempt attempt;
    attempt.horizon_s = horizon_s;
    constexpr Eigen::Index together = search_extent.windows_together;
    FitProblem& problem = attempt.problem =
        problem_of(train_inputs_, search_extent.fitted_bench_rows, search_extent.fitted_axis_rows, horizon_s,
                   also, &attempt.all, together);
    const double short_s = std::min(search_extent.tried_window_s, options_.horizon_s);
    FitProblem longer_problem =
        problem_of(train_inputs_, search_extent.tried_bench_rows, search_extent.tried_axis_rows, short_s,
                   short_s == horizon_s ? also : std::vector<std::size_t>(), nullptr, together);
    longer_problem.segments = thinned_runs(longer_problem.segments, search_extent.tried_bench_rows);
    FitProblem coarse_problem = longer_problem;
    FitProblem glimpse_problem = longer_problem;
    const double shortest_s = shortest_window_s(model_, catalogue_, train_inputs_, short_s);
    if (shortest_s < short_s) {
      const auto shortest = [&](Eigen::Index rows) {
        return thinned_runs(
            problem_of(train_inputs_, search_extent.tried_bench_rows, rows, shortest_s).segments,
            search_extent.tried_bench_rows);
      };
      coarse_problem.segments = shortest(search_extent.shortest_axis_rows);
      glimpse_problem.segments = shortest(search_extent.glimpsed_axis_rows);
    }
    std::vector<Candidate>& candidates = attempt.candidates;
    const Attribution glimpse(glimpse_problem), coarse(coarse_problem, glimpse_problem),
        longer(longer_problem), fine(problem);
    for (int round = 0; round < 2; ++round) measure_noise(longer_problem, longer.fit({}, {}), train_inputs_);
    problem.sigma = glimpse_problem.sigma = coarse_problem.sigma = longer_problem.sigma;
    const bool in_short_windows = shortest_s < short_s;
    const Search searching(in_short_windows ? glimpse : coarse, coarse, in_short_windows ? longer : coarse,
                           fine, options_.threads, suspects_among(result_.where));
    std::vector<Explanation> causes, costly;
    for (Explanation& one : single_causes(model_, catalogue_, options_.without, train_inputs_)) {
      const bool is_costly = !one.effects.empty() && one.effects.front()->info.costly;
      (is_costly ? costly : causes).push_back(std::move(one));
    }
    candidates = searching.run_singles(with_pairs_of_constants(causes));
    const auto renew = [&] {
      measure_noise(problem, Search::best(candidates), train_inputs_);
      glimpse_problem.sigma = coarse_problem.sigma = longer_problem.sigma = problem.sigma;
      problem.correlation = mean_correlation(correlation_of(Search::best(candidates), problem));
      searching.renew(candidates);
    };
    renew();
    const auto add_costly = [&] {
      searching.add_singles(candidates, costly);
      causes.insert(causes.end(), costly.begin(), costly.end());
      costly.clear();
      renew();
    };
    if (!costly.empty() && !does_for_now(Search::best(candidates))) add_costly();
    if (searching.refine_shapes(candidates)) renew();
    if (searching.look_beside(candidates, decision.room_for_sets)) renew();
    if (worst != nullptr && !(*worst = overlooked_by(attempt)).empty()) return attempt;
    if (options_.effects_at_once > 1) {
      // Constants move in every explanation: only effects are joined.
      std::vector<Explanation> effects;
      for (const Explanation& one : causes)
        if (!one.effects.empty()) effects.push_back(one);
      searching.run_sets(candidates, effects, options_.effects_at_once, decision.room_for_sets);
      renew();
      if (searching.refine_shapes(candidates)) renew();
    }
    const auto decide = [&] {
      searching.refit_rivals(candidates);
      name_moved_constants(candidates, model_);
      attempt.weight = correlation_of(Search::best(candidates), problem);
      attempt.weight.shown = shown_by(train_inputs_);
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

  /// Whether the measured rows say that something is missing in a submodel, as they are or beside known causes. A plant
  /// of one's own need not say where.
  bool is_blamed(const Candidate& known, const plant::SubmodelName& submodel) {
    const auto among = [&](const std::vector<Location>& where) {
      return std::any_of(where.begin(), where.end(),
                         [&](const Location& one) { return one.submodel == submodel; });
    };
    return model_.own || among(result_.where) || among(left_.beside(known));
  }

  /// Whether nothing that has a course of its own in time is missing once the causes of a candidate are in the model. A node
  /// that nobody measures can hold whatever heat is missing: a balance with one says nothing.
  bool ends_its_course(const Candidate& chosen) {
    return !model_.own && chosen.hidden_starts == 0 && own_course_in(left_.beside(chosen)) == 0.0;
  }

  /// The model with its constants refitted: the best explanation by constants alone, or as configured where that
  /// scores better on the very data.
  Model recalibrate(std::vector<Candidate>& candidates, const Attribution& fine) const {
    Candidate* best = &candidates.front();
    for (Candidate& one : candidates)
      if (one.explanation.effects.empty() && Search::fitness(one) < Search::fitness(*best)) best = &one;
    fine.polish(*best, {});
    const Model fitted = augmented(model_, best->explanation, best->list, best->fit.point);
    const std::vector<Segment> segments = judged_segments(train_inputs_);
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

  /// Segments as a gap is judged, few enough to judge many explanations on.
  std::vector<Segment> judged_segments(const std::vector<Inputs>& inputs) const {
    return thinned_axis(cut(inputs, options_.horizon_s, plant_of(model_)), search_extent.judged_rows);
  }

  /// Scores the empty explanation, those by constants alone, and the best ones on held-out data, as a gap is
  /// judged. The others are out of the running.
  void judge(Attempt& attempt, const Attribution& fine) const {
    std::vector<Candidate>& candidates = attempt.candidates;
    for (Candidate& one : candidates) {
      one.held_out = {};
      one.hidden_starts = 0;
    }
    const std::vector<Segment> segments = judged_segments(held_out_inputs_);
    const auto model_of = [&](const Candidate& one) {
      return augmented(model_, one.explanation, one.list, one.fit.point);
    };
    const Model best = model_of(Search::best(candidates));
    const Model& witness = follows_its_data(Search::best(candidates)) ? best : model_;
    const Errors errors = errors_of(best, segments, catalogue_);
    const std::array<double, signal_count> sigma = noise_of(errors, segments, held_out_inputs_),
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
    for (std::size_t place = 0; place < order.size(); ++place) {
      const Explanation& one = candidates[order[place]].explanation;
      const bool among_singles = one.size() == 1 && single++ < 7;
      const bool is_modest = std::find(modest.begin(), modest.end(), order[place]) != modest.end();
      if (place < 14 || among_singles || is_modest || one.effects.empty()) looked_at.push_back(order[place]);
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

  void report(Attempt& attempt, const Conclusion& conclusion) {
    std::vector<Candidate>& candidates = attempt.candidates;
    result_.verdict = conclusion.verdict;
    result_.reason = conclusion.reason;
    result_.none_of_these = conclusion.none_of_these;
    Candidate& chosen = candidates[conclusion.chosen];
    const bool named = conclusion.verdict == Verdict::explained || conclusion.verdict == Verdict::ambiguous ||
                       conclusion.verdict == Verdict::partial;
    Weight weight = correlation_of(chosen, attempt.problem);
    rank(result_, candidates, conclusion, attempt.problem, weight);
    if (named) fit_to_rows(result_, chosen, attempt.problem, train_inputs_, attempt.horizon_s, weight);
    const Model fitted = augmented(model_, chosen.explanation, chosen.list, chosen.fit.point);
    if (named) name_causes(result_, candidates, conclusion, model_, fitted, weight);
    result_.recalibrated = attempt.recalibrated;
    if (named) result_.augmented = fitted;
    const std::vector<Segment> full = cut(held_out_inputs_, options_.horizon_s, plant_of(model_));
    const std::vector<Rival> rivals = rivals_of(candidates, conclusion.chosen, model_);
    score(result_, model_, full, held_out_inputs_, fitted, follows_its_data(chosen), rivals, options_,
          catalogue_);
    const bool short_of_noise = constants_fall_short(result_);
    if (short_of_noise) take_causes_back(result_, model_, nothing_known(constants_leave_a_rest));
    note_recalibration(result_);
    const bool leaves_a_rest = admit_a_rest(result_) || (conclusion.leaves_a_rest && !deny_a_rest(result_));
    const bool unproven = named && take_back_the_unproven(result_, model_, chosen.explanation);
    const bool on_its_own = named && !unproven && leaves_a_rest &&
                            has_own_course(result_, chosen.explanation) && !ends_its_course(chosen);
    if (on_its_own) take_causes_back(result_, model_, nothing_known(follows_nothing_recorded));
    const bool taken_back = short_of_noise || unproven || on_its_own;
    if (named && leaves_a_rest && !taken_back)
      result_.remaining =
          remaining(result_, model_.own ? Localisation()
                                        : localise(result_.augmented, train_recordings_, {}, catalogue_));
    if (named && !taken_back) {
      std::vector<Recording> simulated = std::move(train_recordings_);
      for (Recording& one : simulated)
        for (SimulatedSignal& signal :
             simulate(result_.augmented, one, {SimulationMode::free_running, options_.horizon_s}, catalogue_))
          one.set(to_string(signal.signal), std::move(signal.values));
      if (model_.own) {
        std::vector<Inputs> inputs;
        for (const Recording& one : simulated) inputs.push_back(prepare(model_, one));
        draw_own_effect(model_, catalogue_, inputs, result_.missing_quantities);
      } else {
        draw_effect(model_, std::move(simulated), catalogue_, result_.missing_quantities);
      }
    }
    result_.next_experiment = next_experiment(result_, candidates, conclusion, model_, catalogue_);
    result_.predictions =
        predictions_of(model_, result_.augmented, full, held_out_inputs_, held_out_rows_, catalogue_);
  }

  void stage(const char* name) {
    const auto now = std::chrono::steady_clock::now();
    result_.timings.push_back({name, std::chrono::duration<double>(now - since_).count()});
    since_ = now;
  }

  const Model model_;
  const Options options_;
  const Catalogue& catalogue_;
  Diagnosis result_;
  std::vector<Recording> train_recordings_, held_out_recordings_;
  std::vector<Inputs> train_inputs_, held_out_inputs_;
  std::vector<RowsAsGiven> held_out_rows_;
  PlacesLeft left_{model_, train_recordings_, catalogue_};
  std::vector<std::shared_ptr<std::vector<Inputs>>> kept_;
  std::chrono::steady_clock::time_point since_ = std::chrono::steady_clock::now();
};

}  // namespace thermopower::gap::engine
