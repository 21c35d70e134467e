// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/sort_by.hpp>
#include <thermopower/gap/compare/block_jackknife.hpp>
#include <thermopower/gap/compare/search.hpp>
#include <thermopower/gap/compare/shown.hpp>
#include <thermopower/gap/compare/thresholds.hpp>
#include <thermopower/gap/rule.hpp>
#include <thermopower/plant/calibration_id.hpp>

#include <algorithm>
#include <cassert>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace thermopower::gap::engine {

/// How much the samples of each signal count.
struct Weight {
  std::array<double, signal_count> correlation =
      plant::for_each_signal(1.0);  ///< training samples that count as one
  std::array<double, signal_count> held_out =
      plant::for_each_signal(1.0);  ///< held-out samples that count as one
  Shown shown = {};                 ///< by the training data
};

/// How many residuals of a candidate count as one, signal by signal, in the data it was fitted to.
inline Weight correlation_of(const Candidate& candidate, const FitProblem& problem) {
  Weight weight;
  const auto residuals = Attribution::residuals(candidate, problem, candidate.fit.starts);
  for (std::size_t i = 0; i < signal_count; ++i)
    if (!residuals[i].empty()) weight.correlation[i] = correlation_samples(residuals[i]);
  return weight;
}

/// How many times larger the variance of a candidate's parameters is than that of white noise of the problem's size: by the level of
/// what it leaves, and by its correlation.
inline double inflation_of(const Candidate& candidate, const Weight& weight) {
  double inflation = 1.0;
  for (std::size_t i = 0; i < signal_count; ++i)
    if (candidate.train.samples[i] > 0.0)
      inflation = std::max(inflation, candidate.train.mean(i) * weight.correlation[i]);
  return inflation;
}

/// Geometric mean over the signals that have a correlation: residuals that count as one, 1 or more.
inline double mean_correlation(const Weight& weight) {
  double product = 1.0, signals = 0.0;
  for (double one : weight.correlation)
    if (one > 1.0) product *= one, signals += 1.0;
  return signals > 0.0 ? std::pow(product, 1.0 / signals) : 1.0;
}

/// Whether a parameter ended where a recording can show it. A cause that brings everything to the noise was shown, however
/// little of a period the travel holds. This does not hold for a period at its upper bound, which is the first terms of a
/// series. Beside a cable's spring it makes one that grows stiffer outwards.
/// @param at  its place among the candidate's coordinates
inline bool shows(const Candidate& candidate, const CatalogueEntry& entry, const Parameter& parameter,
                  std::size_t at, const Shown& shown) {
  if (parameter.periods_in_travel > 0.0 &&
      candidate.value(at) * shown.travel_rad < parameter.periods_in_travel * rad_per_turn) {
    constexpr double nearly = 1.01;
    const Coordinate& count = candidate.list[at];
    if (!shown.by_reaching_the_noise || candidate.value(at) <= nearly * count.value_of(count.lower))
      return false;
  }
  if (parameter.within_the_motion && candidate.value(at) > shown.fastest_rad_per_s) return false;
  if (parameter.exceeds.empty()) return true;
  const std::size_t other = candidate.place_of(entry, parameter.exceeds);
  return other >= candidate.list.size() || candidate.value(at) > candidate.value(other);
}

/// Whether the training data tell a parameter, if an effect has another one of its kind (friction forward and backward).
/// Moved by as much as the largest of them is, it must show. In a motion one way a friction that differs by direction is no
/// more than a friction.
/// @param first  place of the effect's first parameter among the candidate's coordinates
/// @param i      place of the parameter among the effect's
inline bool is_told(const Candidate& candidate, const CatalogueEntry& entry, std::size_t first,
                    std::size_t i) {
  const std::vector<Parameter>& parameters = entry.info.parameters;
  const auto row = static_cast<Eigen::Index>(first + i);
  if (candidate.fit.information.rows() <= row || candidate.list[first + i].logarithmic) return true;
  double largest = 0.0;
  bool has_another = false;
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    if (parameters[k].unit != parameters[i].unit || candidate.list[first + k].logarithmic) continue;
    has_another = has_another || k != i;
    largest = std::max(largest, std::abs(candidate.fit.point[static_cast<Eigen::Index>(first + k)]));
  }
  return !has_another || !(largest > 0.0) || candidate.fit.information(row, row) * largest * largest > 1.0;
}

/// Whether a model has dry friction of its own. @param constants  the model's
inline bool has_dry_friction(const std::vector<CalibratedConstant>& constants) {
  return std::any_of(constants.begin(), constants.end(), [](const CalibratedConstant& one) {
    return plant::names_a_transition(one.fields.front());
  });
}

/// Whether a constant went as far as it may. @param at  its coordinate
inline bool is_as_far_as_it_may(const CalibratedConstant& constant, double at) {
  constexpr double nearly = 0.999;
  return at > nearly * farthest(constant) ||
         (at < -nearly * farthest_down(constant) && !may_vanish(constant));
}

/// Whether what an effect adds to a constant, such as a drag by direction, makes the sum negative: it would drive the axis.
/// @param first  place of the effect's first parameter
inline bool drives_the_axis(const Candidate& candidate, const CatalogueEntry& entry, std::size_t first,
                            const Model& model) {
  if (!entry.info.where_equal) return false;
  const std::vector<CalibratedConstant> constants = model.calibrated();
  for (std::size_t k = 0; k < constants.size(); ++k) {
    const CalibratedConstant& constant = constants[k];
    if (plant::calibration_id(constant.id) != entry.info.where_equal->cause) continue;
    const double own =
        constant.moved(model.get(constant.block + "." + constant.fields.front()), candidate.value(k));
    for (const int part : {entry.info.where_equal->one, entry.info.where_equal->other})
      if (own + candidate.value(first + static_cast<std::size_t>(part)) < 0.0) return true;
  }
  return false;
}

/// Whether some cause ended with all its parameters on their bounds, or with one parameter where it is another effect. It
/// then stands for a cause that the catalogue lacks. (A transition of friction does not count: at its bound friction
/// sticks.)
///
/// Nor is one beside which a constant went as far as it may: then the equation is another one. (The transition of a friction that
/// the model has does not count either, nor what may vanish and does.)
///
/// Nor is a cause that ends where the recording cannot show it. Examples are a rise of friction inside the transition
/// through standstill or with a knee that no motion reaches, a period longer than the travel, a time constant longer than a
/// run, and backward friction of an axis that never moved backward.
/// Nor is a drag that, the model's own included, is negative: it would drive the axis.
/// @param shown  by the training data; anything where it is not given
inline bool ends_on_bounds(const Candidate& candidate, const Model& model, const Shown& shown = {}) {
  const std::vector<bool>& at_bound = candidate.fit.at_bound;
  if (at_bound.size() < candidate.list.size()) return false;
  for (int index : candidate.explanation.released)
    if (at_bound[static_cast<std::size_t>(index)]) return true;
  const std::vector<CalibratedConstant> constants = model.calibrated();
  std::size_t at = constants.size();
  for (std::size_t i = 0; i < at && candidate.explanation.size() > 0; ++i)
    if (!plant::names_a_transition(constants[i].fields.front()) &&
        is_as_far_as_it_may(constants[i], candidate.fit.point[static_cast<Eigen::Index>(i)]))
      return true;
  assert(candidate.list.size() == at_bound.size());
  for (const CatalogueEntry* entry : candidate.explanation.effects) {
    bool all = true;
    const std::size_t first = at;
    for (const Parameter& parameter : entry->info.parameters) {
      if (!parameter.standard && !entry->info.curve && !is_told(candidate, *entry, first, at - first))
        return true;
      if (at_bound[at] && parameter.degenerate_at_bounds) return true;
      const Coordinate& coordinate = candidate.list[at];
      const bool in_upper_half =
          candidate.fit.point[static_cast<Eigen::Index>(at)] > 0.5 * (coordinate.lower + coordinate.upper);
      if (at_bound[at] && in_upper_half && parameter.degenerate_at_upper) return true;
      if (!shows(candidate, *entry, parameter, at, shown)) return true;
      all = (at_bound[at++] || parameter.standard.has_value()) && all;
    }
    if (all && !entry->info.parameters.empty()) return true;
    if (drives_the_axis(candidate, *entry, first, model)) return true;
    std::vector<double> values;
    for (std::size_t i = first; i < at; ++i) values.push_back(candidate.value(i));
    if (entry->info.slowest_s != nullptr && entry->info.slowest_s(values.data()) > shown.longest_run_s)
      return true;
    if (entry->info.is_itself != nullptr && !entry->info.is_itself(values.data())) return true;
    if (entry->info.is_itself_alone != nullptr && !has_dry_friction(constants) &&
        !entry->info.is_itself_alone(values.data()))
      return true;
  }
  return false;
}

/// Root of the mean square over training and held-out data of a signal, in units of the noise; 0 without
/// samples.
inline double noise_multiple(const Candidate& candidate, std::size_t signal) {
  const double samples = candidate.train.samples[signal] + candidate.held_out.samples[signal];
  if (!(samples > 0.0)) return 0.0;
  return std::sqrt((candidate.train.squares[signal] + candidate.held_out.squares[signal]) / samples);
}

/// The root mean square of a signal, in units of the noise or the noise floor.
inline double noise_multiple(const SignalSums& sums, std::size_t signal) {
  return std::sqrt(sums.mean(signal));
}

/// The largest of them.
inline double largest_noise_multiple(const SignalSums& sums) {
  double worst = 0.0;
  for (std::size_t i = 0; i < signal_count; ++i) worst = std::max(worst, noise_multiple(sums, i));
  return worst;
}

/// The largest root mean square of a candidate over its signals, training and held-out data together.
inline double largest_noise_multiple(const Candidate& candidate) {
  double worst = 0.0;
  for (std::size_t i = 0; i < signal_count; ++i) worst = std::max(worst, noise_multiple(candidate, i));
  return worst;
}

/// Whether a candidate scores as well as another where it matters. With many rows a smaller difference can still
/// be significant; it then tells of the small errors that every model has, not of the cause. The further the better one is
/// above the noise, the larger are its own errors. An explanation with fewer parameters then counts as equal within a
/// larger margin.
inline bool scores_alike(const Candidate& candidate, const Candidate& other) {
  const bool simpler = candidate.explanation.parameter_count() < other.explanation.parameter_count();
  for (std::size_t i = 0; i < signal_count; ++i) {
    const double above = std::max(1.0 - 1.0 / std::max(other.held_out.mean(i), 1.0), 0.0);
    const double margin = simpler ? decision.alike_far_from_noise * above : 0.0;
    const double held_out = 1.0 + decision.alike_held_out + margin;
    if (candidate.held_out.samples[i] > 0.0 &&
        candidate.held_out.mean(i) > held_out * held_out * other.held_out.mean(i))
      return false;
    if (noise_multiple(candidate, i) > (1.0 + decision.alike_overall + margin) * noise_multiple(other, i))
      return false;
    if (noise_multiple(candidate.train, i) >
        (1.0 + decision.alike_in_training + margin) * noise_multiple(other.train, i))
      return false;
  }
  return true;
}

/// Whether an effect joined constants that explain everything without it: all of them moved with it, too.
inline bool does_nothing_more(const Candidate& candidate, const Candidate& constants) {
  if (candidate.explanation.effects.empty()) return false;
  for (int index : constants.explanation.released) {
    const double own = candidate.fit.point[index], theirs = constants.fit.point[index];
    if (own * theirs <= 0.0 || std::abs(own) < 0.5 * std::abs(theirs)) return false;
  }
  return true;
}

/// Whether a candidate follows the data it was fitted to. Then its response to the noise of its starts is that of a perfect
/// model, too.
inline bool follows_its_data(const Candidate& candidate) {
  return candidate.train.within(decision.follows * decision.follows);
}

/// Whether a candidate scores what the noise allows.
inline bool is_at_the_noise(const Candidate& candidate) {
  return candidate.held_out.any() && largest_noise_multiple(candidate) <= decision.no_gap &&
         largest_noise_multiple(candidate.held_out) <= decision.no_gap;
}

/// Whether a candidate may be named: it was judged on held-out data and does not make them worse, does not stand in for another
/// one, and all of it is there.
inline bool in_the_running(const Candidate& candidate) {
  return !candidate.on_bounds && !candidate.idle && !candidate.open && !candidate.doubtful &&
         !candidate.makes_worse && candidate.held_out.any();
}

/// Whether two parameters of a candidate are equal as far as it matters, with what the data leave open.
/// @param one    place of a parameter among the candidate's coordinates
/// @param other  place of another one
/// @param within  share of the larger one by which they may differ
inline bool are_equal(const Candidate& candidate, std::size_t one, std::size_t other,
                      double within = decision.equal) {
  const auto a = static_cast<Eigen::Index>(one), b = static_cast<Eigen::Index>(other);
  const double larger = std::max(std::abs(candidate.fit.point[a]), std::abs(candidate.fit.point[b]));
  double apart = std::abs(candidate.fit.point[a] - candidate.fit.point[b]);
  const Eigen::MatrixXd& information = candidate.fit.information;
  if (std::max(a, b) < information.rows()) {
    constexpr double standard_errors = 2.0;
    const double curvature = 0.25 * (information(a, a) + information(b, b) - 2.0 * information(a, b));
    apart += standard_errors / std::sqrt(std::max(curvature, 1e-300));
  }
  return apart <= within * larger;
}

/// Whether a parameter of a candidate is small beside another one as far as it matters, with what the data leave open.
/// @param small   place of a parameter among the candidate's coordinates
/// @param beside  place of the one that it is measured against
inline bool is_small(const Candidate& candidate, std::size_t small, std::size_t beside) {
  const auto a = static_cast<Eigen::Index>(small), b = static_cast<Eigen::Index>(beside);
  double size = std::abs(candidate.fit.point[a]);
  const Eigen::MatrixXd& information = candidate.fit.information;
  if (a < information.rows()) {
    constexpr double standard_errors = 2.0;
    size += standard_errors / std::sqrt(std::max(information(a, a), 1e-300));
  }
  const double large = std::abs(candidate.fit.point[b]);
  return large > 0.0 && size <= decision.equal * large;  // beside nothing, nothing is small
}

/// Another name for an effect, by where its parameters ended.
struct SpecialCase {
  std::string cause;           ///< id; empty: the effect itself
  bool but_for_a_bit = false;  ///< what else it has is too small to be what it fits better by
  bool the_same = false;  ///< there is nothing else: what it fits better by is where its fit happened to end
};

/// Whether no signal's error is larger than another one's by more than what every model is wrong by.
inline bool is_nearly(const SignalSums& sums, const SignalSums& others) {
  constexpr double most = 1.0 + decision.alike_far_from_noise;
  for (std::size_t i = 0; i < signal_count; ++i)
    if (sums.samples[i] > 0.0 && sums.mean(i) > most * most * others.mean(i)) return false;
  return true;
}

/// The other name of an effect of a candidate, by where its parameters ended.
/// @param at  place of its first parameter among the candidate's coordinates
inline SpecialCase special_case(const Candidate& candidate, const EffectInfo& info, std::size_t at) {
  const auto place = [&](int i) { return at + static_cast<std::size_t>(i); };
  const auto& equal = info.where_equal;
  const auto differ_by_no_more_than = [&](double share) {
    return equal && are_equal(candidate, place(equal->one), place(equal->other), share);
  };
  if (differ_by_no_more_than(decision.the_same)) return {equal->cause, true, true};
  if (differ_by_no_more_than(decision.equal)) return {equal->cause, false, false};
  const auto& small = info.where_small;
  if (small && is_small(candidate, place(small->small), place(small->beside)))
    return {small->cause, true, false};
  return {};
}

/// Whether some effect of a candidate ended where it has another name.
inline bool has_special_case(const Candidate& candidate, const Model& model) {
  std::size_t at = model.calibrated().size();
  for (const CatalogueEntry* entry : candidate.explanation.effects) {
    if (!special_case(candidate, entry->info, at).cause.empty()) return true;
    at += entry->info.parameters.size();
  }
  return false;
}

/// Whether a candidate ended where it is another one (EffectInfo::where_equal, EffectInfo::where_small) that scores like
/// it. Both say the same, and the other needs fewer parameters. If two parameters are equal, it is enough that the other
/// one fits the training data as well. On held-out data the two then differ only in what both have. A cause with a small
/// extra part bends to the rest of the others. It is then enough that these leave what the noise allows.
inline bool is_in_fact(const Candidate& simpler, const Candidate& candidate, const Model& model) {
  std::size_t first = model.calibrated().size();
  for (const CatalogueEntry* entry : candidate.explanation.effects) {
    const std::size_t at = first;
    first += entry->info.parameters.size();
    const SpecialCase in_fact = special_case(candidate, entry->info, at);
    if (in_fact.cause.empty()) continue;
    // Constants are free in every explanation: only its effects tell it from another one.
    std::vector<std::string> ids, simpler_ids;
    for (const CatalogueEntry* one : candidate.explanation.effects)
      if (one != entry) ids.push_back(one->info.id);
    if (!plant::is_calibration(in_fact.cause)) ids.push_back(in_fact.cause);
    for (const CatalogueEntry* one : simpler.explanation.effects) simpler_ids.push_back(one->info.id);
    std::sort(ids.begin(), ids.end());
    std::sort(simpler_ids.begin(), simpler_ids.end());
    if (ids == simpler_ids && in_the_running(simpler) &&
        (scores_alike(simpler, candidate) || (in_fact.but_for_a_bit && is_at_the_noise(simpler)) ||
         (in_fact.the_same &&
          (is_nearly(simpler.held_out, candidate.held_out) || is_nearly(simpler.train, candidate.train)))))
      return true;
  }
  return false;
}

/// Marks effects beside moved constants that alone bring everything to the noise. The constants are the answer, and such an
/// effect only fits noise.
inline void mark_idle(std::vector<Candidate>& candidates) {
  for (Candidate& one : candidates) one.idle = false;
  for (const Candidate& constants : candidates)
    if (constants.explanation.effects.empty() && !constants.explanation.released.empty() &&
        is_at_the_noise(constants) && holds(Rule::constants_first))
      for (Candidate& one : candidates) one.idle = one.idle || does_nothing_more(one, constants);
}

/// Whether a set has a cause among others that is another one to the last: its two parameters are the same.
/// @param alone  an explanation by that one cause
inline bool has_the_same(const Candidate& set, const Explanation& alone, const Model& model) {
  std::size_t at = model.calibrated().size();
  for (const CatalogueEntry* entry : set.explanation.effects) {
    if (entry == alone.effects.front() && special_case(set, entry->info, at).the_same) return true;
    at += entry->info.parameters.size();
  }
  return false;
}

/// Marks candidates that another one says with less (is_in_fact()): all at once, so that a simpler one that is itself marked
/// still counts. A cause that is so alone and has nothing of its own beside others either is none of a set.
inline void mark_twins(std::vector<Candidate>& candidates, const Model& model) {
  std::vector<Candidate*> twins;
  for (Candidate& one : candidates)
    if (std::any_of(candidates.begin(), candidates.end(),
                    [&](const Candidate& simpler) { return is_in_fact(simpler, one, model); }))
      twins.push_back(&one);
  if (twins.empty() || !holds(Rule::twins)) return;
  std::vector<const Explanation*> alone;
  for (Candidate* one : twins) {
    one->idle = true;
    if (one->explanation.effects.size() == 1) alone.push_back(&one->explanation);
  }
  for (Candidate& one : candidates)
    for (const Explanation* twin : alone)
      one.idle = one.idle || (one.explanation.effects.size() > 1 && has_the_same(one, *twin, model));
}

/// Deviance of residuals, all signals together.
/// @param correlation  samples of each signal that count as one
inline double misfit_of(const SignalSums& sums, const std::array<double, signal_count>& correlation) {
  double deviance = 0.0;
  for (std::size_t i = 0; i < signal_count; ++i)
    deviance += misfit(sums.samples[i], correlation[i], sums.mean(i));
  return deviance;
}

/// Deviance of a candidate that was weighed, without what it costs.
inline double misfit_of(const Candidate& candidate) {
  return candidate.train_deviance + candidate.held_out_deviance;
}

/// Deviance of every candidate and its probability among them; 0 for those that end on their bounds or were not
/// judged on held-out data.
///
/// The deviance is that of Gaussian residuals of unknown variance, over training and held-out data, with parameters from
/// training alone. Samples are divided by the correlation length of the best candidate's residuals. Added are a
/// penalty for every parameter, own state and start that nobody measures (cost_of_parameters()), the price of
/// the constants that moved, and a penalty for every cause. A candidate that scores like the best is given its fit. Then
/// only the penalties differ.
///
/// Every model is wrong, and a model error does not average out like noise. So the odds against a candidate are at most
/// those of the difference in standard errors (Vuong 1989), by leaving out blocks of the training and the held-out data. If
/// a candidate is better in some parts of the recording and worse in others, no number of rows makes it certain. If it is
/// better in every block, it is beyond doubt, however unlike the blocks are (BlockByBlock). That holds for the data alone.
/// The penalty of a richer explanation stays, so that the simpler one is named if the data do not decide.
inline void weigh(std::vector<Candidate>& candidates, const Weight& weight, const Model& model) {
  double samples = 0.0;
  for (std::size_t i = 0; i < signal_count; ++i)
    samples += candidates.front().train.samples[i] / weight.correlation[i];
  for (Candidate& one : candidates)
    one.penalty =
        cost_of_parameters(one, model, most_price_of_parameter(samples), inflation_of(one, weight)) +
        usual_rarity * static_cast<double>(moved_constants(one, model).size()) + one.explanation.rarity() +
        price_of_constants(one, model);
  mark_idle(candidates);
  const Candidate* best = nullptr;
  for (Candidate& one : candidates) {
    one.train_deviance = misfit_of(one.train, weight.correlation);
    one.held_out_deviance = misfit_of(one.held_out, weight.held_out);
    one.deviance = one.penalty + one.train_deviance + one.held_out_deviance;
    Shown shown = weight.shown;
    shown.by_reaching_the_noise = is_at_the_noise(one);
    one.on_bounds = ends_on_bounds(one, model, shown);
    one.makes_worse = !one.explanation.effects.empty() && one.held_out.any() &&
                      one.held_out_deviance > candidates.front().held_out_deviance;
  }
  mark_twins(candidates, model);
  for (const Candidate& one : candidates)
    if (in_the_running(one) && (best == nullptr || one.deviance < best->deviance)) best = &one;
  const auto merged = [&](const SignalSums& sums, const std::array<double, signal_count>& correlation) {
    std::size_t merge = 1;
    for (std::size_t i = 0; i < signal_count; ++i)
      if (sums.samples[i] > 0.0) merge = std::max(merge, blocks_to_merge(sums.samples[i], correlation[i]));
    return merge;
  };
  const auto standard_error = [&](const SignalSums& a, const SignalSums& b,
                                  const std::array<double, signal_count>& correlation) {
    const auto difference = [&](const SignalSums& x, const SignalSums& y) {
      return misfit_of(x, correlation) - misfit_of(y, correlation);
    };
    return block_jackknife(a, b, merged(a, correlation), difference).standard_error;
  };
  // Standard error of how much better one fits than the other, pooled; or as large as leaves the difference as many
  // standard errors large as it is block by block, where that is more.
  const auto uncertainty = [&](const Candidate& one, const Candidate& other) {
    const bool first = misfit_of(one) < misfit_of(other);
    const Candidate &good = first ? one : other, &bad = first ? other : one;
    const double pooled = std::hypot(standard_error(bad.train, good.train, weight.correlation),
                                     standard_error(bad.held_out, good.held_out, weight.held_out));
    BlockByBlock by_block;
    by_block.add(bad.train, good.train, merged(bad.train, weight.correlation), weight.correlation);
    by_block.add(bad.held_out, good.held_out, merged(bad.held_out, weight.held_out), weight.held_out);
    if (!by_block.decides(is_at_the_noise(good))) return pooled;
    return std::min(pooled,
                    (misfit_of(bad) - misfit_of(good)) / by_block.value() * by_block.standard_error());
  };
  if (best == nullptr) {
    for (Candidate& one : candidates) one.probability = 0.0;
    return;
  }
  const double fit_of_best = best->deviance - best->penalty;
  const Candidate* least = best;
  for (Candidate& one : candidates) {
    if (&one != best && scores_alike(one, *best)) one.deviance = fit_of_best + one.penalty;
    if (in_the_running(one) && one.deviance < least->deviance) least = &one;
  }
  for (Candidate& one : candidates) {
    one.probability = 0.0;
    if (!in_the_running(one)) continue;
    one.against = log_odds(one.deviance - least->deviance,
                           holds(Rule::evidence_bound) ? uncertainty(one, *least) : 0.0);
  }
  // The cost of parameters is not part of that. A richer explanation that does not fit better beyond doubt stays behind by
  // its cost.
  std::vector<Candidate*> simplest_first;
  for (Candidate& one : candidates)
    if (in_the_running(one)) simplest_first.push_back(&one);
  sort_by(simplest_first, [&](const Candidate* one) { return one->penalty; });
  for (std::size_t i = 0; i < simplest_first.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      Candidate& richer = *simplest_first[i];
      const Candidate& simpler = *simplest_first[k];
      const double extra = richer.penalty - simpler.penalty;
      const double better = simpler.deviance - simpler.penalty - (richer.deviance - richer.penalty);
      const double uncertain = uncertainty(richer, simpler);
      if (better > decision.beyond_doubt * uncertain) continue;
      const double proven =
          std::min(better, 2.0 * log_odds_of(std::max(better, 0.0) / std::max(uncertain, 1e-12)));
      richer.against = std::max(richer.against, simpler.against + 0.5 * (extra - std::max(proven, 0.0)));
    }
  std::vector<Candidate*> weighed;
  std::vector<double> against;
  for (Candidate& one : candidates)
    if (in_the_running(one)) weighed.push_back(&one), against.push_back(one.against);
  const double first = *std::min_element(against.begin(), against.end());
  for (double& one : against) one -= first;
  const std::vector<double> shares = probabilities(against);
  for (std::size_t i = 0; i < weighed.size(); ++i)
    weighed[i]->against = against[i], weighed[i]->probability = shares[i];
}

/// Change that a candidate makes to the empty explanation's residuals, all signals in one vector.
inline Eigen::VectorXd signature(const Candidate& candidate, const Candidate& empty,
                                 const FitProblem& problem) {
  const auto with = Attribution::residuals(candidate, problem, candidate.fit.starts);
  const auto without = Attribution::residuals(empty, problem, empty.fit.starts);
  std::size_t count = 0;
  for (const auto& one : with) count += one.size();
  Eigen::VectorXd change(static_cast<Eigen::Index>(count));
  for (std::size_t i = 0; i < signal_count; ++i) assert(with[i].size() == without[i].size());
  Eigen::Index at = 0;
  for (std::size_t i = 0; i < signal_count; ++i)
    for (std::size_t k = 0; k < with[i].size(); ++k) change[at++] = with[i][k] - without[i][k];
  return change;
}

/// Cosine of two signatures; 0 where one is nothing.
inline double likeness(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  assert(a.size() == b.size());
  const double norm = a.norm() * b.norm();
  return norm > 0.0 ? a.dot(b) / norm : 0.0;
}

}  // namespace thermopower::gap::engine
