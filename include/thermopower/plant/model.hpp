// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/invalid_input.hpp>

#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

namespace thermopower::plant {

/// The supply where the recording has no `supply_V`.
struct SupplyModel {
  double nominal_V = 12.0;  ///< V, > 0
};

/// `"law": "ohmic"`: R(T) = resistance (1 + tempco (T - reference)), I = V_rms / R(T).
struct OhmicCurrentModel {
  double resistance_ohm = 10.0;   ///< ohm at the reference temperature, > 0
  double tempco_per_K = 0.00393;  ///< 1/K; 0 for a baseline that knows of none
  double reference_C = 25.0;      ///< degC
};

/// `"law": "thesis"`: I[mA] = (slope_V2 V^2 + slope_V1 V + slope_V0) T_C + base V^exponent with V = V_rms;
/// 0 when V <= minimum_V_rms, never below 0.
struct ThesisCurrentModel {
  double slope_V2_mA_per_K = 0.0;  ///< mA/(K V^2), thesis eq 4.1 to 4.5 with the program's signs
  double slope_V1_mA_per_K = 0.0;  ///< mA/(K V)
  double slope_V0_mA_per_K = 0.0;  ///< mA/K
  double base_mA = 0.0;            ///< mA at 1 V and 0 degC
  double exponent = 1.0;           ///< of the voltage, pure number
  double minimum_V_rms = 1.0;      ///< V, at or below which no current flows
};

/// `"law": "lumped"`: C dT/dt = I^2 R(T) - G (T - T_ambient).
struct LumpedThermalModel {
  double heat_capacity_J_per_K = 60.0;  ///< J/K, > 0
  double conductance_W_per_K = 0.1;     ///< W/K, > 0
};

/// `"law": "thesis"`: dT/dt [K/min] = r V_rms I - cooling (T - T_ambient), with
/// 1/r = (rinv_slope_V1 V + rinv_slope_V0) T_C + rinv_offset_V1 V + rinv_offset_V0 in W min/K.
struct ThesisThermalModel {
  double cooling_per_min = 0.1;  ///< 1/min, > 0
  double rinv_slope_V1 = 0.0;    ///< W min/(K^2 V)
  double rinv_slope_V0 = 0.0;    ///< W min/K^2
  double rinv_offset_V1 = 0.0;   ///< W min/(K V)
  double rinv_offset_V0 = 1.0;   ///< W min/K
  double minimum_V_rms = 1.0;    ///< V, at or below which there is no heat
};

/// `"law": "rigid"`: J dw/dt = Kt drive - b w, for a drive that commands the current. `"law": "voltage"`:
/// J dw/dt = Kt (u - Kt w) / R - b w, for a brushed motor at a voltage u.
///
/// @snippet plant_examples.cpp axis model
/// How to: @ref diagnose_a_gap.
struct RigidAxisModel {
  double inertia_kgm2 = 1e-3;             ///< kg m^2, > 0
  double viscous_Nms_per_rad = 1e-3;      ///< N m s/rad, >= 0
  double torque_constant_Nm_per_A = 0.1;  ///< N m/A, not 0
  double resistance_ohm = 0.0;            ///< ohm, > 0, of a motor at a voltage; 0: its current is commanded

  /// Whether a voltage drives the motor, and not a current.
  bool voltage_driven() const { return resistance_ohm != 0.0; }
};

/// `"law": "position_pid"`: from `target_deg` to a command, sampled every `period_s` and held until the next one:
/// kp (target - angle) + kd (target rate - rate) + ki times the integral of the error. The target's rate is
/// `target_dps` where that is recorded, else 0. The integral is held where it alone asks for the limit.
struct PositionPidServo {
  double kp_A_per_deg = 0.05;   ///< A/deg
  double kd_A_s_per_deg = 0.0;  ///< A s/deg
  double ki_A_per_deg_s = 0.0;  ///< A/(deg s)
  double limit_A = 1.0;         ///< of the command, > 0
  double period_s = 1e-3;       ///< between samples, > 0
  double delay_s = 0.0;         ///< from a sample to the torque, >= 0
};

/// `"law": "velocity_pi"`: from `target_dps` to a command, sampled alike: kp (target - rate) + ki times the integral
/// of the error.
struct VelocityPiServo {
  double kp_A_s_per_deg = 0.01;  ///< A per deg/s
  double ki_A_per_deg = 0.0;     ///< A/deg
  double limit_A = 1.0;          ///< of the command, > 0
  double period_s = 1e-3;        ///< between samples, > 0
  double delay_s = 0.0;          ///< from a sample to the torque, >= 0
};

/// Parameters of one effect by name.
using EffectParameters = std::map<std::string, double>;

/// One constant of a model: the block and name it has in the model file, and its value.
struct NamedConstant {
  std::string block;   ///< `supply`, `current`, `thermal`, `axis` or `servo`
  std::string name;    ///< as in the file, such as `resistance_ohm`
  double value = 0.0;  ///< in the unit the name ends in
};

/// A constant that may be off: one field of the model, or several that only make sense scaled together (the
/// coefficients of one polynomial). As a cause the diagnosis calls it by its id after `calibration.`
///
/// @snippet plant_examples.cpp model
/// How to: @ref diagnose_a_gap, @ref gap_files.
struct CalibratedConstant {
  std::string id;                   ///< `resistance`, `heat_capacity`, ...
  std::string block;                ///< `current`, `thermal`, `axis`, `servo` or `effects.<id>`
  std::vector<std::string> fields;  ///< the model's fields that scale with it
  bool may_be_cause = true;         ///< off by more than what is known of it, it is a cause of its own
  bool has_slack = true;  ///< is known by itself; of a polynomial each coefficient is, not all together

  /// Id of the effect whose parameter it is; empty for a constant of a block.
  std::string effect() const { return block.rfind("effects.", 0) == 0 ? block.substr(8) : std::string(); }
};

class Plant;

/// A constant of a plant of one's own.
struct PlantConstant {
  std::string block;         ///< the part of the plant it belongs to
  std::string name;          ///< ends in its unit, as in `outflow_m3_per_s`
  std::string unit;          ///< as reports spell it; "1" for a pure number
  double value = 1.0;        ///< in that unit
  bool may_be_cause = true;  ///< may be off by more than is known of it; a known constant (gravity) is not
  bool above_zero = true;    ///< only values above 0 make sense
};

/// A plant of one's own in a model: its equations, and its constants.
struct PlantModel {
  std::string type;                        ///< what the plant calls itself, in messages
  std::shared_ptr<const Plant> equations;  ///< never null
  std::vector<PlantConstant> constants;    ///< in the order in which the equations read them
};

/// The simulation under test, as in a model file. Blocks may be absent: what they would say is not judged.
///
/// @snippet plant_examples.cpp model
/// How to: @ref diagnose_a_gap, @ref gap_files.
struct Model {
  std::string name;  ///< as reports call it
  /// Needed where the recording has no `supply_V`.
  std::optional<SupplyModel> supply;
  /// From voltage and temperature to current; `std::monostate`: absent.
  std::variant<std::monostate, OhmicCurrentModel, ThesisCurrentModel> current;
  /// From heat to temperature; `std::monostate`: absent.
  std::variant<std::monostate, LumpedThermalModel, ThesisThermalModel> thermal;
  /// From commanded current, or voltage, to motion.
  std::optional<RigidAxisModel> axis;
  /// From target to command, where the recording holds a target and no command; `std::monostate`: absent. Commands
  /// are currents; of a motor at a voltage, currents at standstill.
  std::variant<std::monostate, PositionPidServo, VelocityPiServo> servo;
  std::map<std::string, EffectParameters> effects;  ///< id -> parameter -> value
  /// How well constants are known: standard deviation as a share of the value, above 0 to 1, by
  /// block.constant (as in `thermal.conductance_W_per_K`) and effects.id.parameter. Those that are not in it are
  /// known to 5 %.
  std::map<std::string, double> uncertainty;
  /// A plant of one's own in place of the blocks above; none: the library's actuator.
  std::optional<PlantModel> own;

  bool has_current() const {
    return !std::holds_alternative<std::monostate>(current);
  }  ///< electrical block?
  bool has_thermal() const { return !std::holds_alternative<std::monostate>(thermal); }  ///< thermal block?
  bool has_axis() const { return axis.has_value(); }                                 ///< mechanical block?
  bool has_servo() const { return !std::holds_alternative<std::monostate>(servo); }  ///< servo block?

  /// Every constant of every block present, in a fixed order.
  std::vector<NamedConstant> constants() const;

  /// Value of a constant by its name in the file. `minimum_V_rms` exists in two blocks: qualify it as
  /// `current.minimum_V_rms`; any name may be qualified so, and parameters of its effects are
  /// `effects.<id>.<parameter>`. @throws InvalidInput where there is none.
  double get(std::string_view constant_name) const;

  /// Sets a constant by its name in the file (qualified or not). @throws InvalidInput where there is none.
  void set(std::string_view constant_name, double value);

  /// The constants that calibration may move, the parameters of the model's own effects included.
  std::vector<CalibratedConstant> calibrated() const;

  /// How well a constant is known, as a share of its value; of fields that scale together the worst known
  /// counts. `otherwise` where nothing is stated.
  double uncertainty_of(const CalibratedConstant& constant, double otherwise = 0.05) const {
    double worst = 0.0;
    for (const std::string& field : constant.fields) {
      const auto found = uncertainty.find(constant.block + "." + field);
      if (found != uncertainty.end() && found->second > worst) worst = found->second;
    }
    return worst > 0.0 ? worst : otherwise;
  }

  /// What is wrong with it, naming the field and what was expected, or nothing. Effects are not looked into:
  /// the catalogue knows them.
  std::optional<std::string> validate() const;
};

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
  } else if (auto* velocity = std::get_if<VelocityPiServo>(&model.servo)) {
    visit("servo", "kp_A_s_per_deg", velocity->kp_A_s_per_deg);
    visit("servo", "ki_A_per_deg", velocity->ki_A_per_deg);
    visit("servo", "limit_A", velocity->limit_A);
    visit("servo", "period_s", velocity->period_s);
    visit("servo", "delay_s", velocity->delay_s);
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

inline std::vector<NamedConstant> Model::constants() const {
  std::vector<NamedConstant> list;
  detail::for_each_constant(*this, [&](const char* block, const char* field, const double& value) {
    list.push_back({block, field, value});
  });
  return list;
}

inline double Model::get(std::string_view constant_name) const {
  const double* found = detail::find_constant(*this, constant_name);
  if (found == nullptr) found = detail::find_parameter(effects, constant_name);
  if (found == nullptr)
    throw InvalidInput("model '" + name + "' has no constant '" + std::string(constant_name) + "'");
  return *found;
}

inline void Model::set(std::string_view constant_name, double value) {
  double* found = detail::find_constant(*this, constant_name);
  if (found == nullptr) found = detail::find_parameter(effects, constant_name);
  if (found == nullptr)
    throw InvalidInput("model '" + name + "' has no constant '" + std::string(constant_name) + "'");
  *found = value;
}

inline std::vector<CalibratedConstant> Model::calibrated() const {
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
        if (parameter.second != 0.0)
          list.push_back(
              {effect.first + "." + parameter.first, "effects." + effect.first, {parameter.first}});
  return list;
}

inline std::optional<std::string> Model::validate() const {
  std::optional<std::string> problem;
  const auto positive = [](std::string_view field) {
    return field == "nominal_V" || field == "resistance_ohm" || field == "heat_capacity_J_per_K" ||
           field == "conductance_W_per_K" || field == "cooling_per_min" || field == "inertia_kgm2" ||
           field == "limit_A" || field == "period_s";
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

}  // namespace thermopower::plant
