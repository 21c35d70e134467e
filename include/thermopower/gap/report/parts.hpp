// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/sort_by.hpp>
#include <thermopower/gap/diagnosis.hpp>
#include <thermopower/gap/fit/in_parallel.hpp>
#include <thermopower/gap/localise/localisation.hpp>
#include <thermopower/gap/report/estimates.hpp>
#include <thermopower/gap/report/noise_of_errors.hpp>
#include <thermopower/gap/report/score.hpp>
#include <thermopower/gap/decide/verdict.hpp>
#include <thermopower/plant/variable_words.hpp>
#include <thermopower/plant/calibration_id.hpp>

#include <algorithm>
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

/// What the fit of an explanation says of its parameters.
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
}

/// Every explanation weighed, likeliest first.
inline void rank(Diagnosis& result, const std::vector<Candidate>& candidates, const Conclusion& conclusion,
                 const FitProblem& problem, const Weight& weight) {
  std::vector<std::size_t> order = by_deviance(candidates);
  sort_by(order, [&](std::size_t i) { return candidates[i].held_out.any() ? 0 : 1; });
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
    entry.probability = one.probability * (1.0 - conclusion.none_of_these);
    entry.delta_score = one.deviance - least;
    double squares = 0.0, samples = 0.0, held_squares = 0.0;
    for (std::size_t k = 0; k < signal_count; ++k) {
      squares += one.train.squares[k];
      samples += one.train.samples[k];
      held_squares += one.held_out.squares[k];
    }
    entry.score = samples > 0.0 ? squares / samples : 0.0;
    entry.held_out_ratio = held > 0.0 && one.held_out.any() ? std::sqrt(held_squares / held) : missing;
    entry.refused = entry.held_out_ratio > 1.0;
    entry.absorbed = one.explanation.size() > 0 && squares > decision.absorbed * whole;
    entry.at_bound = one.on_bounds;
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

/// The constants that moved by more than is known of them, from a model to another one.
inline void note_moved_constants(Diagnosis& result, const Model& model, const Model& fitted) {
  for (const CalibratedConstant& constant : model.calibrated()) {
    const std::string name = constant.block + "." + constant.fields.front();
    const double sd = model.uncertainty_of(constant),
                 moved = constant.distance(model.get(name), fitted.get(name));
    if (constant.fields.size() == 1 && std::abs(moved) > known_constants.within * sd)
      result.constants.push_back({constant.id, model.get(name), fitted.get(name), sd, constant.is_place});
  }
}

/// The chosen causes with their parameters, and the alternatives. `fitted` is the model with them.
inline void name_causes(Diagnosis& result, const std::vector<Candidate>& candidates,
                        const Conclusion& conclusion, const Model& model, const Model& fitted,
                        const Weight& weight) {
  const Candidate& chosen = candidates[conclusion.chosen];
  const std::vector<ParameterEstimate> all = estimates(chosen, model, weight);
  for (const std::string& id : chosen.explanation.ids(model)) {
    Cause cause;
    cause.effect = id;
    for (const Candidate& one : candidates) {
      const std::vector<std::string> ids = one.explanation.ids(model);
      if (std::find(ids.begin(), ids.end(), id) != ids.end()) cause.probability += one.probability;
    }
    cause.probability *= 1.0 - conclusion.none_of_these;
    for (ParameterEstimate estimate : all)
      if (estimate.name.rfind(id + ".", 0) == 0) {
        estimate.name = estimate.name.substr(id.size() + 1);
        cause.parameters.push_back(std::move(estimate));
      }
    result.cause.push_back(std::move(cause));
  }
  for (std::size_t index : conclusion.alternatives)
    result.alternatives.push_back(candidates[index].explanation.ids(model));
  result.correlation = correlation_of_parameters(chosen, weight, model.calibrated().size());
  note_moved_constants(result, model, fitted);
}

/// Where constants alone were fitted, those that moved by more than is known of them are its causes: one that was
/// released and stayed is none, and one that was not and went is one. Explanations that turn out to be the same,
/// or to be empty, are dropped, the worse one.
inline void name_moved_constants(std::vector<Candidate>& candidates, const Model& model) {
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

/// Whether the printed table shows a signal clearly above the noise.
inline bool is_above_the_noise(const GapScore& gap) {
  return gap.noise_floor > 0.0 && gap.after > decision.near_floor * gap.noise_floor;
}

/// Whether constants alone are said to explain what the printed table shows above the noise: they cannot be a part of an
/// explanation, so that nothing is explained then.
inline bool constants_fall_short(const Diagnosis& result) {
  return result.verdict == Verdict::explained &&
         std::any_of(result.gap.begin(), result.gap.end(), is_above_the_noise) &&
         std::all_of(result.cause.begin(), result.cause.end(),
                     [](const Cause& one) { return plant::is_calibration(one.effect); });
}

/// Whether the printed table proves that the causes take a part of some signal's gap away: the lower end of its interval is
/// above nothing, and above what other constants take away without any cause; or what they take away beyond those, in the same
/// blocks, is material at the lower end of its own. The first is the narrower where constants do better here and worse there, the
/// second where both do.
inline bool is_proven_by_the_table(const Diagnosis& result) {
  return std::any_of(result.gap.begin(), result.gap.end(), [](const GapScore& gap) {
    const double by_constants = gap.before > 0.0 ? 1.0 - gap.recalibrated / gap.before : 0.0;
    return gap.ci95.low > 0.0 && (gap.ci95.low > by_constants || gap.beyond_constants.low > decision.proven);
  });
}

/// Whether the printed table proves that causes shrink some signal at all.
inline bool is_shrunk_by_the_table(const Diagnosis& result) {
  return std::any_of(result.gap.begin(), result.gap.end(),
                     [](const GapScore& gap) { return gap.ci95.low > 0.0; });
}

/// Whether every signal of the simulation as configured is as near the noise as one that is called explained.
inline bool is_near_as_configured(const Diagnosis& result) {
  return std::all_of(result.gap.begin(), result.gap.end(), [](const GapScore& gap) {
    return gap.noise_floor > 0.0 && gap.before <= decision.near_floor * gap.noise_floor;
  });
}

/// Whether causes leave a signal above the noise in which what is missing follows nothing recorded. A cause of the catalogue
/// acts through what is recorded, or remembers it; a rest beside a course of its own in time says that the cause only
/// follows that course as far as it can. One that leaves no rest was hidden, and is known now; and one of the instruments bends
/// the readings that the course was drawn from. Two causes at once can
/// look like such a course; whether it is over once the larger is known, the caller asks.
inline bool has_own_course(const Diagnosis& result, const Explanation& chosen) {
  for (const CatalogueEntry* entry : chosen.effects)
    if (is_of_an_instrument(*entry)) return false;
  return std::any_of(result.where.begin(), result.where.end(), [&](const Location& place) {
    return place.has_own_course &&
           std::any_of(result.gap.begin(), result.gap.end(), [&](const GapScore& gap) {
             return gap.signal == place.signal && gap.after > decision.near_floor * gap.noise_floor;
           });
  });
}

/// Whether causes leave hardly anything in the printed table: of each signal that is above the noise at most a share of the error,
/// the simulation's and the recalibrated one's alike; of two causes, which follow a course more closely, the square of it.
inline bool leaves_little(const Diagnosis& result, double share) {
  const double at_most = std::pow(share, static_cast<double>(result.cause.size()));
  return std::all_of(result.gap.begin(), result.gap.end(), [&](const GapScore& gap) {
    return gap.after <= at_most * std::min(gap.before, gap.recalibrated) || !is_above_the_noise(gap);
  });
}

/// Takes the causes back: what was found is that none of them is the answer. The noise floor stays, which the best simulation
/// showed. @param model  as configured  @param instead  what is concluded
inline void take_causes_back(Diagnosis& result, const Model& model, const Conclusion& instead) {
  const double kept = (1.0 - instead.none_of_these) / std::max(1.0 - result.none_of_these, 1e-12);
  for (RankedExplanation& one : result.ranking) one.probability *= std::min(kept, 1.0);
  result.verdict = instead.verdict;
  result.reason = instead.reason;
  result.none_of_these = instead.none_of_these;
  result.cause.clear();
  result.alternatives.clear();
  result.constants.clear();
  result.correlation = {};
  result.augmented = model;
  for (GapScore& gap : result.gap) {
    gap.after = gap.before;
    gap.shrunk_by = 0.0;
    gap.ci95 = gap.beyond_constants = {};
  }
  for (SignalSeries& series : result.series) series.augmented = series.baseline;
}

/// Takes causes back where the printed table does not prove their part. Near the noise that is asked where the simulation was
/// near it from the start: an effect that brought it there may have acted in a few seconds only, of which few blocks tell.
/// @return whether it did
inline bool take_back_the_unproven(Diagnosis& result, const Model& model, const Explanation& chosen) {
  if (!chosen.effects.empty() && is_near_as_configured(result) && !is_shrunk_by_the_table(result)) {
    take_causes_back(result, model, nothing_worth_a_cause(is_as_near));
    return true;
  }
  if (result.verdict != Verdict::partial || is_proven_by_the_table(result)) return false;
  take_causes_back(result, model, nothing_known(nothing_is_proven));
  return true;
}

/// Takes back that causes bring every signal near the noise where the printed table shows one above it: the decision is
/// drawn on a part of the held-out data, and what is said must hold on all of it. @return whether it did
inline bool admit_a_rest(Diagnosis& result) {
  if (std::none_of(result.gap.begin(), result.gap.end(), is_above_the_noise)) return false;
  if (result.verdict == Verdict::explained) {
    result.verdict = Verdict::partial;
    result.reason = partly_explained;
    return true;
  }
  if (result.verdict != Verdict::ambiguous || result.reason != several_explain) return false;
  result.reason = several_leave_a_rest;
  return true;
}

/// Takes back that the causes leave a rest where the printed table shows every signal near the noise. @return whether it
/// did
inline bool deny_a_rest(Diagnosis& result) {
  const bool in_part = result.verdict == Verdict::partial ||
                       (result.verdict == Verdict::ambiguous && result.reason == several_take_a_part);
  if (!in_part) return false;
  for (const GapScore& gap : result.gap)
    if (!(gap.noise_floor > 0.0) || is_above_the_noise(gap)) return false;
  const bool alone = result.alternatives.empty();
  result.verdict = alone ? Verdict::explained : Verdict::ambiguous;
  result.reason = alone ? wholly_explained : several_explain;
  return true;
}

/// What the named causes leave. @param left  of training data, by the augmented model
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
    char text[160];
    std::snprintf(text, sizeof text,
                  "errors stay alike for about %.2g s; %.0f %% of them is a constant offset of %.2g %s",
                  alike_s, 100.0 * mean * mean / std::max(square, 1e-30), mean, series.unit.c_str());
    rest.looks = text;
    break;
  }
  return rest;
}

/// Whether sixths of a sequence of errors, in order, prove that their root mean square is above a level: the lower end of its
/// one-sided 95 % interval is (Student's t with five degrees of freedom). A few errors that last can be any size by chance.
inline bool is_proven_above(const std::vector<double>& errors, double level) {
  constexpr std::size_t blocks = 6;
  constexpr double student = 2.015;
  if (errors.size() < blocks) return false;
  std::array<double, blocks> squares{};
  for (std::size_t i = 0; i < errors.size(); ++i)
    squares[i * blocks / errors.size()] += errors[i] * errors[i];
  double mean = 0.0, scatter = 0.0;
  for (double& one : squares) mean += (one *= blocks / static_cast<double>(errors.size())) / blocks;
  for (const double one : squares) scatter += (one - mean) * (one - mean) / (blocks * (blocks - 1.0));
  return mean - student * std::sqrt(scatter) > level * level;
}

/// Whether a model scores what the noise allows on some data.
/// @param witness  a search whose noise counts where it is less; null: there is none
/// @param proven   whether a signal near its floor counts as above it only where its errors prove that
/// @param chance   whether a signal counts as above it only where that is more than noise that remembers comes to by chance
inline bool is_within_noise(const Model& model, const std::vector<Inputs>& inputs, const FitProblem* witness,
                            double horizon_s, const Catalogue& catalogue, bool proven = false,
                            bool chance = false) {
  const std::vector<Segment> full = cut(inputs, horizon_s, plant_of(model));
  const Errors errors = errors_of(model, full, catalogue);
  const std::array<NoiseEstimate, signal_count> noise = noise_estimates_of(errors, full, inputs);
  std::array<double, signal_count> sigma = sd_of(noise);
  if (witness != nullptr &&
      witness->segments.front().inputs->repeats.size() == 0)  // of averages the search knows less
    for (std::size_t i = 0; i < signal_count; ++i) sigma[i] = std::min(sigma[i], witness->sigma[i]);
  const std::array<double, signal_count> floor =
      floor_of(model, errors, sigma, full, catalogue, FirstReadings::as_they_are);
  for (std::size_t i = 0; i < signal_count; ++i) {
    const double by_chance = chance && noise[i].sd > 0.0
                                 ? std::min(noise[i].by_chance / noise[i].sd, decision.most_by_chance)
                                 : 1.0;
    const double rms = errors.rms(static_cast<Signal>(i)),
                 within = std::max(decision.no_gap_in_full, by_chance) * floor[i];
    const bool may_be_chance =
        proven && rms <= decision.near_floor * floor[i] && !is_proven_above(errors.of[i], within);
    if (rms > within && !may_be_chance) return false;
  }
  return true;
}

/// Scores and curves on held-out data. @param fitted  with the chosen explanation  @param fits  whether it follows the data it was
/// fitted to: else what it makes of the noise of its starts is its own fault, and the floor is that of the model as configured.
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
  // The augmented model is the fitted one where there is a cause, else the model as configured.
  const Errors& after = result.cause.empty() ? before : best;
  const std::array<double, signal_count> floor =
      floor_of(fits ? fitted : model, best, noise_of(best, segments, inputs), segments, catalogue,
               FirstReadings::as_they_are);
  for (std::size_t i = 0; i < signal_count; ++i) {
    if (before.of[i].empty()) continue;
    const Signal signal = static_cast<Signal>(i);
    GapScore gap;
    gap.signal = signal_name(model, signal);
    gap.unit = signal_unit(model, signal);
    if (segments[static_cast<std::size_t>(before.segment[i].front())].axis) gap.horizon_s = options.horizon_s;
    gap.before = before.rms(signal);
    gap.recalibrated = recalibrated.rms(signal);
    gap.after = after.rms(signal);
    gap.noise_floor = floor[i];
    gap.shrunk_by = gap.before > 0.0 ? 1.0 - gap.after / gap.before : 0.0;
    gap.ci95 = shrinkage_interval(before.of[i], after.of[i], options.seed);
    gap.beyond_constants = shrinkage_interval(recalibrated.of[i], after.of[i], options.seed);
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

/// What to record next: the excitation that shows the rival explanations apart.
inline std::string next_experiment(const Diagnosis& result, const std::vector<Candidate>& candidates,
                                   const Conclusion& conclusion, const Model& model,
                                   const Catalogue& catalogue) {
  const auto advice = [&](const std::string& id) {
    const CatalogueEntry* entry = catalogue.find(id);
    return entry != nullptr ? entry->info.experiment
                            : std::string("steady operation at several levels, and steps");
  };
  if (result.verdict == Verdict::ambiguous) {
    std::string text = "To tell the explanations apart, record: ";
    std::vector<std::string> said;
    std::vector<std::size_t> indices{conclusion.chosen};
    indices.insert(indices.end(), conclusion.alternatives.begin(), conclusion.alternatives.end());
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
    return "Repeat the same excitation twice: what repeats is a missing effect, what does not is a "
           "disturbance.";
  if (result.verdict == Verdict::partial && !result.cause.empty()) {
    const std::optional<plant::SubmodelName> rest =
        result.remaining ? result.remaining->submodel : std::nullopt;
    return "To confirm, record: " + advice(result.cause.front().effect) +
           ". For what remains, log more around " +
           (rest ? to_string(*rest) : std::string("what is switched, touched or moved")) +
           ", and repeat the same excitation twice.";
  }
  if (result.verdict == Verdict::explained && !result.cause.empty())
    return "To confirm, record: " + advice(result.cause.front().effect) + ".";
  return "None needed: the simulation holds over the range that was recorded.";
}

}  // namespace thermopower::gap::engine
