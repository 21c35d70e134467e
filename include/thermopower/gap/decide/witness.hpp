// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/decide/gap_taken.hpp>
#include <thermopower/gap/diagnosis.hpp>

#include <algorithm>
#include <functional>
#include <initializer_list>
#include <vector>

namespace thermopower::gap::engine {

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

/// The place that is blamed most, of those that take anything of the gap away; null where nobody is blamed.
inline const Location* most_blamed(const std::vector<Location>& where) {
  const auto found = std::find_if(where.begin(), where.end(), takes_gap_away);
  return found != where.end() ? &*found : nullptr;
}

/// Whether little of a course that followed nothing recorded is left once causes are in the model. A balance remembers
/// nothing: what stands in for a heat that no column shows leaves it missing where and when it was.
inline bool ends_the_course(double beside, double before) {
  return before > 0.0 && beside < decision.course_left * before;
}

/// Whether a submodel is one of several.
inline bool is_one_of(std::initializer_list<Submodel> several, const plant::SubmodelName& submodel) {
  return std::any_of(several.begin(), several.end(),
                     [&](Submodel one) { return submodel == plant::SubmodelName(one); });
}

/// Whether a cause is one of an instrument: it changes what is read, and not what is there.
inline bool is_of_an_instrument(const CatalogueEntry& entry) {
  return is_one_of({Submodel::sensing_current, Submodel::sensing_temperature, Submodel::sensing_angle,
                    Submodel::sensing_rate},
                   entry.info.submodel);
}

/// Whether a submodel is a place of a joint.
inline bool is_of_a_joint(const plant::SubmodelName& submodel) {
  return is_one_of({Submodel::mechanical_drive, Submodel::mechanical_friction, Submodel::mechanical_load,
                    Submodel::mechanical_structure},
                   submodel);
}

/// Whether the rows bear witness to what a set of causes has beyond a part of it, or need not: a set that leaves only noise,
/// or hardly anything of what the part leaves, has the data themselves for a witness. What is missing beside the part may follow
/// nothing recorded because an instrument bends the readings that it is drawn from; then that is over with the readings put
/// right, and the rows are a witness of that instrument though they blame nothing.
inline bool is_localised(const Candidate& set, const Candidate& part, const Witness& rows) {
  if (!rows.blames || largest_noise_multiple(set.held_out) <= decision.near_floor ||
      excess(set) < decision.speaks_for_itself * excess(part))
    return true;
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

}  // namespace thermopower::gap::engine
