// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/check.hpp>
#include <thermopower/gap/localise/localisation.hpp>
#include <thermopower/gap/localise/occurrence.hpp>
#include <thermopower/gap/localise/own_plant.hpp>
#include <thermopower/gap/fit/axis_averaging.hpp>
#include <thermopower/gap/fit/overlooked.hpp>
#include <thermopower/gap/options.hpp>
#include <thermopower/gap/report/parts.hpp>
#include <thermopower/gap/report/score.hpp>
#include <thermopower/gap/fit/segment_choice.hpp>
#include <thermopower/gap/simulate.hpp>
#include <thermopower/gap/data/splitting.hpp>
#include <thermopower/gap/fit/thinning.hpp>
#include <thermopower/gap/decide/verdict.hpp>

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>
#include <vector>

namespace thermopower::gap {

namespace detail {

/// One diagnosis under way.
class Diagnoser {
public:
  Diagnoser(const Model& model, const Options& options, const Catalogue& catalogue)
      : model_(model), options_(options), catalogue_(catalogue_of(model, catalogue)) {
    options.validate();
    if (const auto problem = model.validate()) throw InvalidInput("model '" + model.name + "': " + *problem);
    slack_.fraction = options.slack;
  }

  Diagnosis run(const std::vector<Recording>& train, const std::vector<Recording>& held_out) {
    gather(train, held_out);
    stage("data gate");
    if (!enough()) return std::move(result_);
    engine::LocalisationOptions localisation;
    localisation.slack = options_.slack;
    engine::Localisation found;
    if (model_.own) localise_own_plant(model_, catalogue_, train_inputs_, found);
    else found = engine::localise(model_, train_recordings_, localisation, catalogue_);
    if (!model_.own)
      engine::add_occurrences(model_, train_recordings_, held_out_recordings_, localisation, catalogue_,
                              found);
    result_.where = std::move(found.where);
    result_.missing_quantities = std::move(found.quantities);
    stage("where");
    Attempt attempt = thorough_search(fit_horizon_s());
    if (train_inputs_.front().axis() && options_.horizon_s < fit_horizon_s() && best_level(attempt) > 1.5) {
      // Over long windows small errors can send the axis into the next dip of a load: short ones forgive
      // that.
      Attempt shorter = thorough_search(options_.horizon_s);
      if (best_level(shorter) < 0.7 * best_level(attempt)) attempt = std::move(shorter);
    }
    stage("which");
    Conclusion conclusion = conclude(attempt.candidates, options_);
    if (conclusion.verdict != Verdict::no_gap && holds(attempt)) conclusion = nothing_missing();
    report(attempt.candidates, conclusion, attempt.problem);
    stage("how far");
    return std::move(result_);
  }

private:
  /// A search with windows of one length.
  struct Attempt {
    FitProblem problem, check;            ///< of training and of held-out data
    std::vector<Segment> all, all_check;  ///< what they have a part of
    std::vector<Candidate> candidates;
  };

  /// Places of segments that are fitted, or checked, besides those that are taken anyway.
  struct Besides {
    std::vector<std::size_t> train, held_out;
  };

  /// Whether the model, its constants within their slack, scores what the noise allows on the data in full.
  /// The search looks at averages of many rows: what shows there may be too small for anybody to care. And
  /// training data over a narrow range leave constants open that the held-out data ask for: what fits both
  /// will do.
  bool holds(const Attempt& attempt) {
    const Candidate& empty = attempt.candidates.front();
    if (worst_level(empty) > 8.0) return false;
    if (holds(augmented(model_, empty.explanation, empty.list, empty.fit.at), held_out_inputs_,
              attempt.problem))
      return true;
    std::vector<Inputs> all = train_inputs_;
    all.insert(all.end(), held_out_inputs_.begin(), held_out_inputs_.end());
    FitProblem together = problem_of(all, 2500, 4000, fit_horizon_s());
    together.sigma = attempt.problem.sigma;
    const Candidate fitted = Attribution(together, slack_, options_.threads).fit({}, {}, &empty);
    const Model calibrated = augmented(model_, fitted.explanation, fitted.list, fitted.fit.at);
    return holds(calibrated, held_out_inputs_, attempt.problem) &&
           holds(calibrated, train_inputs_, attempt.problem);
  }

  /// Whether a model scores what the noise allows on some data.
  bool holds(const Model& calibrated, const std::vector<Inputs>& inputs, const FitProblem& problem) const {
    constexpr double relevant = 1.2;
    const std::vector<Segment> full = cut(inputs, options_.horizon_s, plant_of(model_));
    const Errors errors = errors_of(calibrated, full, catalogue_);
    std::array<double, signal_count> sigma = noise_of(errors, full, inputs);
    if (problem.segments.front().inputs->repeats.size() == 0)  // of averages the search knows less
      for (std::size_t i = 0; i < signal_count; ++i) sigma[i] = std::min(sigma[i], problem.sigma[i]);
    const std::array<double, signal_count> floor = noise_floor(calibrated, full, sigma, catalogue_);
    for (std::size_t i = 0; i < signal_count; ++i)
      if (!errors.of[i].empty() && errors.rms(static_cast<Signal>(i)) > relevant * floor[i]) return false;
    return true;
  }

  static double best_level(const Attempt& attempt) { return worst_level(Search::best(attempt.candidates)); }

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
    engine::CheckedRecordings checked =
        engine::check(model_, first, last, {options_.horizon_s, options_.as_recorded}, catalogue_);
    result_.findings = std::move(checked.findings);
    for (const engine::PreparedRecording& one : checked.train) {
      train_recordings_.push_back(one.recording());
      train_inputs_.push_back(one.inputs());
    }
    for (const engine::PreparedRecording& one : checked.held_out) {
      held_out_recordings_.push_back(one.recording());
      held_out_inputs_.push_back(one.inputs());
    }
    for (const auto* all : {&train_inputs_, &held_out_inputs_})
      for (const Inputs& one : *all)
        for (const std::string& note : one.not_judged)
          if (std::find(result_.not_judged.begin(), result_.not_judged.end(), note) ==
              result_.not_judged.end())
            result_.not_judged.push_back(note);
    result_.augmented = result_.recalibrated = model_;
  }

  bool enough() {
    if (const Finding* finding = deciding(result_.findings)) {
      result_.verdict = Verdict::insufficient;
      result_.reason = "the data cannot be believed as they stand: " +
                       (finding->column.empty() ? "'" + finding->recording + "'" : finding->column) + " " +
                       finding->message;
      result_.next_experiment = finding->mend;
      return false;
    }
    constexpr double least = 12.0;
    for (const auto* all : {&train_inputs_, &held_out_inputs_}) {
      double most = 0.0;
      for (int i = 0; i < signal_count; ++i) {
        double samples = 0.0;
        for (const Inputs& one : *all)
          if (one.judged(static_cast<Signal>(i)))
            samples += static_cast<double>(one.of(static_cast<Signal>(i)).array().isFinite().count());
        most = std::max(most, samples);
      }
      if (most < least) {
        result_.verdict = Verdict::insufficient;
        result_.reason = most == 0.0
                             ? "no signal of the model can be judged with the columns recorded"
                             : "fewer than 12 samples of every signal: too little data for any statement";
        return false;
      }
    }
    return true;
  }

  /// The thinned data of a fit. @param all  receives what it is a part of
  FitProblem problem_of(const std::vector<Inputs>& inputs, Eigen::Index bench_rows, Eigen::Index axis_rows,
                        double horizon_s, const std::vector<std::size_t>& also = {},
                        std::vector<Segment>* all = nullptr) {
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
    std::vector<Segment> segments = cut(*thin, horizon_s, plant_of(model_));
    problem.segments = thinned_axis(segments, axis_rows, also);
    if (all != nullptr) *all = std::move(segments);
    kept_.push_back(std::move(thin));
    return problem;
  }

  static Eigen::Index total_rows(const std::vector<Inputs>& inputs) {
    Eigen::Index rows = 0;
    for (const Inputs& one : inputs) rows += one.rows();
    return rows;
  }

  /// Long windows tell more than the short ones of the score; the short ones keep a bad model near the data.
  double fit_horizon_s() const { return std::max(2.0, options_.horizon_s); }

  std::vector<Explanation> singles() const {
    std::vector<Explanation> list;
    const auto removed = [&](const std::string& id) {
      return std::find(options_.without.begin(), options_.without.end(), id) != options_.without.end();
    };
    for (const CatalogueEntry& entry : catalogue_.entries())
      if (!removed(entry.info.id) && can_be_judged(entry, model_, train_inputs_))
        list.push_back({{&entry}, {}});
    const std::vector<CalibratedConstant> constants = model_.calibrated();
    for (std::size_t i = 0; i < constants.size(); ++i)
      if (constants[i].may_be_cause && !removed("calibration." + constants[i].id) && acts(constants[i]))
        list.push_back({{}, {static_cast<int>(i)}});
    return list;
  }

  /// Whether the constant's block is judged.
  bool acts(const CalibratedConstant& constant) const {
    if (model_.own) return true;
    for (const Inputs& one : train_inputs_)
      if (constant.block == "axis"      ? one.axis()
          : constant.block == "thermal" ? one.judged(Signal::motor_C)
                                        : one.bench())
        return true;
    return false;
  }

  void measure_noise(FitProblem& problem, const Candidate& candidate) {
    std::array<std::vector<bool>, signal_count> gaps;
    const auto residuals = Attribution::residuals(candidate, problem, candidate.fit.starts, &gaps);
    for (std::size_t i = 0; i < signal_count; ++i) {
      if (residuals[i].empty()) continue;
      const double quantum = problem.segments.front().inputs->repeats.size() > 0
                                 ? 0.0
                                 : coarsest_quantum(train_inputs_, static_cast<Signal>(i)) / problem.sigma[i];
      problem.sigma[i] = std::max(noise_sd(residuals[i], gaps[i], quantum) * problem.sigma[i], 1e-9);
    }
  }

  /// A search, and another one with what the first overlooked.
  Attempt thorough_search(double horizon_s) {
    Attempt attempt = search(horizon_s);
    const Candidate& best = Search::best(attempt.candidates);
    const Besides worst{overlooked(attempt.problem, attempt.all, best, options_.horizon_s),
                        overlooked(attempt.check, attempt.all_check, best, options_.horizon_s)};
    return worst.train.empty() && worst.held_out.empty() ? attempt : search(horizon_s, worst);
  }

  Attempt search(double horizon_s, const Besides& also = {}) {
    Attempt attempt;
    FitProblem& problem = attempt.problem =
        problem_of(train_inputs_, 2500, 4000, horizon_s, also.train, &attempt.all);
    FitProblem& check = attempt.check =
        problem_of(held_out_inputs_, 2000, 3000, horizon_s, also.held_out, &attempt.all_check);
    const double short_s = std::min(0.5, options_.horizon_s);
    FitProblem coarse_problem = problem_of(train_inputs_, 900, 1600, short_s,
                                           short_s == horizon_s ? also.train : std::vector<std::size_t>());
    coarse_problem.segments = thinned_runs(coarse_problem.segments, 900);
    std::vector<Candidate>& candidates = attempt.candidates;
    const Attribution coarse(coarse_problem, slack_, options_.threads),
        fine(problem, slack_, options_.threads);
    for (int round = 0; round < 2; ++round) measure_noise(coarse_problem, coarse.fit({}, {}));
    problem.sigma = coarse_problem.sigma;
    const Search searching(coarse, fine, options_.threads);
    const std::vector<Explanation> causes = singles();
    candidates = searching.run_singles(causes);
    const auto renew = [&] {
      measure_noise(problem, Search::best(candidates));
      coarse_problem.sigma = check.sigma = problem.sigma;
      searching.renew(candidates);
    };
    renew();
    if (options_.effects_at_once > 1) {
      searching.run_sets(candidates, causes, options_.effects_at_once, 1.8);
      renew();
    }
    judge(candidates, check);
    weigh(candidates, correlation_of(Search::best(candidates), problem), model_);
    return attempt;
  }

  /// Scores the empty explanation and the best ones on held-out data. The others are out of the running: they
  /// are given what the empty one scores there.
  void judge(std::vector<Candidate>& candidates, const FitProblem& check) const {
    std::vector<std::size_t> order(candidates.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return Search::fitness(candidates[a]) < Search::fitness(candidates[b]);
    });
    order.resize(std::min<std::size_t>(order.size(), 14));
    if (std::find(order.begin(), order.end(), std::size_t{0}) == order.end()) order.push_back(0);
    in_parallel(order.size(), options_.threads, [&](std::size_t i) {
      candidates[order[i]].held_out = Attribution::sums(candidates[order[i]], check, nullptr);
    });
    for (Candidate& one : candidates) {
      double samples = 0.0;
      for (double count : one.held_out.samples) samples += count;
      if (!(samples > 0.0)) one.held_out = candidates.front().held_out;
    }
  }

  void report(std::vector<Candidate>& candidates, const Conclusion& conclusion, const FitProblem& problem) {
    result_.verdict = conclusion.verdict;
    result_.reason = conclusion.reason;
    result_.none_of_these = conclusion.none_of_these;
    const Candidate& chosen = candidates[conclusion.chosen];
    const bool named = conclusion.verdict == Verdict::explained || conclusion.verdict == Verdict::ambiguous;
    const Weight weight = correlation_of(chosen, problem);
    rank(result_, candidates, conclusion, problem, weight);
    const Model fitted = augmented(model_, chosen.explanation, chosen.list, chosen.fit.at);
    if (named) name_causes(result_, candidates, conclusion, model_, fitted, weight);

    Explanation all;
    const std::vector<CalibratedConstant> constants = model_.calibrated();
    for (std::size_t i = 0; i < constants.size(); ++i)
      if (constants[i].may_be_cause) all.released.push_back(static_cast<int>(i));
    const Attribution attribution(problem, slack_, options_.threads);
    const Candidate recalibrated = attribution.fit(all, {}, &candidates.front());
    result_.recalibrated =
        augmented(model_, recalibrated.explanation, recalibrated.list, recalibrated.fit.at);
    if (named) result_.augmented = fitted;
    const std::vector<Segment> full = cut(held_out_inputs_, options_.horizon_s, plant_of(model_));
    score(result_, model_, full, held_out_inputs_, fitted, options_, catalogue_);
    if (named) {
      std::vector<Recording> simulated = train_recordings_;
      for (std::size_t i = 0; i < simulated.size(); ++i)
        for (SimulatedSignal& signal :
             simulate(result_.augmented, train_recordings_[i],
                      {SimulationMode::free_running, options_.horizon_s}, catalogue_))
          simulated[i].set(to_string(signal.signal), std::move(signal.values));
      if (model_.own) {
        std::vector<Inputs> inputs;
        for (const Recording& one : simulated) inputs.push_back(prepare(model_, one));
        draw_own_effect(model_, catalogue_, inputs, result_.missing_quantities);
      } else {
        engine::draw_effect(model_, simulated, catalogue_, result_.missing_quantities);
      }
    }
    result_.next_experiment = next_experiment(result_, candidates, conclusion, model_, catalogue_);
  }

  void stage(const char* name) {
    const auto now = std::chrono::steady_clock::now();
    result_.timings.push_back({name, std::chrono::duration<double>(now - since_).count()});
    since_ = now;
  }

  const Model model_;
  const Options options_;
  const Catalogue& catalogue_;
  Slack slack_;
  Diagnosis result_;
  std::vector<Recording> train_recordings_, held_out_recordings_;
  std::vector<Inputs> train_inputs_, held_out_inputs_;
  std::vector<std::shared_ptr<std::vector<Inputs>>> kept_;
  std::chrono::steady_clock::time_point since_ = std::chrono::steady_clock::now();
};

}  // namespace detail

}  // namespace thermopower::gap
