// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/inputs.hpp>
#include <thermopower/gap/fit/explanation.hpp>
#include <thermopower/plant/actuator_plant.hpp>
#include <thermopower/plant/calibration_id.hpp>
#include <thermopower/plant/catalogue.hpp>
#include <thermopower/plant/samples.hpp>

#include <algorithm>
#include <cstddef>
#include <string>
#include <variant>
#include <vector>

/// @file judgeable.hpp
/// The single causes that model and recordings allow to be judged: a search begins with them.

namespace thermopower::gap::engine {

/// Whether recordings tell of the block that a constant belongs to.
inline bool can_be_judged(const CalibratedConstant& constant, const Model& model,
                          const std::vector<Inputs>& recordings) {
  if (!constant.effect().empty() || model.own) return true;
  return std::any_of(recordings.begin(), recordings.end(), [&](const Inputs& one) {
    return constant.block == "axis"      ? one.axis()
           : constant.block == "servo"   ? one.closed_loop
           : constant.block == "thermal" ? one.judged(Signal::motor_C)
                                         : one.bench();
  });
}

/// Whether rows are so close that the inertia of an axis shows: drag, with what the motor's own voltage brakes, does not settle its
/// rate within one. A spring behind it would not show, either, and to simulate one takes thousands of steps a row.
inline bool shows_inertia(const Model& model, const Inputs& inputs) {
  constexpr double settled = 3.0;  // time constants: 5 % of a step are left
  if (!inputs.axis() || !model.axis) return false;
  return model.axis->drag_Nms_per_rad() * plant::median_interval_s(inputs.t_s, inputs.runs) <
         settled * model.axis->inertia_kgm2;
}

/// Whether the model and one recording have what an effect needs.
inline bool is_met(Need need, const CatalogueEntry& entry, const Model& model, const Inputs& inputs) {
  const auto* ohmic = std::get_if<OhmicCurrentModel>(&model.current);
  switch (need) {
    case Need::current_A:
      return inputs.judged(Signal::current_A);
    case Need::motor_C:
      return entry.hooks.any_axis() ? inputs.covariate_motor_C.size() > 0 : inputs.judged(Signal::motor_C);
    case Need::power_param:
      return inputs.power_param.size() > 0;
    case Need::airspeed_mps:
      return inputs.airspeed_mps.size() > 0;
    case Need::neighbour_C:
      return inputs.neighbour_C.size() > 0;
    case Need::rate_dps:
      return entry.hooks.any_axis() ? inputs.judged(Signal::rate_dps) : inputs.covariate_rate_dps.size() > 0;
    case Need::angle_deg:
      return inputs.judged(Signal::angle_deg);
    case Need::supply_not_logged:
      return inputs.supply_V.size() == 0;
    case Need::thermal_model:
      return model.has_thermal() && inputs.judged(Signal::motor_C);
    case Need::current_model:
      return model.has_current();
    case Need::axis_model:
      return model.has_axis() && inputs.axis();
    case Need::two_nodes:
      return model.effects.count("second_thermal_mass") > 0;
    case Need::thesis_thermal:
      return std::holds_alternative<ThesisThermalModel>(model.thermal);
    case Need::open_loop:
      return inputs.axis() && !inputs.closed_loop;
    case Need::closed_loop:
      return inputs.axis() && inputs.closed_loop;
    case Need::shown_inertia:
      return shows_inertia(model, inputs);
    case Need::ohmic_without_tempco:
      return ohmic != nullptr && ohmic->tempco_per_K == 0.0;
  }
  return true;
}

/// Whether model and recordings have what an effect needs.
inline bool can_be_judged(const CatalogueEntry& entry, const Model& model,
                          const std::vector<Inputs>& recordings) {
  if (model.effects.count(entry.info.id) > 0) return false;
  if (model.own) return true;
  const auto any = [&](auto&& has) { return std::any_of(recordings.begin(), recordings.end(), has); };
  const auto acts = [&](const Inputs& one) {
    return (entry.hooks.any_bench() && one.bench()) || (entry.hooks.any_axis() && one.axis());
  };
  if (!any(acts) || (entry.info.curve && !(entry.info.curve->size > 0.0))) return false;
  return std::all_of(entry.info.needs.begin(), entry.info.needs.end(), [&](Need need) {
    return any([&](const Inputs& one) { return is_met(need, entry, model, one); });
  });
}

/// Every single cause that model and recordings allow to be judged: the catalogue's effects, then the constants that may be
/// causes.
/// @param without  ids that are left out
inline std::vector<Explanation> single_causes(const Model& model, const Catalogue& catalogue,
                                              const std::vector<std::string>& without,
                                              const std::vector<Inputs>& recordings) {
  std::vector<Explanation> list;
  const auto removed = [&](const std::string& id) {
    return std::find(without.begin(), without.end(), id) != without.end();
  };
  for (const CatalogueEntry& entry : catalogue.entries())
    if (!removed(entry.info.id) && can_be_judged(entry, model, recordings)) list.push_back({{&entry}, {}});
  const std::vector<CalibratedConstant> constants = model.calibrated();
  for (std::size_t i = 0; i < constants.size(); ++i)
    if (constants[i].may_be_cause && !removed(plant::calibration_id(constants[i].id)) &&
        can_be_judged(constants[i], model, recordings))
      list.push_back({{}, {static_cast<int>(i)}});
  return list;
}

}  // namespace thermopower::gap::engine
