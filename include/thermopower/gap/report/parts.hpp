// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/finding_list.hpp>
#include <thermopower/gap/data/sort_by.hpp>
#include <thermopower/gap/diagnosis.hpp>
#include <thermopower/gap/fit/in_parallel.hpp>
#include <thermopower/gap/where/localisation.hpp>
#include <thermopower/gap/report/estimates.hpp>
#include <thermopower/gap/compare/noise_of_errors.hpp>
#include <thermopower/gap/compare/score.hpp>
#include <thermopower/gap/compare/choice.hpp>
#include <thermopower/plant/variable_words.hpp>
#include <thermopower/plant/calibration_id.hpp>

#include <algorithm>
#include <cassert>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace thermopower::gap::engine {

/// An explanation that is drawn beside the chosen one.
struct Rival {
  std::vector<std::string> effects;  ///< its ids
  Model model;                       ///< with them
};

/// The likeliest explanations that were not chosen and were judged on held-out data, at most three; each has a cause.
inline std::vector<Rival> rivals_of(const std::vector<Candidate>& candidates, std::size_t chosen,
                                    const Model& model) {
  constexpr std::size_t most = 3;
  std::vector<const Candidate*> order;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    if (i != chosen && candidates[i].explanation.size() > 0 && candidates[i].held_out.any())
      order.push_back(&candidates[i]);
  sort_by(order, [](const Candidate* one) { return one->deviance; });
  sort_by(order, [](const Candidate* one) { return -one->probability; });
  std::vector<Rival> rivals;
  for (const Candidate* one : order)
    if (rivals.size() < most)
      rivals.push_back(
          {one->explanation.ids(model), augmented(model, one->explanation, one->list, one->fit.point)});
  return rivals;
}

/// The parameters of an explanation's fit.
inline void describe_fit(RankedExplanation& entry, const Candidate& one, const Model& model,
                         const Weight& weight) {
  entry.parameters = estimates(one, model, weight);
  entry.fitted.clear();
  for (const Eigen::Index at : moving(one)) {
    const auto k = static_cast<std::size_t>(at);
    entry.fitted.push_back({one.list[k].name, one.fit.point[at], one.list[k].logarithmic,
                            k < one.fit.at_bound.size() && one.fit.at_bound[k]});
  }
  entry.covariance = covariance_of_moving(one, weight);
  entry.fixed.clear();
  for (std::size_t k = 0; k < one.list.size(); ++k)
    if (one.list[k].still)
      entry.fixed.push_back(
          {one.list[k].name, one.fit.point[static_cast<Eigen::Index>(k)], one.list[k].logarithmic, false});
}

/// What a candidate lacks to be named.
/// @param is_imitated  refitted constants leave as much of the training residuals
inline Lacks lacks_of(const Candidate& one, bool is_imitated) {
  if (one.explanation.size() == 0) return Lacks::nothing;
  if (one.on_bounds) return Lacks::room;
  if (!one.held_out.any()) return Lacks::a_judgement;
  if (one.makes_worse) return Lacks::use;
  if (one.open) return Lacks::told_parameter;
  if (one.doubtful) return Lacks::presence;
  if (one.idle) return Lacks::something_own;
  return is_imitated ? Lacks::difference : Lacks::nothing;
}

/// Every explanation weighed, likeliest first.
inline void rank(Diagnosis& result, const std::vector<Candidate>& candidates, const FitProblem& problem,
                 const Weight& weight) {
  std::vector<std::size_t> order = by_deviance(candidates);
  sort_by(order, [&](std::size_t i) { return candidates[i].held_out.any() ? 0 : 1; });
  assert(order.size() == candidates.size() && !order.empty());
  const double least = candidates[order.front()].deviance;
  std::vector<Eigen::VectorXd> signatures(order.size());
  const Candidate& empty = candidates.front();
  const std::size_t compared = std::min<std::size_t>(order.size(), 12);
  for (std::size_t i = 0; i < compared; ++i) signatures[i] = signature(candidates[order[i]], empty, problem);
  double whole = 0.0, held = 0.0;
  for (std::size_t i = 0; i < signal_count; ++i)
    whole += empty.train.squares[i], held += empty.held_out.squares[i];
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Candidate& one = candidates[order[i]];
    RankedExplanation entry;
    entry.effects = one.explanation.ids(*problem.model);
    entry.probability = one.probability;
    entry.delta_score = one.deviance - least;
    double squares = 0.0, samples = 0.0, held_squares = 0.0;
    for (std::size_t k = 0; k < signal_count; ++k) {
      squares += one.train.squares[k];
      samples += one.train.samples[k];
      held_squares += one.held_out.squares[k];
    }
    entry.score = samples > 0.0 ? squares / samples : 0.0;
    entry.held_out_ratio = held > 0.0 && one.held_out.any() ? std::sqrt(held_squares / held) : missing;
    entry.lacks = lacks_of(one, squares > decision.absorbed * whole);
    entry.train_gain = empty.train_deviance - one.train_deviance;
    entry.held_out_gain = one.held_out.any() && empty.held_out.any()
                              ? empty.held_out_deviance - one.held_out_deviance
                              : missing;
    entry.hidden_starts = one.hidden_starts;
    describe_fit(entry, one, *problem.model, weight);
    for (std::size_t k = 0; k < compared; ++k) {
      if (k == i || i >= compared) continue;
      const double cosine = likeness(signatures[i], signatures[k]);
      if (cosine >= decision.confusable)
        entry.confusable.push_back({candidates[order[k]].explanation.ids(*problem.model), cosine});
    }
    result.ranking.push_back(std::move(entry));
  }
}

/// Every constant that a fit may move, as configured and as an explanation has it.
inline std::vector<ConstantEstimate> constants_of(const Candidate& candidate, const Model& model,
                                                  const Weight& weight) {
  constexpr double hardly = 0.9;  // of what the file says is known: then the data say nothing of it
  assert(candidate.list.size() >= model.calibrated().size());
  const Covariance covariance = covariance_of(candidate, weight);
  std::vector<ConstantEstimate> list;
  std::size_t at = 0;
  for (const CalibratedConstant& constant : model.calibrated()) {
    const std::size_t place = at++;
    const Coordinate& one = candidate.list[place];
    ConstantEstimate entry;
    entry.name = constant.id;
    entry.is_place = constant.is_place;
    entry.uncertainty = model.uncertainty_of(constant);
    entry.configured = model.get(constant.block + "." + constant.fields.front());
    const auto moved = [&](double by) { return constant.moved(entry.configured, one.value_of(by)); };
    const double by = candidate.fit.point[static_cast<Eigen::Index>(place)];
    entry.fitted = moved(by);
    if (!(one.upper > one.lower)) {  // it was not fitted
      entry.determined = false;
      entry.ci95 = {entry.fitted, entry.fitted};
      list.push_back(entry);
      continue;
    }
    const Interval interval = interval_of(candidate, place, covariance);
    const double low = moved(interval.low), high = moved(interval.high);
    entry.ci95 = {std::min(low, high), std::max(low, high)};
    entry.determined = interval.high - interval.low < hardly * 2.0 * covariance.quantile * entry.uncertainty;
    entry.on_bound = place < candidate.fit.at_bound.size() && candidate.fit.at_bound[place];
    entry.within_known = std::abs(by) <= known_constants.within * entry.uncertainty * (1.0 + 1e-9);
    list.push_back(entry);
  }
  return list;
}

/// The chosen causes with their parameters.
/// @param probability  of their class
inline void name_causes(Diagnosis& result, const std::vector<Candidate>& candidates, const Answer& choice,
                        const Candidate& chosen, const Model& model, const Weight& weight) {
  const std::vector<ParameterEstimate> all = estimates(chosen, model, weight);
  for (const std::string& id : chosen.explanation.ids(model)) {
    Cause cause;
    cause.effect = id;
    cause.probability = choice.probability;
    for (ParameterEstimate estimate : all)
      if (estimate.name.rfind(id + ".", 0) == 0) {
        estimate.name = estimate.name.substr(id.size() + 1);
        cause.parameters.push_back(std::move(estimate));
      }
    result.cause.push_back(std::move(cause));
  }
  for (std::size_t index : choice.alternatives) {
    assert(index < candidates.size());
    result.alternatives.push_back(candidates[index].explanation.ids(model));
  }
  result.correlation = correlation_of_parameters(chosen, weight, model.calibrated().size());
}

/// If constants alone were fitted, those that moved by more than is known of them are the causes, whether they were
/// released or not. Explanations that turn out to be the same, or to be empty, are dropped, the worse one.
inline void name_moved_constants(std::vector<Candidate>& candidates, const Model& model) {
  assert(!candidates.empty());
  std::vector<Candidate> kept{std::move(candidates.front())};
  for (std::size_t i = 1; i < candidates.size(); ++i) {
    Candidate& one = candidates[i];
    if (one.explanation.effects.empty()) {
      one.explanation.released = moved_constants(one, model);
      if (one.explanation.released.empty()) continue;
      const auto same = std::find_if(kept.begin(), kept.end(), [&](const Candidate& other) {
        return other.explanation.effects.empty() && other.explanation.released == one.explanation.released;
      });
      if (same != kept.end()) {
        if (fitness(one) < fitness(*same)) *same = std::move(one);
        continue;
      }
    }
    kept.push_back(std::move(one));
  }
  candidates = std::move(kept);
}

/// Says so where refitted constants do worse on held-out data than the configured ones.
inline void note_recalibration(Diagnosis& result) {
  for (const GapScore& gap : result.gap)
    if (gap.recalibrated > decision.worse * gap.before && gap.before > 0.0) {
      if (!result.recalibration.empty()) result.recalibration += "; ";
      char times[32];
      std::snprintf(times, sizeof times, "%.3g", gap.recalibrated / gap.before);
      result.recalibration += plant::in_words(to_string(gap.signal)) + ": refitted constants score " + times +
                              " times the held-out error of the configured ones";
    }
  if (!result.recalibration.empty())
    result.recalibration += ": they made up for something on the training data that is not a constant";
}

/// The table without causes: what stands beside "as configured" then are the refitted constants, where these predict held-out
/// data better. @param model  as configured
inline void keep_constants_alone(Diagnosis& result, const Model& model) {
  double worse = 0.0;
  for (const GapScore& gap : result.gap)
    if (gap.before > 0.0 && gap.recalibrated > 0.0) worse += std::log(gap.recalibrated / gap.before);
  const bool refitted = worse < 0.0;
  result.augmented = refitted ? result.recalibrated : model;
  for (GapScore& gap : result.gap) {
    gap.after = refitted ? gap.recalibrated : gap.before;
    gap.shrunk_by = gap.before > 0.0 ? 1.0 - gap.after / gap.before : 0.0;
    gap.ci95 = refitted ? gap.by_constants : Interval();
    gap.beyond_constants = {};
  }
  for (SignalSeries& series : result.series)
    series.augmented = refitted ? series.recalibrated : series.baseline;
}

/// The rest that the named causes leave. @param left  of training data, by the augmented model
inline Remaining remaining(const Diagnosis& result, const Localisation& left) {
  Remaining rest;
  double worst = 0.0;
  for (const GapScore& gap : result.gap) {
    const double times = gap.after / std::max(gap.noise_floor, 1e-12);
    if (!(times > worst)) continue;
    worst = times;
    rest.signal = gap.signal;
    rest.times_floor = times;
    const double floor = gap.noise_floor * gap.noise_floor;
    const double whole = std::max(gap.before * gap.before - floor, 1e-30);
    rest.share = std::clamp(std::sqrt(std::max(gap.after * gap.after - floor, 0.0) / whole), 0.0, 1.0);
  }
  if (!left.where.empty()) {
    rest.submodel = left.where.front().submodel;
    rest.regime = left.where.front().regime;
  }
  for (const SignalSeries& series : result.series) {
    if (series.signal != rest.signal || series.t_s.size() < 3) continue;
    assert(series.augmented.size() == series.t_s.size() && series.measured.size() == series.t_s.size());
    std::vector<double> errors, steps;
    for (Eigen::Index row = 0; row < series.t_s.size(); ++row) {
      const double error = series.augmented[row] - series.measured[row];
      if (std::isfinite(error)) errors.push_back(error);
      if (row > 0) steps.push_back(series.t_s[row] - series.t_s[row - 1]);
    }
    std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2),
                     steps.end());
    const double alike_s = 0.5 * correlation_samples(errors) * steps[steps.size() / 2];
    double mean = 0.0, square = 0.0;
    for (double error : errors) mean += error, square += error * error;
    mean /= std::max<double>(1.0, static_cast<double>(errors.size()));
    square /= std::max<double>(1.0, static_cast<double>(errors.size()));
    rest.looks = "errors stay alike for about " + two_digits(alike_s) + " s; " +
                 std::to_string(std::lround(100.0 * mean * mean / std::max(square, 1e-30))) +
                 " % of them is a constant offset of " + two_digits(mean) + " " + series.unit;
    break;
  }
  return rest;
}

/// Scores and curves on held-out data. @param fitted  with the chosen explanation  @param fits  whether it follows the data it was
/// fitted to: else its response to the noise of its starts is its own fault, and the floor is that of the model as
/// configured.
/// @param rivals  drawn beside it
inline void score(Diagnosis& result, const Model& model, const std::vector<Segment>& segments,
                  const std::vector<Inputs>& inputs, const Model& fitted, bool fits,
                  const std::vector<Rival>& rivals, const Options& options, const Catalogue& catalogue) {
  const Errors before = errors_of(model, segments, catalogue);
  const Errors recalibrated = errors_of(result.recalibrated, segments, catalogue);
  const Errors best = errors_of(fitted, segments, catalogue);
  std::vector<Errors> others(rivals.size());
  in_parallel(rivals.size(), options.threads,
              [&](std::size_t i) { others[i] = errors_of(rivals[i].model, segments, catalogue); });
  const Errors& after = best;
  const std::array<NoiseEstimate, signal_count> noise = noise_estimates_of(best, segments, inputs);
  const std::array<double, signal_count> floor =
      floor_of(fits ? fitted : model, best, sd_of(noise), segments, catalogue, FirstReadings::as_they_are);
  for (std::size_t i = 0; i < signal_count; ++i) {
    if (before.of[i].empty()) continue;
    // What was measured tells which rows have an error, whatever the model.
    assert(recalibrated.of[i].size() == before.of[i].size() && after.of[i].size() == before.of[i].size());
    const Signal signal = static_cast<Signal>(i);
    GapScore gap;
    gap.signal = signal_name(model, signal);
    gap.unit = signal_unit(model, signal);
    if (segments[static_cast<std::size_t>(before.segment[i].front())].axis) gap.horizon_s = options.horizon_s;
    gap.before = before.rms(signal);
    gap.recalibrated = recalibrated.rms(signal);
    gap.after = after.rms(signal);
    gap.noise_floor = floor[i];
    gap.by_chance = noise[i].sd > 0.0 ? std::max(noise[i].by_chance / noise[i].sd, 1.0) : 1.0;
    gap.shrunk_by = gap.before > 0.0 ? 1.0 - gap.after / gap.before : 0.0;
    gap.ci95 = shrinkage_interval(before.of[i], after.of[i], options.seed);
    gap.beyond_constants = shrinkage_interval(recalibrated.of[i], after.of[i], options.seed);
    gap.by_constants = shrinkage_interval(before.of[i], recalibrated.of[i], options.seed);
    result.gap.push_back(gap);
    std::size_t at = 0;
    for (const Inputs& one : inputs) {
      if (!one.judged(signal)) continue;
      SignalSeries series;
      series.signal = gap.signal;
      series.unit = gap.unit;
      series.recording = one.name;
      series.t_s = one.t_s;
      series.measured = one.of(signal);
      series.baseline = series.recalibrated = series.augmented =
          Eigen::VectorXd::Constant(one.rows(), missing);
      for (const Rival& rival : rivals) series.rivals.push_back({rival.effects, series.baseline});
      for (; at < before.of[i].size(); ++at) {
        const Segment& segment = segments[static_cast<std::size_t>(before.segment[i][at])];
        if (segment.inputs != &one) break;
        const Eigen::Index row = before.row[i][at];
        series.baseline[row] = before.simulated[i][at];
        series.recalibrated[row] = recalibrated.simulated[i][at];
        series.augmented[row] = after.simulated[i][at];
        for (std::size_t k = 0; k < others.size(); ++k)
          if (at < others[k].row[i].size() && others[k].row[i][at] == row)
            series.rivals[k].values[row] = others[k].simulated[i][at];
      }
      result.series.push_back(std::move(series));
    }
  }
}

/// The next recording: the excitation that shows the rival explanations apart.
inline std::string next_experiment(const Diagnosis& result, const std::vector<Candidate>& candidates,
                                   const Answer& choice, const Model& model, const Catalogue& catalogue) {
  const auto advice = [&](const std::string& id) {
    const CatalogueEntry* entry = catalogue.find(id);
    return entry != nullptr ? entry->info.experiment
                            : std::string("steady operation at several levels, and steps");
  };
  if (result.verdict == Verdict::ambiguous) {
    std::string text = "To tell the explanations apart, record: ";
    std::vector<std::string> said;
    std::vector<std::size_t> indices{choice.chosen};
    indices.insert(indices.end(), choice.alternatives.begin(), choice.alternatives.end());
    for (std::size_t index : indices)
      for (const std::string& id : candidates[index].explanation.ids(model)) {
        const std::string one = advice(id) + " (" + id + ")";
        if (said.size() < 4 && std::find(said.begin(), said.end(), one) == said.end()) said.push_back(one);
      }
    for (std::size_t i = 0; i < said.size(); ++i) text += (i > 0 ? "; " : "") + said[i];
    return text + ".";
  }
  if (result.verdict == Verdict::unexplained && !result.where.empty())
    return "Log more around " + to_string(result.where.front().submodel) + " (" +
           plant::in_words(to_string(result.where.front().signal)) +
           "): whatever is switched, touched or moved while it runs, and repeat the same excitation twice.";
  if (result.verdict == Verdict::unexplained)
    return "Repeat the same excitation twice: a missing effect repeats, and a disturbance does not.";
  if (result.verdict == Verdict::partial && !result.cause.empty()) {
    const std::optional<plant::SubmodelName> rest =
        result.remaining ? result.remaining->submodel : std::nullopt;
    return "To confirm this cause, record: " + advice(result.cause.front().effect) +
           ". For what remains, log more around " +
           (rest ? to_string(*rest) : std::string("what is switched, touched or moved")) +
           ", and repeat the same excitation twice.";
  }
  if (result.verdict == Verdict::explained && !result.cause.empty())
    return "To confirm this cause, record: " + advice(result.cause.front().effect) + ".";
  return "None needed: the simulation holds over the range that was recorded.";
}

}  // namespace thermopower::gap::engine
