// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/robust.hpp>
#include <thermopower/gap/data/sort_by.hpp>
#include <thermopower/gap/diagnosis.hpp>
#include <thermopower/gap/localise/localise_balances.hpp>
#include <thermopower/gap/recording.hpp>
#include <thermopower/plant/actuator_plant.hpp>
#include <thermopower/plant/plant_info.hpp>
#include <thermopower/plant/variable_words.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

namespace thermopower::gap::engine {

/// How a plant of your own is localised. Held by tests/gap/localise/own_balances_test.cpp.
struct OwnPlantThresholds {
  Eigen::Index windows = 300;  ///< short simulations per recording: bins of 20 samples at 15 bins
  double noise_factor =
      1.5;                   ///< what the starts' noise explains of a rate, times this, is no gap: its spread
  double least_order = 0.1;  ///< correlation ratio below which nothing recorded is said to order a rate
};
inline constexpr OwnPlantThresholds own_plant_thresholds{};

/// What a signal of a plant of your own lacks at the end of short windows, and what may order it.
struct MissingRate {
  Observed seen;  ///< the missing quantity, one sample per window; its noise is what the starts alone make
  double storage = 1.0;       ///< what makes a quantity of a rate, where a balance says so
  double leaves_per_s = 0.0;  ///< how fast what was missing leaves again

  /// The quantity that was missing all along a window, from the error at its end, in the signal's unit.
  double quantity(double missed, double lasts_s) const {
    const double leaves = leaves_per_s * lasts_s;
    return missed / lasts_s * storage * (leaves > 1e-6 ? leaves / -std::expm1(-leaves) : 1.0);
  }
};

/// Simulates short windows from the measured states: what each signal misses at its end, over its length. One for each signal.
inline std::vector<MissingRate> missing_rates(const Model& model, const Catalogue& catalogue,
                                              const std::vector<Inputs>& recordings) {
  const Plant& plant = plant_of(model);
  const PlantInfo& info = *plant.info();
  const std::size_t signals = info.signals.size();
  std::vector<MissingRate> result(signals);
  std::vector<std::vector<double>> values(signals);
  std::vector<std::vector<std::vector<double>>> variables(signals);  // of each signal, by axis
  for (std::size_t k = 0; k < signals; ++k) {
    Observed& seen = result[k].seen;
    const std::optional<plant::PlantBalance>& balance = info.signals[k].balance;
    seen.signal = plant::SignalName(info.signals[k].name);
    seen.quantity = balance
                        ? balance->quantity
                        : plant::QuantityName("missing rate of " + plant::the_variable(info.signals[k].name));
    seen.unit = balance ? balance->unit : info.signals[k].unit + "/s";
    for (const PlantInput& one : info.inputs) seen.axes.push_back({one.name, one.unit, {}});
    for (const PlantSignal& one : info.signals) seen.axes.push_back({one.name, one.unit, {}});
    seen.axes.push_back({"t_s", "s", {}});
    variables[k].resize(seen.axes.size());
    if (!balance) continue;
    result[k].storage = model.get(balance->constant);
    for (const std::string& name : balance->leaves_by)
      result[k].leaves_per_s += model.get(name) / result[k].storage;
  }
  for (const Inputs& inputs : recordings) {
    const Eigen::Index length = std::max<Eigen::Index>(1, inputs.rows() / own_plant_thresholds.windows);
    const auto rollout = plant.rollout(model, catalogue, {}, {}, SimulationMode::free_running);
    Readings readings;
    for (const RunSpan& run : inputs.runs)
      // A window ends with the row it is judged at; what nobody measures is carried on to the row after it.
      for (Eigen::Index begin = run.begin; begin + length < run.end; begin += length + 1) {
        const Segment window{&inputs, run, begin, begin + length + 1, true, begin > run.begin, false};
        const bool usable = std::all_of(info.states.begin(), info.states.end(), [&](const PlantState& state) {
          const auto signal = static_cast<Signal>(state.measured_by);
          return state.measured_by < 0 || !inputs.judged(signal) || std::isfinite(inputs.of(signal)[begin]);
        });
        if (!usable) continue;
        rollout->roll(window, Start::Zero(plant.start_size(window)), readings);
        const Eigen::Index end = begin + length;
        const double lasts_s = inputs.t_s[end] - inputs.t_s[begin];
        for (std::size_t k = 0; k < signals; ++k) {
          const Signal signal = static_cast<Signal>(k);
          if (!inputs.judged(signal)) continue;
          const double missed = inputs.of(signal)[end] - readings.value(end, static_cast<int>(k));
          if (!std::isfinite(missed)) continue;
          values[k].push_back(result[k].quantity(missed, lasts_s));
          result[k].seen.interval_s = lasts_s;
          std::size_t at = 0;
          for (std::size_t i = 0; i < info.inputs.size(); ++i)
            variables[k][at++].push_back(inputs.own_inputs[i].segment(begin, length).mean());
          for (std::size_t i = 0; i < signals; ++i) {
            const bool there = inputs.judged(static_cast<Signal>(i));
            variables[k][at++].push_back(there ? inputs.of(static_cast<Signal>(i))[begin] : missing);
          }
          variables[k][at].push_back(0.5 * (inputs.t_s[begin] + inputs.t_s[end]));
        }
      }
    for (std::size_t k = 0; k < signals; ++k)
      if (inputs.judged(static_cast<Signal>(k)))
        result[k].seen.noise =
            std::max(result[k].seen.noise, white_scale(inputs.of(static_cast<Signal>(k)), inputs.runs));
  }
  const auto vector = [](const std::vector<double>& list) {
    return Eigen::VectorXd(
        Eigen::Map<const Eigen::VectorXd>(list.data(), static_cast<Eigen::Index>(list.size())));
  };
  for (std::size_t k = 0; k < signals; ++k) {
    Observed& seen = result[k].seen;
    seen.value = vector(values[k]);
    for (std::size_t i = 0; i < seen.axes.size(); ++i) seen.axes[i].values = vector(variables[k][i]);
    seen.noise = result[k].quantity(seen.noise * std::sqrt(2.0), seen.interval_s);
  }
  return result;
}

/// The places where a plant of your own and recordings part, from its short simulations. Each starts from the measured
/// state. Its error at the end, over its length, is the rate that the equations lack.
///
/// It asks nothing but a rollout, so that a simulator behind a function call is localised, too. Returns a location
/// and a picture for each signal that misses more than its noise explains.
inline Localisation localise_own_plant(const Model& model, const Catalogue& catalogue,
                                       const std::vector<Inputs>& recordings) {
  Localisation found;
  const PlantInfo& info = *plant_of(model).info();
  const std::vector<MissingRate> rates = missing_rates(model, catalogue, recordings);
  for (std::size_t k = 0; k < rates.size(); ++k) {
    const Observed& seen = rates[k].seen;
    if (seen.value.size() < LocalisationThresholds().least_rows) continue;
    const double rms = std::sqrt(seen.value.squaredNorm() / static_cast<double>(seen.value.size()));
    if (rms < own_plant_thresholds.noise_factor * seen.noise) continue;
    const Ordered ordered = strongest_axis(seen);
    const OrderingAxis* axis = seen.find(ordered.axis);
    if (axis == nullptr) axis = &seen.axes.back();
    MissingQuantity picture =
        binned(seen, *axis, equal_count_edges(axis->values, LocalisationThresholds().picture_bins));
    Location location;
    location.signal = seen.signal;
    location.submodel = plant::SubmodelName(info.signals[k].submodel);
    location.share = std::clamp(1.0 - seen.noise * seen.noise / (rms * rms), 0.0, 1.0);
    char text[400];
    std::snprintf(
        text, sizeof text,
        "From each measured state on, %s misses %.3g %s (root mean square), where noise explains %.3g;",
        plant::the_variable(info.signals[k].name).c_str(), rms, seen.unit.c_str(), seen.noise);
    location.evidence = text;
    if (ordered.ratio > own_plant_thresholds.least_order && picture.x.size() > 0) {
      std::snprintf(text, sizeof text, " it follows %s most (correlation ratio %.2f).",
                    plant::the_variable(axis->name).c_str(), ordered.ratio);
      location.regime = Regime{axis->name, picture.x[0], picture.x[picture.x.size() - 1]};
    } else {
      std::snprintf(text, sizeof text, " nothing recorded orders it.");
    }
    location.evidence += text;
    if (!info.signals[k].note.empty()) location.evidence += " It is " + info.signals[k].note + ".";
    found.where.push_back(std::move(location));
    found.quantities.push_back(std::move(picture));
  }
  sort_by(found.where, [](const Location& one) { return -one.share; });
  return found;
}

/// Draws what the causes of an augmented model supply into pictures of missing rates.
/// @param simulated   the recordings, their signals replaced by the augmented model's
/// @param quantities  their `effect` is written
inline void draw_own_effect(const Model& baseline, const Catalogue& catalogue,
                            const std::vector<Inputs>& simulated, std::vector<MissingQuantity>& quantities) {
  for (const MissingRate& one : missing_rates(baseline, catalogue, simulated))
    for (MissingQuantity& picture : quantities)
      if (const OrderingAxis* axis = one.seen.find(picture.variable);
          axis && picture.signal == one.seen.signal)
        set_effect(picture, axis->values, one.seen.value);
}

}  // namespace thermopower::gap::engine
