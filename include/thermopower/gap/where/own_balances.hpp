// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/inputs.hpp>
#include <thermopower/plant/actuator_plant.hpp>
#include <thermopower/plant/balance.hpp>
#include <thermopower/plant/piecewise_linear.hpp>
#include <thermopower/plant/plant_info.hpp>
#include <thermopower/plant/samples.hpp>
#include <thermopower/plant/variable_words.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// @file
/// Balances of a plant of your own. They ask nothing but a rollout, so that a simulator behind a function call is localised, too.

namespace thermopower::gap::engine {

/// The balances of a plant of your own, one for each judged signal. Short windows are simulated from the measured states. The
/// error of a signal at a window's end, over its length, is a rate that was missing, or the quantity of its balance. Each
/// recorded variable may order it.
inline std::vector<plant::BalanceSource> own_balances(const Model& model, const Catalogue& catalogue,
                                                      const std::vector<Inputs>& recordings) {
  constexpr Eigen::Index windows = 300;  // per recording: fifty for each of the hats that may order a rate
  constexpr int hats_of_variable = 6;
  const Plant& plant = plant_of(model);
  const PlantInfo& info = *plant.info();
  const std::size_t signals = info.signals.size();
  std::vector<plant::Balance> balances(signals);
  std::vector<std::vector<double>> missed(signals), variables(info.inputs.size() + signals + 1);
  const auto rows = std::make_shared<plant::BalanceRows>();
  // What was missing leaves again while a window lasts, if the balance says so.
  const auto quantity = [&](std::size_t k, double error, double lasts_s) {
    const std::optional<plant::PlantBalance>& balance = info.signals[k].balance;
    if (!balance) return error / lasts_s;
    const double storage = model.get(balance->constant);
    double leaves = 0.0;
    for (const std::string& name : balance->leaves_by) leaves += model.get(name) / storage * lasts_s;
    return error / lasts_s * storage * (leaves > 1e-6 ? leaves / -std::expm1(-leaves) : 1.0);
  };
  for (const Inputs& inputs : recordings) {
    const Eigen::Index length = std::max<Eigen::Index>(1, inputs.rows() / windows);
    const auto rollout = plant.rollout(model, catalogue, {}, {}, SimulationMode::free_running);
    const auto measured_at = [&](Eigen::Index row, std::size_t signal) {
      return inputs.judged(static_cast<Signal>(signal)) ? inputs.of(static_cast<Signal>(signal))[row]
                                                        : missing;
    };
    Readings readings;
    for (const RunSpan& run : inputs.runs) {
      const auto first = static_cast<Eigen::Index>(missed.front().size());
      // A window ends with the row it is judged at; what nobody measures is carried on to the row after it.
      for (Eigen::Index begin = run.begin; begin + length < run.end; begin += length + 1) {
        const Segment window{&inputs, run, begin, begin + length + 1, true, begin > run.begin, false};
        if (std::any_of(info.states.begin(), info.states.end(), [&](const PlantState& state) {
              return state.measured_by >= 0 && inputs.judged(static_cast<Signal>(state.measured_by)) &&
                     !std::isfinite(measured_at(begin, static_cast<std::size_t>(state.measured_by)));
            }))
          continue;
        rollout->roll(window, Start::Zero(plant.start_size(window)), readings);
        const Eigen::Index end = begin + length;
        const double lasts_s = inputs.t_s[end] - inputs.t_s[begin];
        auto column = variables.begin();
        for (const Eigen::VectorXd& input : inputs.own_inputs)
          column++->push_back(input.segment(begin, length).mean());
        for (std::size_t k = 0; k < signals; ++k) {
          missed[k].push_back(
              quantity(k, measured_at(end, k) - readings.value(end, static_cast<int>(k)), lasts_s));
          column++->push_back(measured_at(begin, k));
        }
        column->push_back(0.5 * (inputs.t_s[begin] + inputs.t_s[end]));
      }
      rows->runs.push_back({first, static_cast<Eigen::Index>(missed.front().size()), run.label});
    }
    const double lasts_s = static_cast<double>(length) * plant::median_interval_s(inputs.t_s, inputs.runs);
    for (std::size_t k = 0; k < signals; ++k)
      if (const auto signal = static_cast<Signal>(k); inputs.judged(signal)) {
        const double at_both_ends = std::sqrt(2.0) * plant::sample_noise(inputs.of(signal), inputs.runs);
        balances[k].noise = std::max(balances[k].noise, quantity(k, at_both_ends, lasts_s));
      }
  }
  const auto vector = [](const std::vector<double>& list) {
    return Eigen::VectorXd(
        Eigen::Map<const Eigen::VectorXd>(list.data(), static_cast<Eigen::Index>(list.size())));
  };
  rows->t_s = vector(variables.back());
  rows->interval_s = plant::median_interval_s(rows->t_s, rows->runs);
  std::vector<plant::OrderingVariable> list;
  for (const PlantInput& one : info.inputs) list.push_back({one.name, one.unit, {}});
  for (const PlantSignal& one : info.signals) list.push_back({one.name, one.unit, {}});
  list.push_back({"t_s", "s", {}});
  for (std::size_t i = 0; i < list.size(); ++i) list[i].values = vector(variables[i]);
  std::vector<plant::BalanceSource> sources;
  for (std::size_t k = 0; k < signals; ++k) {
    const PlantSignal& signal = info.signals[k];
    plant::Balance& b = balances[k];
    if (!(b.noise > 0.0)) continue;
    b.quantity = signal.balance ? signal.balance->quantity
                                : plant::QuantityName("missing rate of " + plant::the_variable(signal.name));
    b.unit = signal.balance ? signal.balance->unit : signal.unit + "/s";
    b.signal = plant::SignalName(signal.name);
    b.otherwise = plant::SubmodelName(signal.submodel);
    b.given = "From each measured state on" + (signal.note.empty() ? "" : ", " + signal.note);
    b.rows = rows;
    b.measured = b.state = vector(missed[k]);
    b.flow_sampled = Eigen::VectorXd::Zero(b.measured.size());
    b.variables = list;
    for (const plant::OrderingVariable& one : list)
      plant::add_sampled_freedom(b, b.otherwise, one.name,
                                 to_string(b.quantity) + " by " + plant::the_variable(one.name),
                                 [values = one.values] { return plant::hats(values, hats_of_variable); });
    sources.push_back({b.quantity, b.signal, {}, [b](const plant::ReadingOffsets&) { return b; }});
  }
  return sources;
}

}  // namespace thermopower::gap::engine
