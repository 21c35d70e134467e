// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/inputs.hpp>
#include <thermopower/plant/actuator_plant.hpp>
#include <thermopower/plant/catalogue.hpp>
#include <thermopower/plant/samples.hpp>

#include <algorithm>
#include <variant>
#include <vector>

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

/// Whether model and recordings have what an effect needs.
inline bool can_be_judged(const CatalogueEntry& entry, const Model& model,
                          const std::vector<Inputs>& recordings) {
  if (model.own) return model.effects.count(entry.info.id) == 0;
  bool bench = false, axis = false;
  for (const Inputs& inputs : recordings) bench = bench || inputs.bench(), axis = axis || inputs.axis();
  if (!(entry.hooks.any_bench() && bench) && !(entry.hooks.any_axis() && axis)) return false;
  if (model.effects.count(entry.info.id) > 0) return false;
  if (entry.info.curve && !(entry.info.curve->size > 0.0)) return false;
  for (const Need need : entry.info.needs) {
    bool met = false;
    for (const Inputs& inputs : recordings) {
      const auto judged = [&](Signal signal) { return inputs.judged(signal); };
      const auto* ohmic = std::get_if<OhmicCurrentModel>(&model.current);
      bool here = true;
      switch (need) {
        case Need::current_A:
          here = judged(Signal::current_A);
          break;
        case Need::motor_C:
          here = entry.hooks.any_axis() ? inputs.covariate_motor_C.size() > 0 : judged(Signal::motor_C);
          break;
        case Need::power_param:
          here = inputs.power_param.size() > 0;
          break;
        case Need::airspeed_mps:
          here = inputs.airspeed_mps.size() > 0;
          break;
        case Need::neighbour_C:
          here = inputs.neighbour_C.size() > 0;
          break;
        case Need::rate_dps:
          here = entry.hooks.any_axis() ? judged(Signal::rate_dps) : inputs.covariate_rate_dps.size() > 0;
          break;
        case Need::angle_deg:
          here = judged(Signal::angle_deg);
          break;
        case Need::supply_not_logged:
          here = inputs.supply_V.size() == 0;
          break;
        case Need::thermal_model:
          here = model.has_thermal() && judged(Signal::motor_C);
          break;
        case Need::current_model:
          here = model.has_current();
          break;
        case Need::axis_model:
          here = model.has_axis() && axis;
          break;
        case Need::two_nodes:
          here = model.effects.count("second_thermal_mass") > 0;
          break;
        case Need::thesis_thermal:
          here = std::holds_alternative<ThesisThermalModel>(model.thermal);
          break;
        case Need::open_loop:
          here = inputs.axis() && !inputs.closed_loop;
          break;
        case Need::closed_loop:
          here = inputs.axis() && inputs.closed_loop;
          break;
        case Need::shown_inertia:
          here = shows_inertia(model, inputs);
          break;
        case Need::ohmic_without_tempco:
          here = ohmic != nullptr && ohmic->tempco_per_K == 0.0;
          break;
      }
      met = met || here;
    }
    if (!met) return false;
  }
  return true;
}

}  // namespace thermopower::gap::engine
