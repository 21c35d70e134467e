// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/diagnosis.hpp>
#include <thermopower/gap/compare/score.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

/// @file verdict_table.hpp
/// The verdict, read off few numbers that the report prints. Nothing else sets or changes it.

namespace thermopower::gap::engine {

/// The limits of the verdict table.
struct VerdictLimits {
  /// Multiple of the noise floor up to which the configured model passes.
  double passes = floor_known_to;
  /// Multiple of the noise floor up to which a signal counts as near it.
  double near_floor = 1.5;
  /// The most that noise which remembers may come to by chance, as a multiple of the floor: in a few hundred samples.
  double most_by_chance = 2.0;
  /// Share of the gap that the lower end of an interval must reach to be material.
  double material = 0.05;
  /// The same where a rest stays, for constants alone or for a cause that spares them all: what is missing bends constants, too, but
  /// seldom so far that they close half of the gap.
  double mostly = 0.5;
  /// Share of what refitted constants leave that a cause may leave: a fifth better than constants alone.
  double of_constants = 0.8;
  /// Probability from which one class is the answer.
  double sure = 0.9;
  /// Probability from which a class is named beside a rest.
  double likely = 0.5;
};

/// The limits in force.
inline constexpr VerdictLimits verdict_limits{};

/// The largest multiple of its floor that a signal reaches; `error` picks the score of a signal.
template <class Error>
double times_floor(const std::vector<GapScore>& table, Error&& error) {
  double worst = 0.0;
  for (const GapScore& one : table)
    if (one.noise_floor > 0.0) worst = std::max(worst, error(one) / one.noise_floor);
  return worst;
}

/// The end of a one-sided 95 % interval on these very data. It is computed from the printed end, which is two-sided and
/// wider by what no single recording can show.
inline double proven_end(double value, double end) {
  constexpr double narrower = 2.015 / 2.571;  // Student's t of six blocks, one-sided against two-sided
  const double own = std::sqrt(std::max(std::pow(end - value, 2.0) - std::pow(between_days, 2.0), 0.0));
  return value + narrower * std::copysign(own, end - value);
}

/// The share of the held-out gap that an explanation leaves, from the printed table. It is the geometric mean over the
/// signals that have a gap. Signals near their floor say nothing.
inline ShareLeft share_left(const std::vector<GapScore>& table) {
  double configured = 0.0, constants = 0.0, most = 0.0, count = 0.0;
  for (const bool any : {false, true}) {  // where no signal has a gap, all of them count
    for (const GapScore& one : table) {
      if (!(one.before > 0.0) || !(one.noise_floor > 0.0)) continue;
      if (!any && !(one.before > verdict_limits.near_floor * one.noise_floor)) continue;
      const double after = std::max(one.after, one.noise_floor);
      configured += std::log(after / std::max(one.before, one.noise_floor));
      constants += std::log(after / std::max(std::min(one.recalibrated, one.before), one.noise_floor));
      most += proven_end(std::log(after / std::max(one.before, one.noise_floor)),
                         std::log(std::max(1.0 - one.ci95.low, 1e-12)));
      count += 1.0;
    }
    if (count > 0.0) break;
  }
  if (!(count > 0.0)) return {};
  return {std::exp(configured / count), std::exp(most / count), std::exp(constants / count)};
}

/// The numbers of an explanation, from the printed table and its probability.
inline DecisionNumbers numbers_of(const std::vector<GapScore>& table, double probability) {
  DecisionNumbers numbers;
  numbers.configured = times_floor(table, [](const GapScore& one) { return one.before; });
  for (const GapScore& one : table) numbers.by_chance = std::max(numbers.by_chance, one.by_chance);
  numbers.refitted = times_floor(table, [](const GapScore& one) { return one.recalibrated; });
  numbers.left = times_floor(table, [](const GapScore& one) { return one.after; });
  numbers.share = share_left(table);
  numbers.probability = probability;
  return numbers;
}

/// A verdict with its reason.
struct Decision {
  Verdict verdict = Verdict::unexplained;         ///< in one word
  Reason reason = Reason::no_explanation_likely;  ///< why
};

/// The verdict table.
/// @param numbers         of the likeliest explanation
/// @param only_constants  whether that explanation has no effect, only moved constants
/// @param beyond_known    how many of the refitted constants are beyond what the model file says is known
/// @param spares_constants  whether those beside that explanation's effects are
inline Decision decide(const DecisionNumbers& numbers, bool only_constants, int beyond_known,
                       bool spares_constants) {
  const VerdictLimits& limit = verdict_limits;
  const bool within_known = beyond_known == 0;
  assert(numbers.probability >= 0.0 && numbers.probability <= 1.0 + 1e-9);
  const double passes = std::max(limit.passes, std::min(numbers.by_chance, limit.most_by_chance));
  if (numbers.configured <= passes && numbers.twice_horizon <= limit.near_floor)
    return {Verdict::no_gap, Reason::configured_model_passes};
  const bool near = numbers.left <= limit.near_floor;
  const bool is_proven = 1.0 - numbers.share.most >= limit.material;
  if (!is_proven && numbers.configured <= limit.near_floor && numbers.twice_horizon <= limit.near_floor)
    return {Verdict::no_gap, Reason::configured_model_passes};
  // Near the floor as configured, too, and no better: the gap shows in longer windows, and constants do not close it.
  const bool closes_nothing = !is_proven && numbers.configured <= limit.near_floor;
  const bool closes_most = 1.0 - numbers.share.most >= limit.mostly;
  if (only_constants && !near && closes_most) return {Verdict::partial, Reason::constants_close_most};
  if (only_constants && (!near || closes_nothing))
    return {Verdict::unexplained, Reason::constants_leave_a_rest};
  // One factor in a unit, a gear or a supply does what the moved constants do, alone or beside an effect.
  if (near && numbers.common_factor != CommonFactor::none && !within_known)
    return {
        numbers.common_factor == CommonFactor::may_be_constant ? Verdict::ambiguous : Verdict::unexplained,
        Reason::common_factor};
  if (only_constants)
    return {Verdict::explained, within_known ? Reason::constants_within_known : Reason::constants_moved};
  const bool beats_constants = numbers.share.of_refitted_constants <= limit.of_constants;
  // An explanation that closes the gap need not beat constants that do as well by leaving what is known of them, where it spares
  // them: their moves count in its probability. Where it moves them as well, the data do not tell it from them.
  const bool closes = is_proven && (beats_constants || (closes_most && spares_constants && !within_known));
  const bool adds_nothing = !beats_constants && !spares_constants;
  if (near && adds_nothing)
    return numbers.refitted <= limit.near_floor ? Decision{Verdict::ambiguous, Reason::cause_or_constants}
                                                : Decision{Verdict::unexplained, Reason::closes_too_little};
  if (near && within_known && numbers.probability < limit.sure && numbers.refitted <= limit.near_floor)
    return {Verdict::explained, Reason::constants_within_known};
  if (near)
    return numbers.probability >= limit.sure ? Decision{Verdict::explained, Reason::cause_explains}
                                             : Decision{Verdict::ambiguous, Reason::several_explain};
  if (!closes) return {Verdict::unexplained, Reason::closes_too_little};
  // Where another class is about as likely, one name says too much, however large the part that is closed.
  const bool has_rivals = numbers.probability < limit.sure && numbers.together >= limit.sure;
  if (has_rivals) return {Verdict::ambiguous, Reason::several_close_a_part};
  if (numbers.probability >= limit.likely) return {Verdict::partial, Reason::cause_closes_a_part};
  return {Verdict::unexplained, Reason::no_explanation_likely};
}

}  // namespace thermopower::gap::engine
