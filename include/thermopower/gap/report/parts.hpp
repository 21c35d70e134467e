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
#include <cstddef>
#include <cstdio>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
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
  order.resize(std::min(order.size(), most));
  std::vector<Rival> rivals;
  for (const Candidate* one : order)
    rivals.push_back(
        {one->explanation.ids(model), augmented(model, one->explanation, one->list, one->fit.point)});
  return rivals;
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
  constexpr std::size_t most_compared = 12;
  std::vector<std::size_t> order = by_deviance(candidates);
  sort_by(order, [&](std::size_t i) { return candidates[i].held_out.any() ? 0 : 1; });
  assert(order.size() == candidates.size() && !order.empty());
  const Candidate& empty = candidates.front();
  const double least = candidates[order.front()].deviance, held = empty.held_out.total();
  std::vector<Eigen::VectorXd> signatures;
  for (std::size_t i = 0; i < std::min(order.size(), most_compared); ++i)
    signatures.push_back(signature(candidates[order[i]], empty, problem));
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Candidate& one = candidates[order[i]];
    const double squares = one.train.total(), samples = one.train.count();
    const bool both_held_out = one.held_out.any() && empty.held_out.any();
    RankedExplanation& entry = result.ranking.emplace_back();
    entry.effects = one.explanation.ids(*problem.model);
    entry.probability = one.probability;
    entry.delta_score = one.deviance - least;
    entry.score = samples > 0.0 ? squares / samples : 0.0;
    entry.held_out_ratio =
        held > 0.0 && one.held_out.any() ? std::sqrt(one.held_out.total() / held) : missing;
    entry.lacks = lacks_of(one, squares > decision.absorbed * empty.train.total());
    entry.train_gain = empty.train_deviance - one.train_deviance;
    entry.held_out_gain = both_held_out ? empty.held_out_deviance - one.held_out_deviance : missing;
    entry.hidden_starts = one.hidden_starts;
    describe_fit(entry, one, *problem.model, weight);
    for (std::size_t k = 0; i < signatures.size() && k < signatures.size(); ++k) {
      const double cosine = k == i ? 0.0 : likeness(signatures[i], signatures[k]);
      if (cosine >= decision.confusable)
        entry.confusable.push_back({candidates[order[k]].explanation.ids(*problem.model), cosine});
    }
  }
}

/// The chosen causes with their parameters.
/// @param probability  of their class
inline void name_causes(Diagnosis& result, const std::vector<Candidate>& candidates, const Answer& choice,
                        const Candidate& chosen, const Model& model, const Weight& weight) {
  const Covariance covariance = covariance_of(chosen, weight);
  const std::vector<ParameterEstimate> all = estimates(chosen, model, covariance);
  for (const std::string& id : chosen.explanation.ids(model)) {
    Cause& cause = result.cause.emplace_back();
    cause.effect = id;
    cause.probability = choice.probability;
    for (ParameterEstimate estimate : all)
      if (estimate.name.rfind(id + ".", 0) == 0) {
        estimate.name = estimate.name.substr(id.size() + 1);
        cause.parameters.push_back(std::move(estimate));
      }
  }
  for (std::size_t index : choice.alternatives) {
    assert(index < candidates.size());
    result.alternatives.push_back(candidates[index].explanation.ids(model));
  }
  result.correlation = correlation_of_parameters(chosen, covariance, model.calibrated().size());
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

/// How far a gap shrank: 1 - after / before; 0 where there was none.
inline double shrinkage(double before, double after) { return before > 0.0 ? 1.0 - after / before : 0.0; }

/// Fills in the root mean squares of a gap, and how far it shrank.
/// @param before, constants, after  errors as configured, with refitted constants, and with the causes, row by row
inline void measure_gap(GapScore& gap, const std::vector<double>& before,
                        const std::vector<double>& constants, const std::vector<double>& after,
                        unsigned seed) {
  gap.before = rms_of(before);
  gap.recalibrated = rms_of(constants);
  gap.after = rms_of(after);
  gap.shrunk_by = shrinkage(gap.before, gap.after);
  gap.ci95 = shrinkage_interval(before, after, seed);
  gap.beyond_constants = shrinkage_interval(constants, after, seed);
  gap.by_constants = shrinkage_interval(before, constants, seed);
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
    gap.shrunk_by = shrinkage(gap.before, gap.after);
    gap.ci95 = refitted ? gap.by_constants : Interval();
    gap.beyond_constants = {};
  }
  for (SignalSeries& series : result.series)
    series.augmented = refitted ? series.recalibrated : series.baseline;
}

/// How the errors of a simulation with the causes vary in time, in one sentence.
inline std::string looks_of(const SignalSeries& series) {
  const Eigen::Index steps = series.t_s.size() - 1;
  std::vector<double> errors = finite_samples(series.augmented - series.measured),
                      steps_s = finite_samples(series.t_s.tail(steps) - series.t_s.head(steps));
  const double alike_s = 0.5 * correlation_samples(errors) * median_of(steps_s), rms = rms_of(errors),
               mean = std::accumulate(errors.begin(), errors.end(), 0.0) /
                      std::max<double>(1.0, static_cast<double>(errors.size()));
  return "errors stay alike for about " + two_digits(alike_s) + " s; " +
         std::to_string(std::lround(100.0 * mean * mean / std::max(rms * rms, 1e-30))) +
         " % of them is a constant offset of " + two_digits(mean) + " " + series.unit;
}

/// The rest that the named causes leave. @param left  of training data, by the augmented model
inline Remaining remaining(const Diagnosis& result, const Localisation& left) {
  Remaining rest;
  for (const GapScore& gap : result.gap) {
    const double times = gap.after / std::max(gap.noise_floor, 1e-12);
    if (!(times > rest.times_floor)) continue;
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
  const auto series = std::find_if(result.series.begin(), result.series.end(), [&](const SignalSeries& one) {
    return one.signal == rest.signal && one.t_s.size() >= 3;
  });
  if (series != result.series.end()) rest.looks = looks_of(*series);
  return rest;
}

/// The errors that a gap is measured by: as configured, with refitted constants, with the causes, and of rivals.
struct ErrorsOfAll {
  Errors before;               ///< as configured
  Errors constants;            ///< with refitted constants
  Errors after;                ///< with the causes
  std::vector<Errors> rivals;  ///< of each rival
};

/// Curves of a signal over one recording.
/// @param at  of the errors' rows the first one of that recording; afterwards the first one of the next
inline SignalSeries series_of(const GapScore& gap, Signal signal, const Inputs& recording,
                              const ErrorsOfAll& errors, const std::vector<Segment>& segments,
                              const std::vector<Rival>& rivals, std::size_t& at) {
  const auto i = static_cast<std::size_t>(signal);
  SignalSeries series;
  series.signal = gap.signal;
  series.unit = gap.unit;
  series.recording = recording.name;
  series.t_s = recording.t_s;
  series.measured = recording.of(signal);
  series.baseline = series.recalibrated = series.augmented =
      Eigen::VectorXd::Constant(recording.rows(), missing);
  for (const Rival& rival : rivals) series.rivals.push_back({rival.effects, series.baseline});
  for (; at < errors.before.of[i].size(); ++at) {
    if (segments[static_cast<std::size_t>(errors.before.segment[i][at])].inputs != &recording) break;
    const Eigen::Index row = errors.before.row[i][at];
    series.baseline[row] = errors.before.simulated[i][at];
    series.recalibrated[row] = errors.constants.simulated[i][at];
    series.augmented[row] = errors.after.simulated[i][at];
    for (std::size_t k = 0; k < rivals.size(); ++k)
      series.rivals[k].values[row] = errors.rivals[k].simulated[i][at];
  }
  return series;
}

/// Scores and curves on held-out data. @param fitted  with the chosen explanation  @param fits  whether it follows the data it was
/// fitted to: else its response to the noise of its starts is its own fault, and the floor is that of the model as
/// configured.
/// @param rivals  drawn beside it
inline void score(Diagnosis& result, const Model& model, const std::vector<Segment>& segments,
                  const std::vector<Inputs>& inputs, const Model& fitted, bool fits,
                  const std::vector<Rival>& rivals, const Options& options, const Catalogue& catalogue) {
  const auto of = [&](const Model& one) { return errors_of(one, segments, catalogue); };
  ErrorsOfAll errors{of(model), of(result.recalibrated), of(fitted), std::vector<Errors>(rivals.size())};
  in_parallel(rivals.size(), options.threads, [&](std::size_t i) { errors.rivals[i] = of(rivals[i].model); });
  const std::array<NoiseEstimate, signal_count> noise = noise_estimates_of(errors.after, segments, inputs);
  const std::array<double, signal_count> floor = floor_of(fits ? fitted : model, errors.after, sd_of(noise),
                                                          segments, catalogue, FirstReadings::as_they_are);
  for (std::size_t i = 0; i < signal_count; ++i) {
    // What was measured tells which rows have an error, whatever the model.
    const std::vector<double>& before = errors.before.of[i];
    if (before.empty()) continue;
    const Signal signal = static_cast<Signal>(i);
    GapScore& gap = result.gap.emplace_back();
    gap.signal = signal_name(model, signal);
    gap.unit = signal_unit(model, signal);
    if (segments[static_cast<std::size_t>(errors.before.segment[i].front())].axis)
      gap.horizon_s = options.horizon_s;
    gap.noise_floor = floor[i];
    gap.by_chance = noise[i].sd > 0.0 ? std::max(noise[i].by_chance / noise[i].sd, 1.0) : 1.0;
    measure_gap(gap, before, errors.constants.of[i], errors.after.of[i], options.seed);
    std::size_t at = 0;
    for (const Inputs& one : inputs)
      if (one.judged(signal))
        result.series.push_back(series_of(gap, signal, one, errors, segments, rivals, at));
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
