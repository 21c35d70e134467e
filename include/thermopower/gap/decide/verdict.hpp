// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/sort_by.hpp>
#include <thermopower/gap/diagnosis.hpp>
#include <thermopower/gap/decide/covariance.hpp>
#include <thermopower/gap/decide/evidence.hpp>
#include <thermopower/gap/options.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace thermopower::gap::engine {

/// What the weighing of the candidates amounts to.
struct Conclusion {
  Verdict verdict = Verdict::insufficient;  ///< in one word
  std::size_t chosen = 0;                   ///< index of the candidate
  std::vector<std::size_t> alternatives;    ///< indices, likeliest first
  double none_of_these = 0.0;               ///< probability that the cause is outside the catalogue
  std::string reason;                       ///< one sentence in plain words
  bool leaves_a_rest = false;               ///< held-out data stay above the noise with the causes
  bool second_is_open = false;              ///< sets disagree about a further cause: look at single ones
};

/// What a cause is measured against: held-out scores without any, in units of the noise floor.
struct Reference {
  SignalSums as_configured;  ///< the model as its file has it
  SignalSums recalibrated;   ///< its constants refitted
};

/// Whether a candidate shrinks some signal's held-out score by more than the tolerance.
inline bool matters(const Candidate& candidate, const Candidate& than, double tolerance) {
  bool better = false;
  for (std::size_t i = 0; i < signal_count; ++i) {
    if (!(candidate.held_out.samples[i] > 0.0)) continue;
    const double ratio = std::sqrt(candidate.held_out.mean(i) / std::max(than.held_out.mean(i), 1e-12));
    better = better || ratio < 1.0 - tolerance;
  }
  return better;
}

/// Logarithm of the factor by which held-out scores shrink from one model to another, the mean over the signals
/// that are above the noise before, with its standard error over blocks.
inline Jackknifed shrinkage(const SignalSums& before, const SignalSums& after, const Weight& weight) {
  std::array<bool, signal_count> counts{};
  bool any = false;
  std::size_t merge = 1;
  for (std::size_t i = 0; i < signal_count; ++i) {
    counts[i] = before.samples[i] > 0.0 && noise_multiple(before, i) > decision.no_gap;
    any = any || counts[i];
    if (before.samples[i] > 0.0)
      merge = std::max(merge, blocks_to_merge(before.samples[i], weight.held_out[i]));
  }
  const auto logarithm = [&](const SignalSums& from, const SignalSums& to) {
    double sum = 0.0, signals = 0.0;
    for (std::size_t i = 0; i < signal_count; ++i) {
      if (!(from.samples[i] > 0.0) || (any && !counts[i])) continue;
      sum += 0.5 * std::log(std::max(from.mean(i), 1e-12) / std::max(to.mean(i), 1e-12));
      signals += 1.0;
    }
    return signals > 0.0 ? sum / signals : 0.0;
  };
  return block_jackknife(before, after, merge, logarithm);
}

/// Whether a cause takes a material and proven part of the held-out gap away, and makes no signal worse.
inline bool is_proven(const Candidate& candidate, const SignalSums& before, const Weight& weight) {
  for (std::size_t i = 0; i < signal_count; ++i) {
    const double grown = noise_multiple(candidate.held_out, i);
    if (grown > decision.no_gap && grown > (1.0 + decision.may_grow) * noise_multiple(before, i))
      return false;
  }
  const Jackknifed shrunk = shrinkage(before, candidate.held_out, weight);
  const double least = shrunk.value - decision.standard_errors * shrunk.standard_error;
  return 1.0 - std::exp(-shrunk.value) > decision.material && 1.0 - std::exp(-least) > decision.proven;
}

/// How far above the noise the worst signal of a candidate remains, as a share of what is there without it: 0 at
/// the noise, 1 where nothing was explained.
inline double left_over(const SignalSums& after, const SignalSums& before) {
  double worst = 0.0;
  for (std::size_t i = 0; i < signal_count; ++i) {
    if (!(after.samples[i] > 0.0)) continue;
    const double excess = std::max(after.mean(i) - 1.0, 0.0), whole = std::max(before.mean(i) - 1.0, 1e-12);
    if (whole > decision.some_gap) worst = std::max(worst, std::sqrt(excess / whole));
  }
  return std::min(worst, 1.0);
}

/// The same of the signals that are above the noise at all, against the larger of both shares: of a signal that hardly had a gap,
/// the last bit of noise is a large share.
inline double rest_above_noise(SignalSums after, const Reference& reference) {
  for (std::size_t i = 0; i < signal_count; ++i)
    if (noise_multiple(after, i) <= decision.no_gap) after.samples[i] = 0.0;
  return std::max(left_over(after, reference.as_configured), left_over(after, reference.recalibrated));
}

/// Sum over the signals of what is above the noise on held-out data, in units of its variance.
inline double excess(const Candidate& candidate) {
  double sum = 0.0;
  for (std::size_t i = 0; i < signal_count; ++i) sum += std::max(candidate.held_out.mean(i) - 1.0, 0.0);
  return sum;
}

/// Share of the blocks of held-out data in which one candidate is better than another, of those in which either is
/// above the noise: where the axis rests, or nothing heats, both are right.
inline double share_of_blocks(const Candidate& better, const Candidate& than) {
  double blocks = 0.0, won = 0.0;
  for (std::size_t k = 0; k < SignalSums::block_count; ++k) {
    double difference = 0.0;
    bool above = false;
    for (std::size_t i = 0; i < signal_count; ++i) {
      if (!(than.held_out.squares[i] > 0.0)) continue;
      const double ours = better.held_out.block_squares[i][k], theirs = than.held_out.block_squares[i][k];
      above = above ||
              std::max(ours, theirs) > decision.no_gap * decision.no_gap * than.held_out.block_samples[i][k];
      difference += (theirs - ours) / than.held_out.squares[i];
    }
    if (above && difference != 0.0) blocks += 1.0;
    if (above && difference > 0.0) won += 1.0;
  }
  return blocks > 0.0 ? won / blocks : 0.0;
}

/// What the measured rows say, as a witness of the causes of candidates.
struct Witness {
  /// Whether they blame a submodel, as they are or once the causes of a candidate are in the model; not asked where empty.
  std::function<bool(const Candidate& known, const plant::SubmodelName& submodel)> blames;
  /// How much is missing beside the causes of a candidate that follows nothing recorded but has a course of its own in time.
  std::function<double(const Candidate& known)> course_beside;
  /// What they blame as they are, the largest first.
  std::vector<Location> where = {};
  /// What they blame once the causes of a candidate are in the model, the largest first.
  std::function<std::vector<Location>(const Candidate& known)> blamed_beside = {};
  /// Whether the causes of a candidate nearly cancel each other: each alone leads further from the rows than none of them.
  std::function<bool(const Candidate& set)> cancels = {};
};

/// How much of what follows nothing recorded is among places, in multiples of what noise leaves; 0 where nothing is.
inline double own_course_in(const std::vector<Location>& where) {
  double most = 0.0;
  for (const Location& one : where)
    if (one.has_own_course) most = std::max(most, one.times_noise);
  return most;
}

/// The submodel that is blamed most, of those that take anything of the gap away; none where nobody is blamed.
inline std::optional<plant::SubmodelName> most_blamed(const std::vector<Location>& where) {
  for (const Location& one : where)
    if (takes_gap_away(one)) return one.submodel;
  return std::nullopt;
}

/// Whether little of a course that followed nothing recorded is left once causes are in the model. A balance remembers
/// nothing: what stands in for a heat that no column shows leaves it missing where and when it was.
inline bool ends_the_course(double beside, double before) {
  return before > 0.0 && beside < decision.course_left * before;
}

/// Whether a cause is one of an instrument: it changes what is read, and not what is there.
inline bool is_of_an_instrument(const CatalogueEntry& entry) {
  for (const Submodel instrument : {Submodel::sensing_current, Submodel::sensing_temperature,
                                    Submodel::sensing_angle, Submodel::sensing_rate})
    if (entry.info.submodel == plant::SubmodelName(instrument)) return true;
  return false;
}

/// Whether the rows bear witness to what a set of causes has beyond a part of it, or need not: a set that leaves only noise
/// has the data themselves for a witness. What is missing beside the part may follow nothing recorded because an instrument
/// bends the readings that it is drawn from; then that is over with the readings put right, and the rows are a witness of
/// that instrument though they blame nothing.
inline bool is_localised(const Candidate& set, const Candidate& part, const Witness& rows) {
  if (!rows.blames || largest_noise_multiple(set.held_out) <= decision.near_floor) return true;
  const auto is_witnessed = [&](const CatalogueEntry& entry) {
    return rows.blames(part, entry.info.submodel) ||
           (rows.course_beside && is_of_an_instrument(entry) &&
            ends_the_course(rows.course_beside(set), rows.course_beside(part)));
  };
  for (const CatalogueEntry* entry : set.explanation.effects) {
    const std::vector<const CatalogueEntry*>& known = part.explanation.effects;
    if (std::find(known.begin(), known.end(), entry) == known.end() && !is_witnessed(*entry)) return false;
  }
  return true;
}

/// The smallest part of a set of causes that does its work: a further cause is only named where the set without it
/// stays clearly above the noise and the further one takes away at least half of what is left, in nearly every part of
/// the held-out data, and where the rows blame its submodel, too, or nothing but noise is left. Otherwise it mends
/// small errors of the others' equations.
inline std::size_t parsimonious(const std::vector<Candidate>& candidates, std::size_t chosen,
                                const Witness& rows = {}) {
  for (bool smaller = true; smaller;) {
    smaller = false;
    std::size_t part = 0;
    for (std::size_t i = 1; i < candidates.size(); ++i) {
      const bool within = candidates[i].explanation.size() + 1 == candidates[chosen].explanation.size() &&
                          candidates[chosen].explanation.includes(candidates[i].explanation);
      if (within && !candidates[i].on_bounds && candidates[i].held_out.any() &&
          (part == 0 || candidates[i].deviance < candidates[part].deviance))
        part = i;
    }
    if (part != 0 && !candidates[chosen].explanation.effects.empty() &&
        (largest_noise_multiple(candidates[part].held_out) < decision.room_for_second ||
         excess(candidates[chosen]) > decision.second_takes * excess(candidates[part]) ||
         share_of_blocks(candidates[chosen], candidates[part]) < decision.second_holds ||
         !is_localised(candidates[chosen], candidates[part], rows))) {
      chosen = part;
      smaller = true;
    }
  }
  return chosen;
}

/// The largest probability among explanations that are no larger than one: what its rivals are measured
/// against.
inline double likeliest_of(const std::vector<Candidate>& candidates, const Candidate& chosen) {
  double largest = 0.0;
  for (const Candidate& one : candidates)
    if (one.explanation.size() <= chosen.explanation.size()) largest = std::max(largest, one.probability);
  return largest;
}

/// What is said where nothing above the noise is left.
inline constexpr const char* wholly_explained =
    "the named cause brings held-out data near the noise, and nothing else does";

/// The same where several explanations do.
inline constexpr const char* several_explain = "several explanations bring held-out data near the noise";

/// The same where the printed table shows a signal above the noise.
inline constexpr const char* several_leave_a_rest =
    "several explanations bring held-out data nearer to the noise, none of them all the way, and what remains does not "
    "tell which";

/// What is said where several explanations take a proven part away and leave a rest.
inline constexpr const char* several_take_a_part =
    "several explanations take a proven part of the gap away, and what remains of it does not tell which";

/// What is said where constants alone do not bring the data to the noise, and no effect does better.
inline constexpr const char* constants_leave_a_rest =
    "there is a gap; other constants take the most of it away, and no effect of the catalogue explains what they "
    "leave above the noise";

/// What is said where the parts of the data disagree about a cause that leaves most of the gap.
inline constexpr const char* stands_in_for_another =
    "there is a gap, and the cause that lowers it most leaves most of it and is of another size in each part of the data: "
    "it stands in for one that the catalogue lacks";

/// What is said where a cause that leaves a rest takes a constant along that nothing else asks to move.
inline constexpr const char* bends_a_constant =
    "there is a gap, and the cause that lowers it most leaves a rest and needs a constant further off than a constant can be "
    "that other constants alone do not show: together they stand in for a cause that the catalogue lacks";

/// What is said where the place of a cause, or the place that was at fault, is still to blame with the cause in the model.
inline constexpr const char* does_not_mend_its_place =
    "there is a gap, and the cause that lowers it most leaves a good part of it and its place at fault: it stands in for one "
    "that the catalogue lacks";

/// What is said of causes that are large and of opposite sign.
inline constexpr const char* cancel_each_other =
    "there is a gap, and the causes that lower it most leave a rest and nearly cancel each other, each of them larger than "
    "what is seen: their difference stands in for a cause that the catalogue lacks";

/// What is said where the printed table does not prove that the causes take a part away.
inline constexpr const char* nothing_is_proven =
    "there is a gap, and what lowers it most takes no part of it away that all held-out rows prove, beyond what other "
    "constants do";

/// What is said where nothing that a cause follows orders what is missing.
inline constexpr const char* follows_nothing_recorded =
    "there is a gap that follows nothing that a cause follows but has a course of its own, in time or over the angle; what "
    "lowers it most follows that course only in part";

/// What is said beside a rest.
inline constexpr const char* partly_explained =
    "the named cause takes a proven part of the held-out gap away, and the rest stays above the noise";

/// The conclusion that the simulation holds.
inline Conclusion nothing_missing() {
  Conclusion result;
  result.verdict = Verdict::no_gap;
  result.reason =
      "with its constants within what is known of them the simulation scores what the noise allows";
  return result;
}

/// What is said where the simulation as configured is near the noise, and no cause proves to bring it nearer.
inline constexpr const char* is_as_near =
    "the simulation is as near the noise as an explanation would have to bring it, and no cause makes that better on all "
    "held-out rows";

/// What is said where constants bring it there, and a cause takes little of what they leave.
inline constexpr const char* constants_come_as_near =
    "with its constants within what is known of them the simulation is as near the noise as an explanation would have to "
    "bring it, and no cause takes more than a little of the rest";

/// The conclusion that the simulation is near the noise, and what it is above it by too little for a cause.
inline Conclusion nothing_worth_a_cause(const char* reason) {
  Conclusion result = nothing_missing();
  result.reason = reason;
  return result;
}

/// The conclusion that nothing known is to blame.
inline Conclusion nothing_known(const char* reason) {
  Conclusion result;
  result.verdict = Verdict::unexplained;
  result.none_of_these = decision.unknown;
  result.reason = reason;
  return result;
}

/// Whether the training data have readings enough for what an explanation leaves free: the parameters of its effects,
/// and the constants that moved by more than is known of them.
inline bool has_readings_enough(const Candidate& candidate, const Model& model) {
  const double free = static_cast<double>(candidate.explanation.parameter_count()) +
                      static_cast<double>(moved_constants(candidate, model).size()) -
                      static_cast<double>(candidate.explanation.released.size());
  double readings = 0.0;
  for (double samples : candidate.train.samples) readings += samples;
  return readings >= decision.readings_per_parameter * free;
}

/// Whether some constant moved beside causes by more than a constant can be off by (DecisionThresholds::bent_by) and by more
/// than is known of it. A constant that is that far off in fact takes most of the gap away by itself; one that moves that far
/// only beside a cause bends the equation towards another one.
inline bool needs_a_bent_constant(const Candidate& candidate, const Reference& reference,
                                  const Model& model) {
  if (left_over(reference.recalibrated, reference.as_configured) < decision.may_leave) return false;
  Eigen::Index at = 0;
  for (const CalibratedConstant& constant : model.calibrated()) {
    const double moved = std::abs(candidate.fit.point[at++]);
    if (!constant.is_place && moved > std::log(decision.bent_by) &&
        moved > known_constants.within * model.uncertainty_of(constant))
      return true;
  }
  return false;
}

/// Whether one of the causes of a candidate acts in a submodel.
inline bool acts_in(const Candidate& candidate, const plant::SubmodelName& submodel) {
  const std::vector<const CatalogueEntry*>& effects = candidate.explanation.effects;
  return std::any_of(effects.begin(), effects.end(),
                     [&](const CatalogueEntry* entry) { return entry->info.submodel == submodel; });
}

/// Whether one of the causes of a candidate is one of an instrument.
inline bool has_an_instrument(const Candidate& candidate) {
  const std::vector<const CatalogueEntry*>& effects = candidate.explanation.effects;
  return std::any_of(effects.begin(), effects.end(),
                     [](const CatalogueEntry* entry) { return is_of_an_instrument(*entry); });
}

/// Whether some cause of a candidate brings a state that nobody measures.
inline bool has_hidden_states(const Candidate& candidate) {
  const std::vector<const CatalogueEntry*>& effects = candidate.explanation.effects;
  return candidate.hidden_starts > 0 ||
         std::any_of(effects.begin(), effects.end(),
                     [](const CatalogueEntry* entry) { return !entry->info.states.empty(); });
}

/// Whether the rows blame a place in another signal than the one that they blame most, and none of the causes of a candidate
/// acts there: what the causes leave may be that fault's.
inline bool misses_a_second_fault(const Candidate& candidate, const std::vector<Location>& where) {
  return std::any_of(where.begin(), where.end(), [&](const Location& one) {
    return one.signal != where.front().signal && takes_gap_away(one) && !acts_in(candidate, one.submodel);
  });
}

/// Whether causes that leave a good part of the gap leave the place at fault that they should mend: with the causes in the
/// model the rows blame a submodel most that one of them acts in, or the one that they blamed most before, where none of
/// them acts. A balance does not know a state that nobody measures and blames the place that has it: a cause with one is
/// asked about the other place only. What acts in a place that was blamed, too, has mended that one: another fault is left.
/// Instruments bend the readings that balances are drawn from: they are asked about their own place only.
/// @param rest  share of the gap that the causes leave
inline bool leaves_its_place_at_fault(const Candidate& candidate, double rest, const Witness& rows) {
  if (!rows.blamed_beside || rest <= decision.may_leave_in_place ||
      misses_a_second_fault(candidate, rows.where))
    return false;
  const std::vector<Location> left = rows.blamed_beside(candidate);
  if (left.empty()) return false;
  const plant::SubmodelName& blamed = left.front().submodel;
  if (acts_in(candidate, blamed)) return takes_gap_away(left.front()) && !has_hidden_states(candidate);
  const bool mends_another = std::any_of(rows.where.begin(), rows.where.end(), [&](const Location& one) {
    return takes_gap_away(one) && acts_in(candidate, one.submodel);
  });
  return blamed == most_blamed(rows.where) && !mends_another && !has_an_instrument(candidate);
}

/// Whether an explanation by constants alone needs them further off than a cause does, by more than chance: then that they
/// come as near the noise speaks for the cause, which they can imitate, and not for them.
inline bool are_dearer(const Candidate& constants, const Candidate& cause, const Model& model) {
  return price_of_constants(constants, model) - price_of_constants(cause, model) > decision.dear_constants;
}

/// Whether constants within what is known of them bring held-out data as near the noise as an explanation has to, and a cause
/// takes less of that away than one at the limit of no gap would: noise that remembers, or a first reading that is off, is lowered
/// as much by whatever is free to follow it.
inline bool is_worth_no_cause(const Candidate& constants, const Candidate& cause, const Weight& weight) {
  return constants.held_out.any() && largest_noise_multiple(constants.held_out) <= decision.near_floor &&
         1.0 - std::exp(-shrinkage(constants.held_out, cause.held_out, weight).value) < decision.material;
}

/// Draws the conclusion. `candidates` are weighed; the first one is the empty explanation.
/// @param rows  what the measured rows say; where not given, they blame whatever is asked
inline Conclusion conclude(const std::vector<Candidate>& candidates, const Reference& reference,
                           const Weight& weight, const Options& options, const Model& model,
                           const Witness& rows = {}) {
  Conclusion result;
  const Candidate& empty = candidates.front();
  for (std::size_t i = 1; i < candidates.size(); ++i)
    if (candidates[i].probability > candidates[result.chosen].probability) result.chosen = i;
  if (result.chosen != 0) result.chosen = parsimonious(candidates, result.chosen, rows);
  const Candidate& best = candidates[result.chosen];
  const bool only_constants = result.chosen != 0 && best.explanation.effects.empty();
  // Several constants, each within what is known of it, can stand for one that is further off: where that one is the
  // likelier answer, and the simulation as configured does not hold, it is the answer.
  const bool one_is_off = only_constants && largest_noise_multiple(reference.as_configured) > decision.no_gap;
  if (!one_is_off && (result.chosen == 0 || !matters(best, empty, options.tolerance))) {
    // Nothing helps: either nothing is missing, or nothing known.
    if (largest_noise_multiple(empty) < decision.no_gap) return nothing_missing();
    return nothing_known("there is a gap, and no effect of the catalogue lowers it on held-out data");
  }
  if (!best.explanation.effects.empty() && !has_readings_enough(best, model))
    return nothing_known(
        "there is a gap, and the explanation that lowers it most has more free parameters and moved constants than so "
        "few readings can decide");
  const double multiple_left = largest_noise_multiple(best.held_out);
  const double share_left = left_over(best.held_out, reference.as_configured);
  const bool near = multiple_left <= decision.near_floor;
  if (near && !only_constants && !are_dearer(empty, best, model) && is_worth_no_cause(empty, best, weight))
    return nothing_worth_a_cause(constants_come_as_near);
  const bool proven = is_proven(best, reference.as_configured, weight) &&
                      (only_constants || is_proven(best, reference.recalibrated, weight));
  if (near) {
    // Half way between "at the noise" and "clearly not", or a share of the gap that small.
    const double doubt = std::min(decision.doubt_above_floor * (multiple_left - decision.near_floor),
                                  decision.doubt_by_share * (share_left - decision.share_of_error));
    result.none_of_these = 1.0 / (1.0 + std::exp(-std::clamp(doubt, -30.0, 30.0)));
  } else if (only_constants) {
    return nothing_known(constants_leave_a_rest);
  } else if (!proven) {
    return nothing_known("there is a gap, and no effect of the catalogue takes a proven part of it away");
  } else {
    const double rest = std::max(share_left, left_over(best.held_out, reference.recalibrated));
    if (rest > decision.may_leave && !is_agreed_upon(best, model, weight))
      return nothing_known(stands_in_for_another);
    if (needs_a_bent_constant(best, reference, model)) return nothing_known(bends_a_constant);
    if (leaves_its_place_at_fault(best, rest_above_noise(best.held_out, reference), rows))
      return nothing_known(does_not_mend_its_place);
    if (best.explanation.effects.size() > 1 && rows.cancels && rows.cancels(best))
      return nothing_known(cancel_each_other);
    result.none_of_these = std::min(decision.doubt_by_rest * rest, 1.0);
  }
  if (best.explanation.effects.size() > 1)
    result.none_of_these = 1.0 - (1.0 - result.none_of_these) * (1.0 - decision.pair_for_unknown);
  std::vector<std::size_t> order;
  double together = best.probability;
  for (std::size_t i = 1; i < candidates.size(); ++i)
    if (i != result.chosen &&
        candidates[i].probability > decision.alternative * likeliest_of(candidates, best) &&
        candidates[i].explanation.size() <= best.explanation.size()) {
      order.push_back(i);
      together += candidates[i].probability;
    }
  sort_by(order, [&](std::size_t i) { return -candidates[i].probability; });
  result.alternatives = order;
  result.leaves_a_rest = !near;
  if (near) {
    result.verdict = order.empty() ? Verdict::explained : Verdict::ambiguous;
    result.reason = order.empty() ? wholly_explained : several_explain;
  } else if (best.probability < decision.likelier_than_all * together) {
    result.second_is_open = best.explanation.effects.size() > 1;
    result.verdict = Verdict::ambiguous;
    result.reason = several_take_a_part;
  } else {
    result.verdict = Verdict::partial;
    result.reason = partly_explained;
  }
  return result;
}

}  // namespace thermopower::gap::engine
