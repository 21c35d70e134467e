// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "own_effect.hpp"

#include <thermopower/plant/function_plant.hpp>

#include <pybind11/eigen.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// @file own_plant.hpp
/// Plants whose simulator is a Python function: plant::adapt_function() with it. The Python lock is taken for each call.

namespace thermopower::python {

/// The function as a simulator: `simulate(constants, start, t_s, inputs, effects)` with dicts by name, which answers
/// with a dict of arrays, the signals, and possibly `end`, a dict of the states at the last row.
inline plant::Simulator simulator_of(const plant::PlantInfo& info,
                                     const std::vector<plant::EffectInfo>& effects, Shared function) {
  return [info, effects, function](const plant::SimulatorCall& call) {
    const py::gil_scoped_acquire lock;
    py::dict constants, start, inputs, acting;
    for (std::size_t i = 0; i < info.constants.size(); ++i)
      constants[info.constants[i].name.c_str()] = call.constants[i];
    for (std::size_t i = 0; i < info.states.size(); ++i) start[info.states[i].name.c_str()] = call.start[i];
    for (std::size_t i = 0; i < info.inputs.size(); ++i)
      inputs[info.inputs[i].name.c_str()] =
          py::cast(Eigen::VectorXd(call.inputs.col(static_cast<Eigen::Index>(i))));
    for (std::size_t i = 0; i < effects.size(); ++i) {
      if (i >= call.effects.size() || call.effects[i].empty()) continue;
      py::dict parameters;
      for (std::size_t k = 0; k < effects[i].parameters.size(); ++k)
        parameters[effects[i].parameters[k].name.c_str()] = call.effects[i][k];
      acting[effects[i].id.c_str()] = parameters;
    }
    const py::object answer = (*function)(constants, start, call.t_s, inputs, acting);
    plant::SimulatorAnswer result;
    result.signals.resize(call.t_s.size(), static_cast<Eigen::Index>(info.signals.size()));
    for (std::size_t i = 0; i < info.signals.size(); ++i) {
      const std::string& name = info.signals[i].name;
      if (!answer.contains(name.c_str()))
        throw plant::InvalidInput("plant '" + info.type + "': its function did not answer '" + name + "'");
      const auto values = answer[name.c_str()].cast<Eigen::VectorXd>();
      if (values.size() != call.t_s.size())
        throw plant::InvalidInput("plant '" + info.type + "': its function answered " +
                                  std::to_string(values.size()) + " values of '" + name + "', expected " +
                                  std::to_string(call.t_s.size()));
      result.signals.col(static_cast<Eigen::Index>(i)) = values;
    }
    if (answer.contains("end")) {
      const py::object end = answer["end"];
      for (const plant::PlantState& state : info.states)
        result.end.push_back(end[state.name.c_str()].cast<double>());
    }
    return result;
  };
}

/// A model whose plant is a Python function. Each list has dicts, as thermopower.Plant makes them.
inline plant::Model own_plant(const std::string& name, const py::object& function,
                              const std::vector<py::dict>& constants, const std::vector<py::dict>& inputs,
                              const std::vector<py::dict>& states, const std::vector<py::dict>& signals,
                              const std::vector<py::dict>& effects, bool windowed) {
  const auto text = [](const py::dict& one, const char* key) { return one[key].cast<std::string>(); };
  plant::PlantInfo info;
  info.type = name;
  info.windowed = windowed;
  for (const py::dict& one : constants)
    info.constants.push_back({text(one, "part"), text(one, "name"), text(one, "unit"),
                              one["value"].cast<double>(), one["may_be_cause"].cast<bool>(),
                              one["above_zero"].cast<bool>()});
  for (const py::dict& one : inputs)
    info.inputs.push_back(
        {text(one, "name"), text(one, "unit"), one["otherwise"].cast<std::optional<double>>()});
  for (const py::dict& one : states)
    info.states.push_back({text(one, "name"), text(one, "unit"), one["measured_by"].cast<int>(),
                           one["initial"].cast<double>(), one["spread"].cast<double>(),
                           one["shows_in"].cast<int>()});
  for (const py::dict& one : signals) {
    plant::PlantSignal signal{
        text(one, "name"), text(one, "unit"), text(one, "submodel"), {}, text(one, "note")};
    if (const auto balance = one["balance"].cast<std::optional<py::dict>>())
      signal.balance = {text(*balance, "constant"), plant::QuantityName(text(*balance, "quantity")),
                        text(*balance, "unit"), (*balance)["leaves_by"].cast<std::vector<std::string>>()};
    info.signals.push_back(std::move(signal));
  }
  std::vector<plant::EffectInfo> known;
  for (const py::dict& one : effects) known.push_back(info_of(one));
  info.validate();
  plant::Simulator simulator = simulator_of(info, known, shared(function));
  return plant::adapt_function(name, std::move(info), known, std::move(simulator));
}

/// Constants of a plant of one's own, by name.
inline std::map<std::string, double> constants_of(const plant::Model& model) {
  std::map<std::string, double> result;
  if (model.own)
    for (const plant::PlantConstant& one : model.own->constants) result[one.name] = one.value;
  return result;
}

/// A model of a plant of one's own with other constants, and with effects that act.
inline plant::Model changed(plant::Model model, const std::map<std::string, double>& constants,
                            const std::map<std::string, std::map<std::string, double>>& effects) {
  for (const auto& [name, value] : constants) {
    bool known = false;
    if (model.own)
      for (plant::PlantConstant& one : model.own->constants)
        if (one.name == name) one.value = value, known = true;
    if (!known) throw plant::InvalidInput("model '" + model.name + "' has no constant '" + name + "'");
  }
  for (const auto& [id, parameters] : effects)
    for (const auto& [name, value] : parameters) model.effects[id][name] = value;
  return model;
}

}  // namespace thermopower::python
