// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/check.hpp>
#include <thermopower/gap/compare/choice.hpp>
#include <thermopower/gap/compare/effort_lead.hpp>
#include <thermopower/gap/compare/fewest_constants.hpp>
#include <thermopower/gap/compare/verdict_table.hpp>
#include <thermopower/gap/detail/cause_search.hpp>
#include <thermopower/gap/detail/enough_data.hpp>
#include <thermopower/gap/detail/posing.hpp>
#include <thermopower/gap/detail/power_between_rows.hpp>
#include <thermopower/gap/fit/curve_ranges.hpp>
#include <thermopower/gap/where/localisation.hpp>
#include <thermopower/gap/where/occurrence.hpp>
#include <thermopower/gap/options.hpp>
#include <thermopower/gap/report/held_out_predictions.hpp>
#include <thermopower/gap/report/last_fit.hpp>
#include <thermopower/gap/report/parts.hpp>
#include <thermopower/gap/compare/score.hpp>
#include <thermopower/gap/simulate.hpp>
#include <thermopower/gap/observe/heater_duty.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <optional>
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
    stage("checking the recordings");
    gather(train, held_out);
    if (!enough_data(result_, model_, train_inputs_, held_out_inputs_, options_.horizon_s)) {
      end_stage();
      return std::move(result_);
    }
    stage("finding where simulation and recordings part");
    Localisation found = localise(model_, train_recordings_, catalogue_);
    if (!model_.own) add_occurrences(model_, train_recordings_, held_out_recordings_, catalogue_, found);
    result_.where = std::move(found.where);
    result_.missing_quantities = std::move(found.quantities);
    stage("weighing causes");
    if (model_.axis && !model_.own) {
      effort_.emplace(model_, catalogue_, train_inputs_, held_out_inputs_, options_.without);
      result_.loop = to_string(effort_->loop());
    }
    // Where a target is recorded the loop is known to be closed: motion tells next to nothing, and no search is needed.
    if (effort_is_measured() && effort_->loop() == LoopKind::closed_recorded) {
      if (auto told = from_effort()) return report_on(told->first, told->second);
    }
    const InverseScore proposed = effort_is_measured() ? effort_->told() : InverseScore();
    // In a loop that somebody closes the effort is asked, too, where the motion leaves a gap.
    const bool effort_may_answer =
        effort_is_measured() && is_closed(effort_->loop()) && !proposed.effects.empty();
    const auto search = [&](bool effort_answers) {
      return CauseSearch(posing_, train_inputs_, held_out_inputs_, result_.where, proposed, effort_answers)
          .run();
    };
    Attempt attempt = search(effort_may_answer);
    const PowerBetweenRows power(posing_, train_inputs_, held_out_inputs_);
    if (const double share = power.share_by_constants(); share > 0.0) {
      power.let_change(share);
      Attempt between = search(effort_may_answer);
      const bool changes = between.likelier_than(attempt) > 0.0;
      if (changes) attempt = std::move(between);
      else power.let_change(0.0);
      for (std::size_t i = 0; changes && i < train_inputs_.size(); ++i)
        result_.findings.push_back(switched_between_rows(train_recordings_[i].name, train_inputs_[i], share));
    }
    const bool is_denied = effort_is_measured() && leave_out_what_effort_denies(attempt.candidates);
    Answer answer = choose(attempt.candidates, model_);
    const bool leaves_a_gap =
        largest_noise_multiple(attempt.candidates[answer.chosen].held_out) > verdict_limits.near_floor;
    if (is_denied || (effort_may_answer && leaves_a_gap)) {
      if (auto told = from_effort()) return report_on(told->first, told->second);
      if (effort_may_answer) {
        attempt = search(false);
        leave_out_what_effort_denies(attempt.candidates);
        answer = choose(attempt.candidates, model_);
      }
    }
    return report_on(attempt, answer);
  }

private:
  void gather(const std::vector<Recording>& train, const std::vector<Recording>& held_out) {
    if (train.empty()) throw InvalidInput("there is no recording to train on");
    std::vector<Recording> first = train, last = held_out;
    if (held_out.empty())
      for (Recording& one : first) {
        if (const auto problem = one.validate())
          throw InvalidInput("recording '" + one.name + "': " + *problem);
        auto parts = split(model_, std::move(one), options_.held_out_fraction);
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
    result_.not_judged = not_judged_in({&train_inputs_, &held_out_inputs_});
    result_.augmented = result_.recalibrated = model_;
  }

  Diagnosis report_on(Attempt& attempt, const Answer& answer) {
    stage("scoring on held-out data");
    report(attempt, answer);
    end_stage();
    return std::move(result_);
  }

  /// Whether the effort of a joint is recorded. What a model's servo makes of a target is no measurement: then the simulation has
  /// the loop in it, and motion tells.
  bool effort_is_measured() const {
    return effort_ && effort_->is_judged() && !train_inputs_.front().closed_loop;
  }

  /// What the effort says, given the motion; none where it tells of nothing.
  std::optional<std::pair<Attempt, Answer>> from_effort() {
    Attempt attempt = posed();
    EffortLead lead(*effort_, attempt.problem);
    if (!lead.is_told()) return std::nullopt;
    const AsJudged as_judged(posing_, train_inputs_, held_out_inputs_);
    lead.weigh_with(as_judged.lost_in_motion(lead.candidates()));
    const Answer answer = lead.answer(effort_->told());
    if (answer.chosen == 0 || as_judged.opens_the_gap(lead.candidates()[answer.chosen])) return std::nullopt;
    effort_leads_ = true;
    take(lead, answer, attempt);
    return std::make_pair(std::move(attempt), answer);
  }

  /// Training data in the windows of a fit, with nothing fitted.
  Attempt posed() const {
    Attempt attempt;
    attempt.horizon_s = options_.horizon_s;
    attempt.problem = posing_.pose(train_inputs_, posing_.fitted(options_.horizon_s));
    return attempt;
  }

  /// Takes the explanations of the effort for those of a search, with their scores as a gap is judged.
  void take(EffortLead& lead, const Answer& answer, Attempt& attempt) const {
    attempt.candidates = lead.candidates();
    const Attribution attribution(attempt.problem);
    measure_noise(attempt.problem, started(attempt.candidates[answer.chosen], attempt.problem),
                  train_inputs_);
    for (Candidate& one : attempt.candidates) attribution.adopt(one);
    attempt.recalibrated = model_with(attempt.candidates.front());
    AsJudged(posing_, train_inputs_, held_out_inputs_).score(attempt, answer.chosen);
  }

  /// A candidate whose segments start as measured.
  static Candidate started(Candidate one, const FitProblem& problem) {
    one.fit.starts = problem.measured_starts();
    return one;
  }

  Model model_with(const Candidate& one) const {
    return augmented(model_, one.explanation, one.list, one.fit.point);
  }

  /// One belief: constants and causes that predict the motion must not need another effort than the one that was recorded. In a
  /// closed loop a flywheel predicts the motion best, and would need many times the effort. What predicts the motion to the noise
  /// from the recorded effort needs no other one.
  /// Where a controller makes the effort, a cause that the effort has no use for loses, too. A cause with a name that brings the motion to
  /// the noise loses only to causes with names.
  /// @return whether the likeliest explanation is denied
  bool leave_out_what_effort_denies(std::vector<Candidate>& candidates) {
    constexpr double hardly = 1e-3, worse = 1.15;
    const auto has_no_use = [&](const Explanation& of) {
      return is_closed(effort_->loop()) &&
             std::any_of(of.effects.begin(), of.effects.end(),
                         [&](const CatalogueEntry* one) { return effort_->has_no_use_for(*one); });
    };
    const std::size_t best = likeliest(candidates);
    bool denied_best = false;
    Explanation told;
    told.effects = effort_->told().effects;
    double left = 0.0;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      Candidate& one = candidates[i];
      const bool reaches_the_floor =
          one.held_out.any() && largest_noise_multiple(one.held_out) <= decision.near_floor;
      if (one.probability > hardly && i > 0) {
        const ParameterPoint point = point_of(model_, one.explanation, one.list, one.fit.point);
        const bool needs_another =
            !reaches_the_floor && effort_->times_refitted(point.factors, added(point)) > worse;
        const bool may_lose = !reaches_the_floor || one.explanation.has_curve() || !told.has_curve();
        if (needs_another || (may_lose && has_no_use(one.explanation))) {
          one.probability = 0.0;
          denied_best = denied_best || i == best;
        }
      }
      left += one.probability;
    }
    if (left > 0.0)
      for (Candidate& one : candidates) one.probability /= left;
    return denied_best;
  }

  static std::vector<plant::AddedEffect<double>> added(const ParameterPoint& point) {
    std::vector<plant::AddedEffect<double>> list;
    std::size_t at = 0;
    for (const CatalogueEntry* entry : point.effects) {
      plant::AddedEffect<double> one;
      one.entry = entry;
      for (std::size_t i = 0; i < entry->info.parameters.size(); ++i)
        one.parameters.push_back(point.parameters[at++]);
      list.push_back(std::move(one));
    }
    return list;
  }

  /// Adds what the effort says to the table, where a controller makes it.
  void add_effort(const Candidate& chosen) {
    if (!effort_is_measured() || !(effort_->loop() == LoopKind::closed_recorded || effort_leads_)) return;
    const auto vector = [](const Eigen::VectorXd& v) { return std::vector<double>(v.begin(), v.end()); };
    const std::vector<double> before = vector(effort_->held_out_residual_as_configured()),
                              constants = vector(effort_->held_out_residual({}));
    std::vector<double> after = vector(effort_->held_out_residual(chosen.explanation.effects));
    if (after.empty()) after = constants;
    const bool voltage = model_.axis->voltage_driven();
    GapScore gap;
    gap.signal = plant::SignalName(voltage ? "voltage_V" : "drive_A");
    gap.unit = voltage ? "V" : "A";
    gap.noise_floor = effort_->effort_noise();
    measure_gap(gap, before, constants, after, options_.seed);
    result_.gap.push_back(gap);
  }

  /// The largest multiple of its floor that a signal reaches as configured, in windows twice as long; 0 where none is.
  double at_twice_the_horizon() const {
    const std::vector<Segment> windows = cut(held_out_inputs_, 2.0 * options_.horizon_s, plant_of(model_));
    const Errors errors = errors_of(model_, windows, catalogue_);
    const std::array<double, signal_count> floor =
        floor_of(model_, errors, noise_of(errors, windows, held_out_inputs_), windows, catalogue_,
                 FirstReadings::as_they_are);
    double worst = 0.0;
    for (std::size_t i = 0; i < signal_count; ++i)
      if (floor[i] > 0.0) worst = std::max(worst, errors.rms(static_cast<Signal>(i)) / floor[i]);
    return worst;
  }

  /// What a cause that the effort tells leaves of the gap: of the effort or, if that is less and the cause makes the effort no worse, of
  /// the motion.
  ShareLeft share_of_effort_or_motion() const {
    const std::vector<GapScore> motion(result_.gap.begin(), result_.gap.end() - 1);
    const ShareLeft of_effort = share_left({result_.gap.back()}), of_motion = share_left(motion);
    const bool is_no_worse = of_effort.of_refitted_constants <= 1.0 && of_effort.of_configured <= 1.0;
    return is_no_worse && of_motion.of_refitted_constants < of_effort.of_refitted_constants ? of_motion
                                                                                            : of_effort;
  }

  /// What the chosen explanation comes to: the table, the verdict that it says, and what goes with that.
  void report(Attempt& attempt, const Answer& choice) {
    std::vector<Candidate>& candidates = attempt.candidates;
    Candidate chosen = candidates[choice.chosen];
    bool only_constants = chosen.explanation.effects.empty();
    if (only_constants && !effort_leads_) {
      chosen = likeliest_constants(candidates);
      Attribution(attempt.problem).survey(chosen);
    }
    Weight weight = correlation_of(chosen, attempt.problem);
    if (effort_leads_) weight.correlation.fill(0.0);  // what the effort does not tell is in its own errors
    rank(result_, candidates, attempt.problem, weight);
    if (!effort_leads_)
      fit_to_rows(result_, chosen, attempt.problem, train_inputs_, attempt.horizon_s, weight);
    const Model fitted = augmented(model_, chosen.explanation, chosen.list, chosen.fit.point);
    result_.recalibrated = only_constants ? fitted : attempt.recalibrated;
    const std::vector<Segment> full = cut(held_out_inputs_, options_.horizon_s, plant_of(model_));
    score(result_, model_, full, held_out_inputs_, fitted, follows_its_data(chosen),
          rivals_of(candidates, choice.chosen, model_), options_, catalogue_);
    add_effort(chosen);
    result_.numbers = numbers_of(result_.gap, choice.probability);
    if (effort_leads_) result_.numbers.share = share_of_effort_or_motion();
    result_.numbers.together = choice.together;
    if (result_.numbers.configured <= verdict_limits.near_floor)
      result_.numbers.twice_horizon = at_twice_the_horizon();
    Candidate constants = only_constants ? chosen : likeliest_constants(candidates);
    const std::vector<ConstantEstimate> refitted =
        constants_of(constants, model_, only_constants ? weight : correlation_of(constants, attempt.problem));
    const std::vector<ConstantEstimate> of_chosen =
        only_constants ? refitted : constants_of(chosen, model_, weight);
    // A curve can do what constants do, too: it spares none.
    const bool spares_constants = beyond_known(of_chosen).empty() && !chosen.explanation.is_a_curve();
    if (only_constants || !spares_constants) result_.numbers.common_factor = common_factor_found();
    const bool is_shared = only_constants ? share_a_factor(refitted) : is_another_supply(chosen, of_chosen);
    if (result_.numbers.common_factor == CommonFactor::none && is_shared)
      result_.numbers.common_factor = CommonFactor::of_no_constant;
    const std::vector<int> beyond = beyond_known(refitted);
    Decision decided = ran_away(result_.gap) ? Decision{Verdict::insufficient, Reason::simulation_runs_away}
                                             : decide(result_.numbers, only_constants,
                                                      static_cast<int>(beyond.size()), spares_constants);
    const auto names_a_cause = [](Verdict verdict) {
      return verdict == Verdict::explained || verdict == Verdict::ambiguous || verdict == Verdict::partial;
    };
    if (names_a_cause(decided.verdict) && !only_constants && !has_readings_enough(chosen))
      decided = {Verdict::unexplained, Reason::no_explanation_likely};
    double probability = only_constants ? choice.probability : 1.0 - choice.probability;
    // An explanation that does not beat refitted constants leaves the answer to these; a curve does where both do as well.
    const bool is_beaten = decided.reason == Reason::closes_too_little ||
                           (decided.reason == Reason::cause_or_constants && chosen.explanation.is_a_curve());
    if (!only_constants && is_beaten) {
      keep_constants_alone(result_, model_);
      const DecisionNumbers numbers =
          numbers_of(result_.gap, std::min(1.0, choice.probability + probability_of_constants(candidates)));
      const Decision of_constants = decide(numbers, true, static_cast<int>(beyond.size()), spares_constants);
      if (names_a_cause(of_constants.verdict)) {
        decided = of_constants;
        only_constants = true;
        probability = result_.numbers.probability = numbers.probability;
        result_.numbers.share = numbers.share;
      }
    }
    const bool leave_a_rest = decided.reason == Reason::constants_close_most;
    const bool by_constants = leave_a_rest || decided.reason == Reason::constants_within_known ||
                              decided.reason == Reason::constants_moved ||
                              (decided.reason == Reason::common_factor && only_constants);
    if (names_a_cause(decided.verdict) && by_constants) {
      // Where a rest stays, those count that do for the gap what a cause would have to. More than two stand for something else, and
      // so does one on its bound.
      const double as_well = leave_a_rest ? 1.0 / verdict_limits.of_constants : 1.05;
      constants.explanation.released =
          beyond.size() == 1 ? beyond
                             : fewest_constants(attempt.problem, constants, as_well).explanation.released;
      const std::vector<int>& moved = constants.explanation.released;
      const bool ends_on_a_bound = std::any_of(
          moved.begin(), moved.end(), [&](int i) { return refitted[static_cast<std::size_t>(i)].on_bound; });
      if (leave_a_rest && (moved.size() > 2 || ends_on_a_bound))
        decided = {Verdict::unexplained, Reason::constants_leave_a_rest};
    }
    result_.verdict = decided.verdict;
    result_.why = decided.reason;
    result_.reason = to_string(decided.reason);
    const bool named = names_a_cause(decided.verdict);
    result_.constants = named && !by_constants ? of_chosen : refitted;
    note_recalibration(result_);
    if (!named || by_constants) keep_constants_alone(result_, model_);
    if (named && by_constants) {
      name_causes(result_, candidates, {choice.chosen, probability, 0.0, {}}, constants, model_, weight);
    } else if (named) {
      result_.augmented = fitted;
      name_causes(result_, candidates, choice, chosen, model_, weight);
    }
    if (decided.verdict != Verdict::ambiguous) result_.alternatives.clear();
    if (named) draw_what_is_missing();
    if (decided.verdict == Verdict::partial || decided.reason == Reason::several_close_a_part)
      result_.remaining = remaining(
          result_, model_.own ? Localisation() : localise(result_.augmented, train_recordings_, catalogue_));
    result_.next_experiment = next_experiment(result_, candidates, choice, model_, catalogue_);
    result_.predictions =
        predictions_of(model_, result_.augmented, full, held_out_inputs_, held_out_rows_, catalogue_);
  }

  /// Whether a supply that nobody recorded does what an explanation needs two changes for: at 1/gain of the nominal voltage, a winding
  /// of gain squared times the resistance is heated alike, and its current is read by the gain.
  bool is_another_supply(const Candidate& one, const std::vector<ConstantEstimate>& constants) const {
    constexpr double alike = 0.1;  // of the logarithm
    const bool is_recorded = std::all_of(train_recordings_.begin(), train_recordings_.end(),
                                         [](const Recording& log) { return log.has("supply_V"); });
    const CatalogueEntry* const gain = catalogue_.find("current_sensor_gain");
    if (is_recorded || !model_.supply || gain == nullptr || one.place_of(*gain, "gain") == one.list.size())
      return false;
    const double by = 2.0 * std::log(one.value(one.place_of(*gain, "gain")));
    return std::any_of(constants.begin(), constants.end(), [&](const ConstantEstimate& constant) {
      return constant.name == "resistance" &&
             std::abs(std::log(constant.fitted / constant.configured) - by) < alike;
    });
  }

  /// What the columns say of a factor that several constants have in common.
  CommonFactor common_factor_found() const {
    for (const Finding& one : result_.findings)
      if (one.kind == FindingKind::common_factor)
        return one.column == "t_s" ? CommonFactor::of_no_constant : CommonFactor::may_be_constant;
    return CommonFactor::none;
  }

  /// The likeliest explanation by constants alone; where all of these are as good as excluded, the one that leaves least and moves
  /// them least.
  const Candidate& likeliest_constants(const std::vector<Candidate>& candidates) const {
    constexpr double hardly = 1e-3;
    const auto cost = [&](const Candidate& one) { return fitness(one) + price_of_constants(one, model_); };
    const auto is_better = [&](const Candidate& one, const Candidate& than) {
      return std::max(one.probability, than.probability) > hardly ? one.probability > than.probability
                                                                  : cost(one) < cost(than);
    };
    const Candidate* best = &candidates.front();
    for (const Candidate& one : candidates)
      if (one.explanation.effects.empty() && is_better(one, *best)) best = &one;
    return *best;
  }

  /// Whether the training data have readings enough for what an explanation leaves free: its effects' parameters, and the constants
  /// that moved by more than is known of them. The rule of thumb of regression is 10 to 20 for each.
  bool has_readings_enough(const Candidate& candidate) const {
    constexpr double per_parameter = 15.0, least = 30.0;
    const double free = static_cast<double>(candidate.explanation.parameter_count()) +
                        static_cast<double>(moved_constants(candidate, model_).size());
    double readings = 0.0, most = 0.0;
    for (const double samples : candidate.train.samples) readings += samples, most = std::max(most, samples);
    return readings >= per_parameter * free && most >= least;
  }

  /// Whether all constants that moved by more than is known of them, two at least, moved by one factor: a supply of twice the
  /// voltage looks like twice the resistance, heat capacity and conductance.
  static bool share_a_factor(const std::vector<ConstantEstimate>& constants) {
    constexpr double alike = 0.1;  // of the factor's logarithm, and least logarithm
    double low = 1e300, high = -1e300;
    int count = 0;
    for (const ConstantEstimate& one : constants) {
      if (one.within_known || one.is_place || !(one.fitted / one.configured > 0.0)) continue;
      const double factor = std::log(one.fitted / one.configured);
      low = std::min(low, factor), high = std::max(high, factor);
      ++count;
    }
    return count >= 2 && low * high > 0.0 && high - low < alike;
  }

  /// Places of the constants that moved by more than is known of them.
  static std::vector<int> beyond_known(const std::vector<ConstantEstimate>& constants) {
    std::vector<int> places;
    for (std::size_t i = 0; i < constants.size(); ++i)
      if (!constants[i].within_known) places.push_back(static_cast<int>(i));
    return places;
  }

  /// Whether a simulation left the range of numbers, or is so stiff that no noise of its starts can be carried through it.
  static bool ran_away(const std::vector<GapScore>& table) {
    constexpr double far_away = 1e8;  // no motor is as hot, and no axis as fast
    return std::any_of(table.begin(), table.end(), [](const GapScore& gap) {
      return !std::isfinite(gap.noise_floor) || !(std::min(gap.recalibrated, gap.after) < far_away);
    });
  }

  /// Adds to the picture of the missing quantity what the model supplies of it with the causes.
  void draw_what_is_missing() {
    std::vector<Recording> simulated = train_recordings_;
    for (Recording& one : simulated)
      for (SimulatedSignal& signal :
           simulate(result_.augmented, one, {SimulationMode::free_running, options_.horizon_s}, catalogue_))
        one.set(to_string(signal.signal), std::move(signal.values));
    draw_effect(model_, std::move(simulated), catalogue_, result_.missing_quantities);
  }

  /// Begins a stage, and ends the one before.
  void stage(const char* words) {
    end_stage();
    stage_ = words;
    if (options_.at_stage) options_.at_stage(words);
  }

  void end_stage() {
    const auto now = std::chrono::steady_clock::now();
    if (stage_ != nullptr)
      result_.timings.push_back({stage_, std::chrono::duration<double>(now - since_).count()});
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
  std::optional<EffortProblem> effort_;  ///< of an axis
  bool effort_leads_ = false;            ///< the effort names the cause, and the motion must not contradict
  const char* stage_ = nullptr;          ///< under way; null: none has begun
  std::chrono::steady_clock::time_point since_ = std::chrono::steady_clock::now();
};

}  // namespace thermopower::gap::engine
