// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/actuator/heating.hpp>
#include <thermopower/actuator/ohmic_current.hpp>
#include <thermopower/actuator/thesis_current.hpp>
#include <thermopower/plant/catalogue.hpp>
#include <thermopower/plant/model.hpp>
#include <thermopower/plant/servo_loop.hpp>

#include <string>
#include <utility>
#include <vector>

namespace thermopower::plant {

/// One effect at work: its hooks and where its parameters lie.
template <class Scalar>
struct Bound {
  const detail::Hooks<Scalar>* hooks = nullptr;  ///< not owned: the catalogue's
  const Scalar* parameters = nullptr;            ///< not owned: the instance's, in the effect's order
  int own_states = 0;                            ///< place of its first state among those of the joint

  /// Lets the effect act on the terms of a hook it has.
  template <class Terms>
  void operator()(Terms& terms) const {
    hooks->call(parameters, terms);
  }
};

/// Effects and parameter values that act besides the model's own.
template <class Scalar>
struct AddedEffect {
  const CatalogueEntry* entry = nullptr;  ///< not owned
  std::vector<Scalar> parameters;         ///< in the order of `entry->info.parameters`, in their units
};

/// A model with its constants in the scalar of a rollout, and the effects that act, sorted by hook.
template <class Scalar>
struct Instance {
  bool ohmic = false;           ///< the current law is `winding`
  bool thesis_current = false;  ///< the current law is `current_law`
  bool lumped = false;          ///< the thermal law is `heat_capacity` and `conductance_W_per_K`
  bool thesis_thermal = false;  ///< the thermal law is `heating_law` and `cooling_per_s`
  bool rigid = false;           ///< there is an axis

  OhmicCurrent<Scalar> winding;               ///< where `ohmic`
  ThesisCurrent<Scalar> current_law;          ///< where `thesis_current`
  HeatCapacityHeating<Scalar> heat_capacity;  ///< where `lumped`
  Scalar conductance_W_per_K;                 ///< from body to air, where `lumped`
  ThesisHeating<Scalar> heating_law;          ///< where `thesis_thermal`
  Scalar cooling_per_s;                       ///< Newton's law, where `thesis_thermal`
  Scalar inertia_kgm2;                        ///< near and far side together, where `rigid`
  Scalar viscous_Nms_per_rad;                 ///< where `rigid`
  Scalar torque_constant_Nm_per_A;            ///< where `rigid`
  bool voltage_driven = false;                ///< the drive is a voltage
  Scalar motor_ohm;                           ///< where `voltage_driven`
  ServoGains<Scalar> servo;                   ///< where the model has a servo
  HeaterLaw heater;                           ///< of the loop that makes the duty, where there is one

  ThermalStructure<Scalar> thermal_structure;  ///< after the effects that shape it
  AxisStructure<Scalar> axis_structure;        ///< after the effects that shape it
  int own_states = 0;                          ///< that the effects bring to the joint

  std::vector<Bound<Scalar>> electrical;      ///< effects on ElectricalTerms, in the catalogue's order
  std::vector<Bound<Scalar>> air;             ///< on AirTerms
  std::vector<Bound<Scalar>> thermal;         ///< on ThermalTerms, after those on AirTerms
  std::vector<Bound<Scalar>> bench_readings;  ///< on BenchReadings
  std::vector<Bound<Scalar>> drive;           ///< on DriveTerms
  std::vector<Bound<Scalar>> axis;            ///< on AxisTerms
  std::vector<Bound<Scalar>> friction;        ///< on FrictionTerms, after those on AxisTerms
  std::vector<Bound<Scalar>> axis_readings;   ///< on AxisReadings

  /// @param factors  one per entry of `model.calibrated()`: moves that constant (CalibratedConstant::moved)
  /// @param added    act besides the model's own effects, one as often as it is given
  /// @throws InvalidInput for an effect or parameter of the model that the catalogue does not know
  Instance(const Model& model, const std::vector<Scalar>& factors,
           const std::vector<AddedEffect<Scalar>>& added, const Catalogue& catalogue) {
    set_constants(model, factors);
    heater = model.heater;
    const Scalar none = constant<Scalar>(0.0);
    thermal_structure = {constant<Scalar>(1.0), none, none, none, none, none, none, none, none};
    axis_structure = {none, none, none, none, none, false, false, false, none, false};
    parameters_.reserve(model.effects.size() + added.size());
    for (const CatalogueEntry* entry : in_catalogue_order(model, added, catalogue)) {
      const auto act = [&](std::vector<Scalar> parameters) {
        parameters_.push_back(std::move(parameters));
        bind(*entry, parameters_.back().data());
      };
      bool is_added = false;
      for (const AddedEffect<Scalar>& one : added)
        if (one.entry == entry) act(one.parameters), is_added = true;
      if (!is_added) act(of_model(model, *entry, factors));
    }
    // 1/r = (s1 V + s0) T + o1 V + o0, and with V and T in each other's place (s1 V + o1) T + s0 V + o0.
    if (thermal_structure.heating_exchanged)
      std::swap(heating_law.slope_V0_J_per_K2, heating_law.offset_V1_J_per_K);
  }

  Instance(const Instance&) = delete;  // the bound effects point into it
  Instance& operator=(const Instance&) = delete;

private:
  void set_constants(const Model& model, const std::vector<Scalar>& factors) {
    const std::vector<CalibratedConstant> calibrated = model.calibrated();
    const auto scaled = [&](const char* block, const char* field, double value) {
      Scalar result = constant<Scalar>(value);
      for (std::size_t i = 0; i < calibrated.size() && i < factors.size(); ++i)
        if (calibrated[i].block == block)
          for (const std::string& name : calibrated[i].fields)
            if (name == field) result *= factors[i];
      return result;
    };
    if (const auto* law = std::get_if<OhmicCurrentModel>(&model.current)) {
      ohmic = true;
      winding = {scaled("current", "resistance_ohm", law->resistance_ohm),
                 scaled("current", "tempco_per_K", law->tempco_per_K), constant<Scalar>(law->reference_C)};
    } else if (const auto* polynomial = std::get_if<ThesisCurrentModel>(&model.current)) {
      thesis_current = true;
      current_law = ThesisCurrent<Scalar>::from_milliampere(
          scaled("current", "slope_V2_mA_per_K", polynomial->slope_V2_mA_per_K),
          scaled("current", "slope_V1_mA_per_K", polynomial->slope_V1_mA_per_K),
          scaled("current", "slope_V0_mA_per_K", polynomial->slope_V0_mA_per_K),
          scaled("current", "base_mA", polynomial->base_mA), constant<Scalar>(polynomial->exponent),
          constant<Scalar>(polynomial->minimum_V_rms));
    }
    if (const auto* law = std::get_if<LumpedThermalModel>(&model.thermal)) {
      lumped = true;
      heat_capacity = {scaled("thermal", "heat_capacity_J_per_K", law->heat_capacity_J_per_K)};
      conductance_W_per_K = scaled("thermal", "conductance_W_per_K", law->conductance_W_per_K);
    } else if (const auto* polynomial = std::get_if<ThesisThermalModel>(&model.thermal)) {
      thesis_thermal = true;
      heating_law =
          ThesisHeating<Scalar>::per_minute(scaled("thermal", "rinv_slope_V1", polynomial->rinv_slope_V1),
                                            scaled("thermal", "rinv_slope_V0", polynomial->rinv_slope_V0),
                                            scaled("thermal", "rinv_offset_V1", polynomial->rinv_offset_V1),
                                            scaled("thermal", "rinv_offset_V0", polynomial->rinv_offset_V0),
                                            constant<Scalar>(polynomial->minimum_V_rms));
      cooling_per_s = scaled("thermal", "cooling_per_min", polynomial->cooling_per_min) / 60.0;
    }
    if (model.axis) {
      rigid = true;
      inertia_kgm2 = scaled("axis", "inertia_kgm2", model.axis->inertia_kgm2);
      viscous_Nms_per_rad = scaled("axis", "viscous_Nms_per_rad", model.axis->viscous_Nms_per_rad);
      torque_constant_Nm_per_A =
          scaled("axis", "torque_constant_Nm_per_A", model.axis->torque_constant_Nm_per_A);
      voltage_driven = model.axis->voltage_driven();
      if (model.has_servo())
        servo = servo_gains<Scalar>(
            model, [&](const char* field, double value) { return scaled("servo", field, value); });
      if (voltage_driven) motor_ohm = scaled("axis", "resistance_ohm", model.axis->resistance_ohm);
    }
  }

  static std::vector<const CatalogueEntry*> in_catalogue_order(const Model& model,
                                                               const std::vector<AddedEffect<Scalar>>& added,
                                                               const Catalogue& catalogue) {
    for (const auto& effect : model.effects)
      if (catalogue.find(effect.first) == nullptr)
        throw InvalidInput("model '" + model.name + "': the catalogue has no effect '" + effect.first + "'");
    std::vector<const CatalogueEntry*> order;
    for (const CatalogueEntry& entry : catalogue.entries()) {
      bool acts = model.effects.count(entry.info.id) > 0;
      for (const AddedEffect<Scalar>& one : added) acts = acts || one.entry == &entry;
      if (acts) order.push_back(&entry);
    }
    return order;
  }

  static std::vector<Scalar> of_model(const Model& model, const CatalogueEntry& entry,
                                      const std::vector<Scalar>& factors) {
    const EffectParameters& given = model.effects.at(entry.info.id);
    const std::vector<CalibratedConstant> calibrated = model.calibrated();
    std::vector<Scalar> values;
    for (const Parameter& parameter : entry.info.parameters) {
      const auto found = given.find(parameter.name);
      if (found == given.end() && parameter.standard) {
        values.push_back(constant<Scalar>(*parameter.standard));
        continue;
      }
      if (found == given.end())
        throw InvalidInput("model '" + model.name + "', effect '" + entry.info.id + "': parameter '" +
                           parameter.name + "' is missing");
      values.push_back(constant<Scalar>(found->second));
      for (std::size_t i = 0; i < calibrated.size() && i < factors.size(); ++i)
        if (calibrated[i].effect() == entry.info.id && calibrated[i].fields.front() == parameter.name)
          values.back() = calibrated[i].moved(values.back(), factors[i]);
    }
    for (const auto& value : given) {
      bool known = false;
      for (const Parameter& parameter : entry.info.parameters) known = known || parameter.name == value.first;
      if (!known)
        throw InvalidInput("model '" + model.name + "', effect '" + entry.info.id +
                           "': there is no parameter '" + value.first + "'");
    }
    return values;
  }

  void bind(const CatalogueEntry& entry, const Scalar* parameters) {
    const Bound<Scalar> bound{&entry.of<Scalar>(), parameters, own_states};
    own_states += static_cast<int>(entry.info.states.size());
    if (own_states > most_own_states)
      throw InvalidInput("effect '" + entry.info.id +
                         "': together with the other effects it brings more than " +
                         std::to_string(most_own_states) + " states to the joint");
    if (entry.hooks.electrical) electrical.push_back(bound);
    if (entry.hooks.air) air.push_back(bound);
    if (entry.hooks.thermal) thermal.push_back(bound);
    if (entry.hooks.bench_readings) bench_readings.push_back(bound);
    if (entry.hooks.drive) drive.push_back(bound);
    if (entry.hooks.axis) axis.push_back(bound);
    if (entry.hooks.friction) friction.push_back(bound);
    if (entry.hooks.axis_readings) axis_readings.push_back(bound);
    if (entry.hooks.thermal_structure) bound(thermal_structure);
    if (entry.hooks.axis_structure) bound(axis_structure);
  }

  std::vector<std::vector<Scalar>> parameters_;
};

}  // namespace thermopower::plant
