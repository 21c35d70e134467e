// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/decide/gap_taken.hpp>
#include <thermopower/gap/decide/witness.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace thermopower::gap::engine {

/// Whether some constant moved beside causes by more than a constant can be off by (DecisionThresholds::bent_by, of an inertia
/// bent_inertia_by) and by more than is known of it. A constant that is that far off in fact takes most of the gap away by itself;
/// one that moves that far only beside a cause bends the equation towards another one. What may vanish beside a cause
/// (may_vanish()) does so.
inline bool needs_a_bent_constant(const Candidate& candidate, const Reference& reference,
                                  const Model& model) {
  if (left_over(reference.recalibrated, reference.as_configured) < decision.may_leave) return false;
  const double inertia_by = has_hidden_states(candidate) ? decision.bent_by : decision.bent_inertia_by;
  Eigen::Index at = 0;
  for (const CalibratedConstant& constant : model.calibrated()) {
    const double farthest_by = constant.id == "inertia" ? inertia_by : decision.bent_by;
    const double by = candidate.fit.point[at++], moved = may_vanish(constant) ? by : std::abs(by);
    if (!constant.is_place && moved > std::log(farthest_by) &&
        moved > known_constants.within * model.uncertainty_of(constant))
      return true;
  }
  return false;
}

/// Whether the rows blame a place in another signal than the one that they blame most, and none of the causes of a candidate
/// acts there: what the causes leave may be that fault's.
inline bool misses_a_second_fault(const Candidate& candidate, const std::vector<Location>& where) {
  return std::any_of(where.begin(), where.end(), [&](const Location& one) {
    return one.signal != where.front().signal && takes_gap_away(one) && !acts_in(candidate, one.submodel);
  });
}

/// Whether what the rows blame most began in the middle of a training run and of a held-out one, where it would have shown before:
/// what the catalogue knows is there all along.
inline bool began_in_mid_run(const std::vector<Location>& where) {
  const Location* fault = most_blamed(where);
  if (fault == nullptr) return false;
  const auto began = [&](bool held_out) {
    return std::any_of(fault->only_in.begin(), fault->only_in.end(), [&](const Occurrence& run) {
      return run.held_out == held_out && run.from_s.has_value();
    });
  };
  return began(false) && began(true);
}

/// Whether the rows blame places of a joint, and no cause of a candidate acts in one of them: friction beside a rest where a drive
/// and a structure are at fault. Not asked where a cause brings a state that nobody measures, which a balance takes for
/// another place, or bends the readings; nor of a body, whose loss, heating and storage the rows tell apart less well.
inline bool acts_elsewhere(const Candidate& candidate, const std::vector<Location>& where) {
  const std::vector<const CatalogueEntry*>& effects = candidate.explanation.effects;
  if (has_hidden_states(candidate) || !std::all_of(effects.begin(), effects.end(), [](const auto* entry) {
        return is_of_a_joint(entry->info.submodel);
      }))
    return false;
  bool blamed = false;
  for (const Location& one : where) {
    if (!is_of_a_joint(one.submodel) || !(one.share >= decision.blamed)) continue;
    if (acts_in(candidate, one.submodel)) return false;
    blamed = true;
  }
  return blamed;
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
  const Location* before = most_blamed(rows.where);
  return before != nullptr && before->submodel == blamed && !mends_another && !has_an_instrument(candidate);
}

}  // namespace thermopower::gap::engine
