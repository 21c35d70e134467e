// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/check.hpp>
#include <thermopower/gap/detail/cause_search.hpp>
#include <thermopower/gap/detail/enough_data.hpp>
#include <thermopower/gap/detail/posing.hpp>
#include <thermopower/gap/fit/curve_ranges.hpp>
#include <thermopower/gap/localise/localisation.hpp>
#include <thermopower/gap/localise/occurrence.hpp>
#include <thermopower/gap/localise/own_plant.hpp>
#include <thermopower/gap/options.hpp>
#include <thermopower/gap/report/held_out_predictions.hpp>
#include <thermopower/gap/report/last_fit.hpp>
#include <thermopower/gap/report/opposites.hpp>
#include <thermopower/gap/report/parts.hpp>
#include <thermopower/gap/report/runaway.hpp>
#include <thermopower/gap/report/score.hpp>
#include <thermopower/gap/simulate.hpp>
#include <thermopower/gap/data/splitting.hpp>
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
    Attempt attempt = CauseSearch(posing_, train_inputs_, held_out_inputs_, result_.where).run();
    stage("which");
    const Witness rows{[this](const Candidate& known, const plant::SubmodelName& submodel) {
                         return is_blamed(known, submodel);
                       },
                       [this](const Candidate& known) { return own_course_in(left_.beside(known)); },
                       result_.where, [this](const Candidate& known) { return left_.beside(known); },
                       [this](const Candidate& set) {
                         return are_opposites(augmented(model_, set.explanation, set.list, set.fit.point),
                                              set.explanation.ids(model_), posing_.judged(held_out_inputs_),
                                              catalogue_);
                       }};
    Conclusion conclusion =
        conclude(attempt.candidates, attempt.reference, attempt.weight, options_, model_, rows);
    if (attempt.in_pairs != nullptr && !is_found_by_a_third(attempt, conclusion)) {
      attempt = Attempt(*attempt.in_pairs);
      conclusion = conclude(attempt.candidates, attempt.reference, attempt.weight, options_, model_, rows);
    }
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
  /// Whether causes are named that only the look for a third one has found: three of them, or a pair that was passed over. What
  /// is said of others does not depend on that look.
  static bool is_found_by_a_third(const Attempt& attempt, const Conclusion& conclusion) {
    const Explanation& found = attempt.candidates[conclusion.chosen].explanation;
    const bool is_named = conclusion.verdict != Verdict::unexplained && !conclusion.second_is_open;
    return is_named && !is_known(attempt.in_pairs->candidates, found) &&
           !(conclusion.leaves_a_rest && are_of_one_place(found));
  }

  /// Whether there are three causes or more and all of one submodel: spring, weight and cogs are together nearly any load that goes
  /// with the angle, such as an end stop.
  static bool are_of_one_place(const Explanation& found) {
    const auto same = [&](const CatalogueEntry* one) {
      return one->info.submodel == found.effects.front()->info.submodel;
    };
    return found.effects.size() > 2 && std::all_of(found.effects.begin(), found.effects.end(), same);
  }

  /// Whether the model, its constants within their slack, scores what the noise allows on the data in full.
  /// The search looks at averages of many rows: what shows there may be too small for anybody to care. And
  /// training data over a narrow range leave constants open that the held-out data ask for: what fits both
  /// will do. Where constants are the answer, the model must hold as it is configured.
  bool constants_suffice(const Attempt& attempt, const Conclusion& conclusion) {
    const Candidate& empty = attempt.candidates.front();
    // What an explanation leaves may be less than rows tell of their noise. Where nothing explains, what the best of the
    // explanations leaves is no noise.
    const FitProblem* witness = conclusion.verdict == Verdict::unexplained ? nullptr : &attempt.problem;
    // Where something explains what is left, that is a witness of it; else noise that remembers may be all of it, where
    // both parts say so: a few readings alone may be anything by chance.
    const bool chance = witness == nullptr && !follows_the_motion();
    const auto fit_both_parts = [&](const Model& model) {
      return is_within_noise_of_both_parts(model, witness, chance);
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
    if (is_within_noise(constants, held_out_inputs_, witness, options_.horizon_s, catalogue_) ||
        (chance && fit_both_parts(constants)))
      return true;
    // Where the training data are rough they leave constants open that the held-out data tell: what those ask for may do for both.
    std::vector<Inputs> all = train_inputs_;
    all.insert(all.end(), held_out_inputs_.begin(), held_out_inputs_.end());
    return fit_both_parts(refitted_to(all, attempt)) ||
           (chance && fit_both_parts(refitted_to(held_out_inputs_, attempt)));
  }

  /// Whether a model scores what the noise allows on held-out and training data, see is_within_noise().
  bool is_within_noise_of_both_parts(const Model& model, const FitProblem* witness, bool chance) const {
    const auto is_within = [&](const std::vector<Inputs>& part) {
      return is_within_noise(model, part, witness, options_.horizon_s, catalogue_, false, chance);
    };
    return is_within(held_out_inputs_) && is_within(train_inputs_);
  }

  /// Whether what is missing is mostly a torque that goes with rate or angle on rows it was not fitted to. Noise that remembers is
  /// taken for a drive or a structure, that have an acceleration of their own, and knows of no rate.
  bool follows_the_motion() const {
    constexpr double mostly = 0.5;
    if (result_.where.empty() || result_.where.front().share < mostly) return false;
    const plant::SubmodelName& place = result_.where.front().submodel;
    return place == plant::Submodel::mechanical_friction || place == plant::Submodel::mechanical_load;
  }

  /// Whether noise that remembers may be all that some constants within their slack leave of both parts: where no cause is
  /// believed, and a few readings may be anything by chance.
  bool suffice_by_chance(const Attempt& attempt) {
    const auto may_be_noise = [&](const Model& model) {
      return is_within_noise_of_both_parts(model, nullptr, true);
    };
    const Candidate& empty = attempt.candidates.front();
    if (largest_noise_multiple(empty) > decision.far_from_noise || follows_the_motion()) return false;
    return may_be_noise(model_) ||
           may_be_noise(augmented(model_, empty.explanation, empty.list, empty.fit.point)) ||
           may_be_noise(refitted_to(held_out_inputs_, attempt));
  }

  /// The model with its constants, within their slack, fitted to some data; they begin where the search left them.
  Model refitted_to(const std::vector<Inputs>& inputs, const Attempt& attempt) {
    FitProblem problem = posing_.pose(inputs, posing_.fitted(posing_.long_window_s()));
    problem.sigma = attempt.problem.sigma;
    problem.correlation = attempt.problem.correlation;
    const Candidate first = Attribution(problem).fit({}, {}, &attempt.candidates.front());
    measure_noise(problem, first, inputs);
    const Candidate fitted = Attribution(problem).fit({}, {}, &first);
    return augmented(model_, fitted.explanation, fitted.list, fitted.fit.point);
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
    support_curves(catalogue_, model_, train_inputs_);
    std::vector<const Inputs*> all;
    for (const auto* part : {&train_inputs_, &held_out_inputs_})
      for (const Inputs& one : *part) all.push_back(&one);
    result_.not_judged = not_judged_in(all);
    result_.augmented = result_.recalibrated = model_;
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
    if (result_.reason == constants_leave_a_rest) note_moved_constants(result_, model_, result_.recalibrated);
    note_recalibration(result_);
    const bool leaves_a_rest = admit_a_rest(result_) || (conclusion.leaves_a_rest && !deny_a_rest(result_));
    const bool unproven = named && take_back_the_unproven(result_, model_, chosen.explanation);
    const bool on_its_own = named && !unproven && leaves_a_rest &&
                            !leaves_little(result_, decision.may_leave_a_course) &&
                            has_own_course(result_, chosen.explanation) && !ends_its_course(chosen);
    if (on_its_own) take_causes_back(result_, model_, nothing_known(follows_nothing_recorded));
    // Rows as recorded may tell less than the averages that were searched.
    const bool of_any_size = named && !unproven && !on_its_own && may_be_anything(chosen, model_, weight);
    if (of_any_size) take_causes_back(result_, model_, nothing_known(may_be_of_any_size));
    const bool taken_back = short_of_noise || unproven || on_its_own || of_any_size;
    if (taken_back && result_.verdict == Verdict::unexplained && suffice_by_chance(attempt))
      take_causes_back(result_, model_, nothing_missing());
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
    take_back_a_runaway(result_, model_);
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
  Catalogue catalogue_;  ///< its curves have the range of the data
  const Posing posing_{model_, options_, catalogue_};
  Diagnosis result_;
  std::vector<Recording> train_recordings_, held_out_recordings_;
  std::vector<Inputs> train_inputs_, held_out_inputs_;
  std::vector<RowsAsGiven> held_out_rows_;
  PlacesLeft left_{model_, train_recordings_, catalogue_};
  std::chrono::steady_clock::time_point since_ = std::chrono::steady_clock::now();
};

}  // namespace thermopower::gap::engine
