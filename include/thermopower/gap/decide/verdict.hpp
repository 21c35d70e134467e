// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/sort_by.hpp>
#include <thermopower/gap/decide/covariance.hpp>
#include <thermopower/gap/decide/gap_taken.hpp>
#include <thermopower/gap/decide/reasons.hpp>
#include <thermopower/gap/decide/stand_ins.hpp>
#include <thermopower/gap/decide/witness.hpp>
#include <thermopower/gap/diagnosis.hpp>
#include <thermopower/gap/options.hpp>

#include <algorithm>
#include <cmath>
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

/// Whether an explanation needs its constants further off than another one does, by more than chance: then that it comes as near
/// the noise speaks for what the other has besides, which constants can imitate, and not for them.
inline bool are_dearer(const Candidate& constants, const Candidate& cause, const Model& model) {
  return price_of_constants(constants, model) - price_of_constants(cause, model) > decision.dear_constants;
}

/// Whether the constants of a candidate are so far off that a second cause could stand in their place.
inline bool may_hide_a_cause(const Candidate& candidate, const Model& model) {
  return price_of_constants(candidate, model) > decision.rarity + decision.dear_constants;
}

/// Multiple of the noise above which a part of a set leaves room for a further cause: less is needed where it comes so near with
/// constants far off alone.
inline double least_room_beside(const Candidate& part, const Model& model) {
  return may_hide_a_cause(part, model) ? decision.room_beside_dear_constants : decision.room_for_second;
}

/// Whether a set keeps the constants where they are known to be, at the noise, while a part of it reaches that with constants
/// far off alone: a current sensor's gain is a re-scaling of resistance, heat capacity and conductance.
inline bool spares_the_constants(const Candidate& set, const Candidate& part, const Model& model) {
  return largest_noise_multiple(set.held_out) <= decision.near_floor && are_dearer(part, set, model);
}

/// The smallest part of a set of causes that does its work: a further cause is only named where the set without it
/// stays clearly above the noise and the further one takes away at least half of what is left, in nearly every part of
/// the held-out data, and where the rows blame its submodel, too, or nothing but noise is left. Otherwise it mends
/// small errors of the others' equations.
/// What spares the constants does its work, too.
inline std::size_t parsimonious(const std::vector<Candidate>& candidates, std::size_t chosen,
                                const Model& model, const Witness& rows = {}) {
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
        !spares_the_constants(candidates[chosen], candidates[part], model) &&
        (largest_noise_multiple(candidates[part].held_out) < least_room_beside(candidates[part], model) ||
         excess(candidates[chosen]) > decision.second_takes * excess(candidates[part]) ||
         share_of_blocks(candidates[chosen], candidates[part]) < decision.second_holds ||
         !is_localised(candidates[chosen], candidates[part], rows))) {
      chosen = part;
      smaller = true;
    }
  }
  return chosen;
}

/// The likeliest candidate.
inline std::size_t likeliest(const std::vector<Candidate>& candidates) {
  std::size_t chosen = 0;
  for (std::size_t i = 1; i < candidates.size(); ++i)
    if (candidates[i].probability > candidates[chosen].probability) chosen = i;
  return chosen;
}

/// Indices of the candidates, those of the least deviance first.
inline std::vector<std::size_t> by_deviance(const std::vector<Candidate>& candidates) {
  std::vector<std::size_t> order(candidates.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  sort_by(order, [&](std::size_t i) { return candidates[i].deviance; });
  return order;
}

/// The largest probability among explanations that are no larger than one: what its rivals are measured
/// against.
inline double likeliest_of(const std::vector<Candidate>& candidates, const Candidate& chosen) {
  double largest = 0.0;
  for (const Candidate& one : candidates)
    if (one.explanation.size() <= chosen.explanation.size()) largest = std::max(largest, one.probability);
  return largest;
}

/// The conclusion that the simulation holds.
inline Conclusion nothing_missing() {
  Conclusion result;
  result.verdict = Verdict::no_gap;
  result.reason =
      "with its constants within what is known of them the simulation scores what the noise allows";
  return result;
}

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
/// and the constants that moved by more than is known of them; and enough of some signal for any cause.
inline bool has_readings_enough(const Candidate& candidate, const Model& model) {
  const double free = static_cast<double>(candidate.explanation.parameter_count()) +
                      static_cast<double>(moved_constants(candidate, model).size()) -
                      static_cast<double>(candidate.explanation.released.size());
  double readings = 0.0, most = 0.0;
  for (double samples : candidate.train.samples) {
    readings += samples;
    most = std::max(most, samples);
  }
  return readings >= decision.readings_per_parameter * free && most >= decision.least_readings;
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
  result.chosen = parsimonious(candidates, likeliest(candidates), model, rows);
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
  if (may_be_anything(best, model, weight)) return nothing_known(may_be_of_any_size);
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
    if (rest > decision.may_leave_bent && needs_a_bent_constant(best, reference, model))
      return nothing_known(bends_a_constant);
    if (began_in_mid_run(rows.where)) return nothing_known(was_not_there_before);
    if (leaves_its_place_at_fault(best, rest_above_noise(best.held_out, reference), rows))
      return nothing_known(does_not_mend_its_place);
    if (acts_elsewhere(best, rows.where)) return nothing_known(acts_where_nothing_is_wrong);
    if (best.explanation.effects.size() > 1 && rows.cancels && rows.cancels(best))
      return nothing_known(cancel_each_other);
    result.none_of_these = std::min(decision.doubt_by_rest * rest, 1.0);
  }
  for (std::size_t further = 1; further < best.explanation.effects.size(); ++further)
    result.none_of_these = 1.0 - (1.0 - result.none_of_these) * (1.0 - decision.pair_for_unknown);
  std::vector<std::size_t> order;
  double together = best.probability;
  for (std::size_t i = 1; i < candidates.size(); ++i)
    if (i != result.chosen &&
        candidates[i].probability > decision.alternative * likeliest_of(candidates, best) &&
        (candidates[i].explanation.size() <= best.explanation.size() ||
         spares_the_constants(candidates[i], best, model))) {
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
