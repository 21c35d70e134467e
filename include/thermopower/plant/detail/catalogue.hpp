// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/calibration_id.hpp>
#include <thermopower/plant/catalogue.hpp>

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

namespace thermopower::plant {

namespace detail {

/// @param two    places of two parameters of an effect
/// @param words  what is said of it there
/// @param cause  what it is there
inline void check_special_case(const std::pair<int, int>& two, const char* words, const std::string& cause,
                               const EffectInfo& info) {
  const auto is_place = [&](int i) { return i >= 0 && i < static_cast<int>(info.parameters.size()); };
  const std::string where = "effect '" + info.id + "', what it is where " + words + ": ";
  if (!is_place(two.first) || !is_place(two.second) || two.first == two.second)
    throw InvalidInput(where + "expected two places of the list of parameters (from 0)");
  const Parameter &one = info.parameters[static_cast<std::size_t>(two.first)],
                  &other = info.parameters[static_cast<std::size_t>(two.second)];
  if (one.unit != other.unit || one.logarithmic || other.logarithmic)
    throw InvalidInput(where + "'" + one.name + "' and '" + other.name +
                       "' need the same unit, and neither may be logarithmic");
  if (cause.empty() || cause == info.id) throw InvalidInput(where + "expected the id of another cause");
}

inline void check(const Parameter& parameter, int place, const std::string& effect, const HookSet& hooks) {
  const std::string where = effect + ", parameter '" + parameter.name + "': ";
  if (parameter.name.empty()) throw InvalidInput(effect + ": a parameter has no name");
  if (parameter.index >= 0 && parameter.index != place)
    throw InvalidInput(where + "the effect reads it as number " + std::to_string(parameter.index) +
                       ", but it is number " + std::to_string(place) + " of the list (from 0)");
  if (!(parameter.lower < parameter.upper)) throw InvalidInput(where + "lower must be below upper");
  if (parameter.logarithmic && !(parameter.lower > 0.0))
    throw InvalidInput(where + "a logarithmic parameter needs a lower bound above 0");
  if (parameter.starts.empty()) throw InvalidInput(where + "expected at least one start");
  for (double start : parameter.starts)
    if (!(start >= parameter.lower && start <= parameter.upper))
      throw InvalidInput(where + "a start lies outside the bounds");
  if (parameter.standard &&
      !(*parameter.standard >= parameter.lower && *parameter.standard <= parameter.upper))
    throw InvalidInput(where + "its standard value lies outside the bounds");
  if ((parameter.starts_relative_to == Input::drive_A && !hooks.any_axis()) ||
      ((parameter.starts_relative_to == Input::power_param ||
        parameter.starts_relative_to == Input::supply_V) &&
       !hooks.any_bench()))
    throw InvalidInput(where + "its starts are shares of an input that none of the effect's hooks has");
}

}  // namespace detail

THERMOPOWER_GAP_INLINE void Catalogue::check(const EffectInfo& info, const HookSet& hooks) const {
  const std::string effect = "effect '" + info.id + "'";
  if (info.id.empty()) throw InvalidInput("an effect has no id");
  if (find(info.id) != nullptr) throw InvalidInput(effect + " is in the catalogue already");
  if (is_calibration(info.id))
    throw InvalidInput(effect + ": ids that start with calibration. belong to the engine");
  for (const Need need : info.needs) {
    const bool bench_only = need == Need::thermal_model || need == Need::current_model ||
                            need == Need::ohmic_without_tempco || need == Need::supply_not_logged ||
                            need == Need::current_A || need == Need::power_param || need == Need::two_nodes ||
                            need == Need::thesis_thermal || need == Need::airspeed_mps ||
                            need == Need::neighbour_C;
    const bool axis_only = need == Need::axis_model || need == Need::angle_deg || need == Need::open_loop ||
                           need == Need::closed_loop || need == Need::shown_inertia;
    if ((bench_only && !hooks.any_bench()) || (axis_only && !hooks.any_axis()))
      throw InvalidInput(effect + ": needs '" + to_string(need) +
                         "', which none of its hooks has to do with");
  }
  if (!info.states.empty() && !hooks.axis && !hooks.friction)
    throw InvalidInput(effect + ": has states, but no hook on AxisTerms or FrictionTerms that moves them");
  if (static_cast<int>(info.states.size()) > most_own_states)
    throw InvalidInput(effect + ": has more than " + std::to_string(most_own_states) + " states");
  int place = 0;
  for (const Parameter& parameter : info.parameters) detail::check(parameter, place++, effect, hooks);
  if (const auto& equal = info.where_equal)
    detail::check_special_case({equal->one, equal->other}, "two of its parameters are equal", equal->cause,
                               info);
  if (const auto& small = info.where_small)
    detail::check_special_case({small->small, small->beside}, "one of its parameters is small", small->cause,
                               info);
}

THERMOPOWER_GAP_INLINE Catalogue& Catalogue::add(CatalogueEntry entry) {
  check(entry.info, entry.hooks);
  if (!(entry.hooks.any_bench() || entry.hooks.any_axis()) || !entry.plain || !entry.dual || !entry.wide ||
      !entry.traced)
    throw InvalidInput("effect '" + entry.info.id +
                       "' has no hooks: expected one of each kind, and where they act");
  infos_.push_back(entry.info);
  entries_.push_back(std::move(entry));
  return *this;
}

THERMOPOWER_GAP_INLINE Catalogue& Catalogue::declare(const EffectInfo& info) {
  check(info, HookSet());
  CatalogueEntry entry;
  entry.info = info;
  infos_.push_back(entry.info);
  entries_.push_back(std::move(entry));
  return *this;
}

THERMOPOWER_GAP_INLINE Catalogue& Catalogue::support(std::string_view id, double from, double to,
                                                     double size) {
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    EffectInfo& info = entries_[i].info;
    if (info.id != id || !info.curve) continue;
    if (!(from < to) || !(size >= 0.0))
      throw InvalidInput("curve '" + info.id +
                         "': expected a range from a smaller to a larger value, and a size of 0 or more");
    info.parameters[0].starts = {from};
    info.parameters[1].starts = {to};
    info.curve->size = size;
    infos_[i] = info;
    return *this;
  }
  throw InvalidInput("the catalogue has no curve '" + std::string(id) + "'");
}

THERMOPOWER_GAP_INLINE const CatalogueEntry* Catalogue::find(std::string_view id) const {
  for (const CatalogueEntry& entry : entries_)
    if (entry.info.id == id) return &entry;
  return nullptr;
}

}  // namespace thermopower::plant
