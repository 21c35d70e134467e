// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/curve_id.hpp>
#include <thermopower/plant/model.hpp>

#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

namespace thermopower::plant {

namespace detail {

/// What a visitor of the constants of a model gets to see of each: a number that it may write where the model is its own.
template <class ModelType>
using VisitConstant =
    std::function<void(const char* block, const char* name,
                       std::conditional_t<std::is_const_v<ModelType>, const double, double>& value)>;

/// Calls visit(block, name, value) for every constant present.
template <class ModelType>
void for_each_constant(ModelType& model, const VisitConstant<ModelType>& visit) {
  if (model.supply) visit("supply", "nominal_V", model.supply->nominal_V);
  if (auto* ohmic = std::get_if<OhmicCurrentModel>(&model.current)) {
    visit("current", "resistance_ohm", ohmic->resistance_ohm);
    visit("current", "tempco_per_K", ohmic->tempco_per_K);
    visit("current", "reference_C", ohmic->reference_C);
  } else if (auto* thesis = std::get_if<ThesisCurrentModel>(&model.current)) {
    visit("current", "slope_V2_mA_per_K", thesis->slope_V2_mA_per_K);
    visit("current", "slope_V1_mA_per_K", thesis->slope_V1_mA_per_K);
    visit("current", "slope_V0_mA_per_K", thesis->slope_V0_mA_per_K);
    visit("current", "base_mA", thesis->base_mA);
    visit("current", "exponent", thesis->exponent);
    visit("current", "minimum_V_rms", thesis->minimum_V_rms);
  }
  if (auto* lumped = std::get_if<LumpedThermalModel>(&model.thermal)) {
    visit("thermal", "heat_capacity_J_per_K", lumped->heat_capacity_J_per_K);
    visit("thermal", "conductance_W_per_K", lumped->conductance_W_per_K);
  } else if (auto* polynomial = std::get_if<ThesisThermalModel>(&model.thermal)) {
    visit("thermal", "cooling_per_min", polynomial->cooling_per_min);
    visit("thermal", "rinv_slope_V1", polynomial->rinv_slope_V1);
    visit("thermal", "rinv_slope_V0", polynomial->rinv_slope_V0);
    visit("thermal", "rinv_offset_V1", polynomial->rinv_offset_V1);
    visit("thermal", "rinv_offset_V0", polynomial->rinv_offset_V0);
    visit("thermal", "minimum_V_rms", polynomial->minimum_V_rms);
  }
  if (model.axis) {
    visit("axis", "inertia_kgm2", model.axis->inertia_kgm2);
    visit("axis", "viscous_Nms_per_rad", model.axis->viscous_Nms_per_rad);
    visit("axis", "torque_constant_Nm_per_A", model.axis->torque_constant_Nm_per_A);
    if (model.axis->voltage_driven()) visit("axis", "resistance_ohm", model.axis->resistance_ohm);
  }
  if (auto* servo = std::get_if<PositionPidServo>(&model.servo)) {
    visit("servo", "kp_A_per_deg", servo->kp_A_per_deg);
    visit("servo", "kd_A_s_per_deg", servo->kd_A_s_per_deg);
    visit("servo", "ki_A_per_deg_s", servo->ki_A_per_deg_s);
    visit("servo", "limit_A", servo->limit_A);
    visit("servo", "period_s", servo->period_s);
    visit("servo", "delay_s", servo->delay_s);
    // Known where there are any, and else not worth a line.
    if (servo->slew_A_per_s != 0.0) visit("servo", "slew_A_per_s", servo->slew_A_per_s);
    if (servo->dead_zone_deg != 0.0) visit("servo", "dead_zone_deg", servo->dead_zone_deg);
    if (servo->profile_dps != 0.0) visit("servo", "profile_dps", servo->profile_dps);
    if (servo->profile_dps2 != 0.0) visit("servo", "profile_dps2", servo->profile_dps2);
  } else if (auto* velocity = std::get_if<VelocityPiServo>(&model.servo)) {
    visit("servo", "kp_A_s_per_deg", velocity->kp_A_s_per_deg);
    visit("servo", "ki_A_per_deg", velocity->ki_A_per_deg);
    visit("servo", "limit_A", velocity->limit_A);
    visit("servo", "period_s", velocity->period_s);
    visit("servo", "delay_s", velocity->delay_s);
    if (velocity->slew_A_per_s != 0.0) visit("servo", "slew_A_per_s", velocity->slew_A_per_s);
  }
  const auto pid = [&](auto& heater) {
    visit("heater", "kp_per_K", heater.kp_per_K);
    visit("heater", "ki_per_K_s", heater.ki_per_K_s);
    visit("heater", "kd_s_per_K", heater.kd_s_per_K);
  };
  if (auto* klipper = std::get_if<KlipperPidHeater>(&model.heater)) {
    pid(*klipper);
    visit("heater", "max_power", klipper->max_power);
    visit("heater", "smooth_time_s", klipper->smooth_time_s);
    visit("heater", "period_s", klipper->period_s);
  } else if (auto* marlin = std::get_if<MarlinPidHeater>(&model.heater)) {
    pid(*marlin);
    visit("heater", "max_power", marlin->max_power);
    visit("heater", "functional_range_K", marlin->functional_range_K);
    visit("heater", "period_s", marlin->period_s);
  } else if (auto* bang_bang = std::get_if<BangBangHeater>(&model.heater)) {
    visit("heater", "max_delta_K", bang_bang->max_delta_K);
    visit("heater", "max_power", bang_bang->max_power);
    visit("heater", "period_s", bang_bang->period_s);
  }
  if (model.own)
    for (auto& constant : model.own->constants)
      visit(constant.block.c_str(), constant.name.c_str(), constant.value);
}

/// The constant of that (possibly qualified) name, or nullptr.
template <class ModelType>
auto find_constant(ModelType& model, std::string_view wanted) {
  using Value = std::conditional_t<std::is_const_v<ModelType>, const double, double>;
  Value* found = nullptr;
  for_each_constant(model, [&](const char* block, const char* field, auto& value) {
    if (found == nullptr && (wanted == field || wanted == std::string(block) + "." + field)) found = &value;
  });
  return found;
}

/// The parameter `effects.<id>.<parameter>`, or nullptr.
template <class Effects>
auto find_parameter(Effects& effects, std::string_view wanted)
    -> decltype(&effects.begin()->second.begin()->second) {
  for (auto& effect : effects)
    for (auto& parameter : effect.second)
      if (wanted == "effects." + effect.first + "." + parameter.first) return &parameter.second;
  return nullptr;
}

}  // namespace detail

THERMOPOWER_GAP_INLINE std::vector<NamedConstant> Model::constants() const {
  std::vector<NamedConstant> list;
  detail::for_each_constant(*this, [&](const char* block, const char* field, const double& value) {
    list.push_back({block, field, value});
  });
  return list;
}

THERMOPOWER_GAP_INLINE double Model::get(std::string_view constant_name) const {
  const double* found = detail::find_constant(*this, constant_name);
  if (found == nullptr) found = detail::find_parameter(effects, constant_name);
  if (found == nullptr)
    throw InvalidInput("model '" + name + "' has no constant '" + std::string(constant_name) + "'");
  return *found;
}

THERMOPOWER_GAP_INLINE void Model::set(std::string_view constant_name, double value) {
  double* found = detail::find_constant(*this, constant_name);
  if (found == nullptr) found = detail::find_parameter(effects, constant_name);
  if (found == nullptr)
    throw InvalidInput("model '" + name + "' has no constant '" + std::string(constant_name) + "'");
  *found = value;
}

THERMOPOWER_GAP_INLINE std::vector<CalibratedConstant> Model::calibrated() const {
  std::vector<CalibratedConstant> list;
  if (const auto* ohmic = std::get_if<OhmicCurrentModel>(&current)) {
    list.push_back({"resistance", "current", {"resistance_ohm"}});
    if (ohmic->tempco_per_K != 0.0) list.push_back({"tempco", "current", {"tempco_per_K"}});
  } else if (std::holds_alternative<ThesisCurrentModel>(current)) {
    list.push_back({"base", "current", {"base_mA"}});
    list.push_back(
        {"slope", "current", {"slope_V2_mA_per_K", "slope_V1_mA_per_K", "slope_V0_mA_per_K"}, true, false});
    for (const char* field : {"slope_V2_mA_per_K", "slope_V1_mA_per_K", "slope_V0_mA_per_K"})
      if (get(std::string("current.") + field) != 0.0)
        list.push_back({field, "current", {field}, false, true});
  }
  if (std::holds_alternative<LumpedThermalModel>(thermal)) {
    list.push_back({"heat_capacity", "thermal", {"heat_capacity_J_per_K"}});
    list.push_back({"conductance", "thermal", {"conductance_W_per_K"}});
  } else if (std::holds_alternative<ThesisThermalModel>(thermal)) {
    list.push_back({"rinv",
                    "thermal",
                    {"rinv_slope_V1", "rinv_slope_V0", "rinv_offset_V1", "rinv_offset_V0"},
                    true,
                    false});
    for (const char* field : {"rinv_slope_V1", "rinv_slope_V0", "rinv_offset_V1", "rinv_offset_V0"})
      if (get(std::string("thermal.") + field) != 0.0)
        list.push_back({field, "thermal", {field}, false, true});
    list.push_back({"cooling", "thermal", {"cooling_per_min"}});
  }
  if (axis) {
    list.push_back({"inertia", "axis", {"inertia_kgm2"}});
    if (axis->viscous_Nms_per_rad != 0.0) list.push_back({"viscous", "axis", {"viscous_Nms_per_rad"}});
    list.push_back({"torque_constant", "axis", {"torque_constant_Nm_per_A"}});
    if (axis->voltage_driven()) list.push_back({"motor_resistance", "axis", {"resistance_ohm"}});
  }
  const auto gain = [&](const char* id, const char* field) {
    if (get(std::string("servo.") + field) != 0.0) list.push_back({id, "servo", {field}});
  };
  if (std::holds_alternative<PositionPidServo>(servo)) {
    gain("kp", "kp_A_per_deg");
    gain("kd", "kd_A_s_per_deg");
    gain("ki", "ki_A_per_deg_s");
  } else if (std::holds_alternative<VelocityPiServo>(servo)) {
    gain("kp", "kp_A_s_per_deg");
    gain("ki", "ki_A_per_deg");
  }
  if (own)
    for (const PlantConstant& constant : own->constants)
      if (constant.may_be_cause && constant.value != 0.0)
        list.push_back({constant.name, constant.block, {constant.name}});
  if (!own)
    for (const auto& effect : effects)
      for (const auto& parameter : effect.second)
        if (!is_curve(effect.first) && (parameter.second != 0.0 || names_a_place(parameter.first)))
          list.push_back({effect.first + "." + parameter.first,
                          "effects." + effect.first,
                          {parameter.first},
                          true,
                          true,
                          names_a_place(parameter.first)});
  return list;
}

THERMOPOWER_GAP_INLINE std::optional<std::string> Model::validate() const {
  std::optional<std::string> problem;
  const auto positive = [](std::string_view field) {
    return field == "nominal_V" || field == "resistance_ohm" || field == "heat_capacity_J_per_K" ||
           field == "conductance_W_per_K" || field == "cooling_per_min" || field == "inertia_kgm2" ||
           field == "limit_A" || field == "period_s" || field == "slew_A_per_s" || field == "dead_zone_deg" ||
           field == "profile_dps" || field == "profile_dps2" || field == "kp_per_K" || field == "max_power" ||
           field == "functional_range_K";
  };
  detail::for_each_constant(*this, [&](const char* block, const char* field, const double& value) {
    if (problem) return;
    const std::string where = std::string(block) + "." + field;
    if (!std::isfinite(value)) problem = where + " must be a finite number";
    else if (positive(field) && !(value > 0.0))
      problem = where + " is " + std::to_string(value) + ", expected a number above 0";
  });
  if (!problem && axis && axis->viscous_Nms_per_rad < 0.0)
    problem = "axis.viscous_Nms_per_rad is negative, expected 0 or more";
  if (!problem && axis && axis->torque_constant_Nm_per_A == 0.0)
    problem = "axis.torque_constant_Nm_per_A is 0, expected another number";
  if (!problem && has_servo() && get("servo.delay_s") < 0.0)
    problem = "servo.delay_s is negative, expected 0 or more";
  if (!problem && has_heater() && get("heater.max_power") > 1.0)
    problem = "heater.max_power is above 1, expected a share of the time, above 0 to 1";
  for (const char* gain : {"ki_per_K_s", "kd_s_per_K", "smooth_time_s", "max_delta_K"}) {
    const double* value = detail::find_constant(*this, std::string("heater.") + gain);
    if (!problem && value != nullptr && *value < 0.0)
      problem = std::string("heater.") + gain + " is negative, expected 0 or more";
  }
  if (!problem && has_heater() && !(has_current() && has_thermal()))
    problem = "there is a heater block and not both of current and thermal: expected all three";
  if (!problem && has_servo() && !axis) problem = "there is a servo block and no axis block: expected both";
  if (own && !problem)
    for (const PlantConstant& constant : own->constants)
      if (constant.above_zero && !(constant.value > 0.0))
        return constant.block + "." + constant.name + " is " + std::to_string(constant.value) +
               ", expected a number above 0";
  if (!problem && own && (has_current() || has_thermal() || axis))
    problem =
        "the model has a plant of its own and one of the blocks current, thermal and axis: expected one";
  if (!problem && !own && !has_current() && !has_thermal() && !axis)
    problem = "the model has none of the blocks current, thermal and axis: nothing can be judged";
  return problem;
}

THERMOPOWER_GAP_INLINE std::vector<double> Model::moved(std::size_t constant, double distance) const {
  const std::vector<CalibratedConstant> all = calibrated();
  std::vector<double> by;
  for (const CalibratedConstant& one : all) by.push_back(one.unmoved());
  by[constant] = all[constant].is_place ? distance : std::exp(distance);
  return by;
}

THERMOPOWER_GAP_INLINE double Model::uncertainty_of(const CalibratedConstant& constant,
                                                    double otherwise) const {
  double worst = 0.0;
  for (const std::string& field : constant.fields) {
    const auto found = uncertainty.find(constant.block + "." + field);
    if (found != uncertainty.end() && found->second > worst) worst = found->second;
  }
  if (worst > 0.0) return worst;
  if (names_a_transition(constant.fields.front())) return transition_known_to;
  return constant.is_place ? place_known_to_rad : otherwise;
}

THERMOPOWER_GAP_INLINE double Model::time_constant_s() const {
  constexpr double s_per_min = 60.0;
  if (const auto* lumped = std::get_if<LumpedThermalModel>(&thermal))
    return lumped->heat_capacity_J_per_K / lumped->conductance_W_per_K;
  if (const auto* of_thesis = std::get_if<ThesisThermalModel>(&thermal))
    return s_per_min / of_thesis->cooling_per_min;
  return std::numeric_limits<double>::infinity();
}

}  // namespace thermopower::plant
