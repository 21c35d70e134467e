// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/finding_list.hpp>
#include <thermopower/gap/model.hpp>
#include <thermopower/gap/recording.hpp>
#include <thermopower/plant/axis_rollout.hpp>
#include <thermopower/plant/charge_before.hpp>
#include <thermopower/plant/goal_profile.hpp>
#include <thermopower/plant/plant.hpp>
#include <thermopower/plant/plant_info.hpp>
#include <thermopower/plant/rows.hpp>
#include <thermopower/plant/variable_words.hpp>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

namespace thermopower::gap::engine {

/// Fills holes with the value before them (after them at a run's start).
inline Eigen::VectorXd held(const Eigen::VectorXd& values, const std::vector<RunSpan>& runs) {
  Eigen::VectorXd filled = values;
  for (const RunSpan& run : runs) {
    Eigen::Index first = run.begin;
    while (first < run.end && !std::isfinite(values[first])) ++first;
    if (first == run.end) continue;
    double last = values[first];
    for (Eigen::Index row = run.begin; row < run.end; ++row) {
      if (std::isfinite(values[row])) last = values[row];
      filled[row] = last;
    }
  }
  // A run without a single sample: the nearest earlier run's last value, else 0.
  double last = 0.0;
  for (Eigen::Index row = 0; row < filled.size(); ++row) {
    if (std::isfinite(filled[row])) last = filled[row];
    else filled[row] = last;
  }
  return filled;
}

/// Undoes wraps of an angle recorded modulo 360 degrees: jumps of more than half a turn between neighbours
/// that land within a tenth of a turn of a whole one, in a record that stays inside one turn.
inline Eigen::VectorXd unwrapped(const Eigen::VectorXd& angle_deg, const std::vector<RunSpan>& runs) {
  double low = 1e300, high = -1e300;
  for (double angle : angle_deg)
    if (std::isfinite(angle)) low = std::fmin(low, angle), high = std::fmax(high, angle);
  if (!(high - low <= 360.5) || !(high - low > 300.0)) return angle_deg;
  Eigen::VectorXd result = angle_deg;
  for (const RunSpan& run : runs) {
    double turns = 0.0, previous = missing;
    for (Eigen::Index row = run.begin; row < run.end; ++row) {
      if (!std::isfinite(angle_deg[row])) continue;
      const double step = angle_deg[row] - previous;
      if (std::abs(step) > 324.0) turns -= step > 0.0 ? 1.0 : -1.0;
      previous = angle_deg[row];
      result[row] = angle_deg[row] + 360.0 * turns;
    }
  }
  return result;
}

/// Slopes of a column by its neighbours in a run, per second; 0 in a run of one row.
inline Eigen::VectorXd slopes_of(const Eigen::VectorXd& values, const Eigen::VectorXd& t_s,
                                 const std::vector<RunSpan>& runs) {
  Eigen::VectorXd slopes = Eigen::VectorXd::Zero(values.size());
  for (const RunSpan& run : runs)
    for (Eigen::Index row = run.begin; row < run.end && run.size() > 1; ++row) {
      const Eigen::Index before = std::max(run.begin, row - 1), after = std::min(run.end - 1, row + 1);
      slopes[row] = (values[after] - values[before]) / (t_s[after] - t_s[before]);
    }
  return slopes;
}

/// Lets the model's servo make the command: of its target and of the motion that was measured.
inline void close_loop(const Model& model, Inputs& inputs) {
  inputs.closed_loop = true;
  const auto seen = [&](Signal signal) {
    return inputs.judged(signal) ? held(inputs.of(signal), inputs.runs)
                                 : Eigen::VectorXd(Eigen::VectorXd::Zero(inputs.rows()));
  };
  inputs.seen_deg = seen(Signal::angle_deg);
  inputs.seen_dps = inputs.judged(Signal::rate_dps) ? seen(Signal::rate_dps)
                                                    : slopes_of(inputs.seen_deg, inputs.t_s, inputs.runs);
  replay_servo(model, inputs);
}

/// The column in which with_heater_duty() leaves what a heater's loop makes of the recorded temperature, 0..255.
inline constexpr const char* heater_power_column = "heater_power";

/// The names of a recording's columns, as sentences have them.
inline std::string columns_in_words(const Recording& recording) {
  std::vector<std::string> names = {"t_s"};
  for (const Column& column : recording.columns) names.push_back(column.name);
  return listed(names, 13);
}

/// Takes from a recording what a plant of one's own needs, by the names of its columns.
inline Inputs prepare_own(const plant::PlantInfo& info, const Recording& recording) {
  Inputs inputs;
  inputs.own = true;
  inputs.name = recording.name;
  inputs.t_s = recording.t_s;
  inputs.runs = recording.spans();
  bool complete = true;
  for (const plant::PlantInput& input : info.inputs) {
    if (recording.has(input.name)) {
      inputs.own_inputs.push_back(held(recording.column(input.name), inputs.runs));
    } else {
      if (!input.otherwise) {
        complete = false;
        inputs.not_judged.push_back({"", "nothing is judged: the recording has no column " + input.name});
      }
      inputs.own_inputs.push_back(Eigen::VectorXd::Constant(recording.rows(), input.otherwise.value_or(0.0)));
    }
  }
  for (std::size_t i = 0; i < info.signals.size(); ++i) {
    const std::string& name = info.signals[i].name;
    if (!recording.has(name))
      inputs.not_judged.push_back(
          {name, plant::the_variable(name) + " is not judged: the recording has no column " + name});
    else if (complete) inputs.measured[i] = recording.column(name);
  }
  return inputs;
}

/// Takes from a recording what the model needs, and notes what cannot be judged and why.
/// @throws InvalidInput where the recording is invalid
inline Inputs prepare(const Model& model, const Recording& recording) {
  if (const auto problem = recording.validate())
    throw InvalidInput("recording '" + recording.name + "': " + *problem);
  if (model.own) return prepare_own(*model.own->equations->info(), recording);
  Inputs inputs;
  inputs.name = recording.name;
  inputs.t_s = recording.t_s;
  inputs.runs = recording.spans();
  const auto take = [&](const char* column) {
    return recording.has(column) ? held(recording.column(column), inputs.runs) : Eigen::VectorXd();
  };
  const auto measure = [&](Signal signal) {
    inputs.measured[static_cast<std::size_t>(signal)] = recording.column(to_string(signal));
  };
  inputs.power_param = take("power_param");
  inputs.drive_A = take("drive_A");
  inputs.supply_V = take("supply_V");
  inputs.ambient_C = take("ambient_C");
  inputs.airspeed_mps = take("airspeed_mps");
  inputs.neighbour_C = take("neighbour_C");
  if (model.supply) inputs.nominal_V = model.supply->nominal_V;

  const bool duty_is_recorded = inputs.power_param.size() > 0;
  if (model.has_heater() && recording.has("target_C") &&
      (!duty_is_recorded || model.heater_acts_on == plant::HeaterActsOn::simulated)) {
    const bool answers = recording.has(heater_power_column);
    inputs.target_C = take("target_C");
    inputs.heater_closed = !answers || model.simulates_heater_loop();
    if (!duty_is_recorded)
      inputs.power_param =
          answers ? take(heater_power_column) : Eigen::VectorXd(Eigen::VectorXd::Zero(inputs.rows()));
  }
  if (inputs.heater_answers()) {
    // A row in which it was switched: the instant is known to a part of the time between rows.
    constexpr double instant = 0.3;
    const double most = inputs.power_param.maxCoeff();
    inputs.command_unknown.between =
        ((inputs.power_param.array() > 0.0) && (inputs.power_param.array() < most))
            .select(Eigen::VectorXd::Constant(inputs.rows(), instant * most), 0.0);
  }
  const bool powered = inputs.power_param.size() > 0 && (model.supply || inputs.supply_V.size() > 0);
  const bool ohmic = std::holds_alternative<OhmicCurrentModel>(model.current);
  if (model.has_current() && powered) inputs.heat = HeatSource::law;
  else if (recording.has("current_A") && (ohmic || (powered && model.has_current())))
    inputs.heat = HeatSource::measured;
  else if (inputs.drive_A.size() > 0 && ohmic) inputs.heat = HeatSource::drive;
  if (model.has_thermal()) inputs.heat_W = take("heat_W");
  if (inputs.heat == HeatSource::none && inputs.heat_W.size() > 0) inputs.heat = HeatSource::recorded;
  inputs.held_current_A = take("current_A");
  plant::RecordedCharge(inputs.t_s, inputs.held_current_A, inputs.power_param).tell(inputs.runs);
  inputs.held_motor_C = take("motor_C");

  auto& notes = inputs.not_judged;
  const auto lack = [&](const char* what, const char* column) {
    notes.push_back({what, plant::the_variable(what) + " is not judged: " +
                               (recording.find(column) != nullptr || recording.is_empty(column)
                                    ? "column " + std::string(column) + " has no sample"
                                    : "the recording has no column " + std::string(column))});
  };
  if (model.has_thermal()) {
    if (!recording.has("motor_C")) lack("motor_C", "motor_C");
    else if (!recording.has("ambient_C")) lack("motor_C", "ambient_C");
    else if (inputs.heat == HeatSource::none)
      notes.push_back(
          {"motor_C",
           "the motor temperature is not judged: neither power_param (with a current law and a supply) nor current_A nor "
           "drive_A nor heat_W tells the heat"});
    else measure(Signal::motor_C);
  } else if (recording.has("motor_C") && !model.has_axis()) {
    notes.push_back({"motor_C", "the motor temperature is not judged: the model has no thermal block"});
  }
  if (model.has_current()) {
    if (!recording.has("current_A")) lack("current_A", "current_A");
    else if (!powered)
      notes.push_back(
          {"current_A", "the motor current is not judged: power_param or the supply voltage is unknown"});
    else if (!recording.has("motor_C")) lack("current_A", "motor_C");
    else measure(Signal::current_A);
  }
  if (model.has_axis()) {
    const bool voltage_driven = model.axis->voltage_driven();
    inputs.voltage_V = take("voltage_V");
    inputs.torque_Nm = take("torque_Nm");
    const bool commanded = command(inputs, voltage_driven).size() > 0;
    const bool position = std::holds_alternative<PositionPidServo>(model.servo);
    const char* const target = position ? "target_deg" : "target_dps";
    const char* const senses = position ? "angle_deg" : "rate_dps";
    if (model.has_servo() && !commanded) {
      inputs.target_deg = take("target_deg");
      inputs.target_dps = take("target_dps");
    }
    if (!commanded && model.has_servo() && !recording.has(target)) {
      lack("the axis", target);
    } else if (!commanded && model.has_servo() && !recording.has(senses) &&
               !(recording.has("angle_deg") && !position)) {
      lack("the axis", senses);
    } else if (!commanded && !model.has_servo()) {
      lack("the axis", voltage_driven ? "voltage_V" : "drive_A");
    } else if (!recording.has("rate_dps") && !recording.has("angle_deg")) {
      notes.push_back(
          {"the axis", "the axis is not judged: the recording has neither angle_deg nor rate_dps"});
    } else {
      if (recording.has("rate_dps")) measure(Signal::rate_dps);
      else lack("rate_dps", "rate_dps");
      if (recording.has("angle_deg"))
        inputs.measured[static_cast<std::size_t>(Signal::angle_deg)] =
            unwrapped(recording.column("angle_deg"), inputs.runs);
      else lack("angle_deg", "angle_deg");
      inputs.covariate_motor_C = take("motor_C");
      if (!commanded) {
        if (recording.has("current_A") && !model.has_current() && !model.has_thermal()) {
          inputs.effort_is_output = true;
          inputs.drive_A = take("current_A");
          measure(Signal::current_A);
        }
        plant::follow_profile(model, inputs);
        close_loop(model, inputs);
      }
    }
  }
  if (inputs.bench()) inputs.covariate_rate_dps = take("rate_dps");
  if (!inputs.bench() && !inputs.axis())
    notes.push_back({"", "the columns that were recorded are " + columns_in_words(recording)});
  return inputs;
}

/// Sentences about signals that are not judged, each once. One that holds of some recordings only names them: of
/// the others the signal is judged.
/// @param parts  of the recordings
inline std::vector<std::string> not_judged_in(std::initializer_list<const std::vector<Inputs>*> parts) {
  std::vector<const Inputs*> all;
  for (const std::vector<Inputs>* const part : parts)
    for (const Inputs& one : *part) all.push_back(&one);
  std::vector<std::string> sentences;
  for (const Inputs* one : all)
    for (const plant::NotJudged& note : one->not_judged)
      if (std::find(sentences.begin(), sentences.end(), note.sentence) == sentences.end())
        sentences.push_back(note.sentence);
  for (std::string& sentence : sentences) {
    std::vector<std::string> names;
    std::size_t count = 0;
    for (const Inputs* one : all) {
      const bool says_so =
          std::any_of(one->not_judged.begin(), one->not_judged.end(),
                      [&](const plant::NotJudged& note) { return note.sentence == sentence; });
      if (!says_so) continue;
      ++count;
      if (std::find(names.begin(), names.end(), one->name) == names.end()) names.push_back(one->name);
    }
    if (count == all.size()) continue;
    sentence = listed(names) + ": " + sentence;
  }
  return sentences;
}

}  // namespace thermopower::gap::engine
