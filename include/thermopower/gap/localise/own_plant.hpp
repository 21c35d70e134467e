// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/sort_by.hpp>
#include <thermopower/gap/diagnosis.hpp>
#include <thermopower/gap/localise/missing_quantity.hpp>
#include <thermopower/gap/recording.hpp>
#include <thermopower/plant/actuator_plant.hpp>
#include <thermopower/plant/plant_info.hpp>
#include <thermopower/plant/variable_words.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace thermopower::gap::engine {

/// How a plant of your own is localised. Held by tests/gap/localise/own_balances_test.cpp.
struct OwnPlantThresholds {
  Eigen::Index windows = 300;  ///< short simulations per recording: bins of 20 samples at 15 bins
  double noise_factor =
      1.5;                   ///< what the starts' noise explains of a rate, times this, is no gap: its spread
  double least_order = 0.1;  ///< correlation ratio below which nothing recorded is said to order a rate
  int bins = 12;             ///< of a picture
};
inline constexpr OwnPlantThresholds own_plant_thresholds{};

/// Samples of a rate that the equations of a plant of your own lack, in bins of a variable that may order it.
class OrderedRate {
public:
  /// @param rate, variable  equally many; samples without a variable are left out
  OrderedRate(const std::vector<double>& rate, const std::vector<double>& variable, int bins) {
    assert(variable.size() == rate.size() && bins > 0);
    for (std::size_t i = 0; i < rate.size(); ++i)
      if (std::isfinite(variable[i])) samples_.push_back({variable[i], rate[i]});
    sort_by(samples_, [](const auto& one) { return one.first; });
    const std::size_t count = samples_.size();
    // Bins of equally many samples; equal values are not torn apart.
    for (std::size_t k = 0, begin = 0; k < static_cast<std::size_t>(bins) && begin < count; ++k) {
      std::size_t end = std::max(begin + 1, count * (k + 1) / static_cast<std::size_t>(bins));
      while (end < count && samples_[end].first == samples_[end - 1].first) ++end;
      edges_.push_back({begin, end});
      begin = end;
    }
  }

  /// Share of the variance that the means of the bins explain, 0..1.
  double correlation_ratio() const {
    double sum = 0.0, square = 0.0;
    for (const auto& one : samples_) sum += one.second, square += one.second * one.second;
    const double count = static_cast<double>(samples_.size());
    if (edges_.size() < 2 || count < 4.0) return 0.0;
    double between = 0.0;
    for (const auto& [begin, end] : edges_) {
      double part = 0.0;
      for (std::size_t i = begin; i < end; ++i) part += samples_[i].second;
      between += part * part / static_cast<double>(end - begin);
    }
    const double variance = square - sum * sum / count;
    return variance > 0.0 ? std::clamp((between - sum * sum / count) / variance, 0.0, 1.0) : 0.0;
  }

  /// Writes the bins' means and standard errors.
  void draw(MissingQuantity& picture) const {
    const Eigen::Index bins = static_cast<Eigen::Index>(edges_.size());
    picture.x.resize(bins);
    picture.value.resize(bins);
    picture.spread.resize(bins);
    for (Eigen::Index k = 0; k < bins; ++k) {
      const auto& [begin, end] = edges_[static_cast<std::size_t>(k)];
      double x = 0.0, y = 0.0, yy = 0.0;
      const double n = static_cast<double>(end - begin);
      for (std::size_t i = begin; i < end; ++i) {
        x += samples_[i].first;
        y += samples_[i].second;
        yy += samples_[i].second * samples_[i].second;
      }
      picture.x[k] = x / n;
      picture.value[k] = y / n;
      picture.spread[k] = n > 1.0 ? std::sqrt(std::max(yy - y * y / n, 0.0) / (n - 1.0) / n) : std::abs(y);
    }
  }

private:
  std::vector<std::pair<double, double>> samples_;
  std::vector<std::pair<std::size_t, std::size_t>> edges_;
};

/// Standard deviation of the noise on a smooth signal, from the median magnitude of its second differences. These are
/// sqrt(6) times as large as the noise, and 0.6745 is the median for a normal distribution of deviation 1.
inline double noise_of_smooth(const Eigen::VectorXd& values, const std::vector<RunSpan>& runs) {
  std::vector<double> magnitudes;
  for (const RunSpan& run : runs)
    for (Eigen::Index i = run.begin + 1; i + 1 < run.end; ++i) {
      const double second = values[i - 1] - 2.0 * values[i] + values[i + 1];
      if (std::isfinite(second)) magnitudes.push_back(std::abs(second));
    }
  if (magnitudes.empty()) return 0.0;
  const auto middle = magnitudes.begin() + static_cast<std::ptrdiff_t>(magnitudes.size() / 2);
  std::nth_element(magnitudes.begin(), middle, magnitudes.end());
  return *middle / (0.6745 * std::sqrt(6.0));
}

/// The rates that the equations of a plant of your own lack, with the variables that may order them.
struct MissingRates {
  /// Of one signal.
  struct Samples {
    std::vector<double> rate;                    ///< in the signal's unit per second, or in its balance's
    std::vector<std::vector<double>> variables;  ///< as many values each, in the order of `names`
    double interval_s = 0.0;                     ///< length of the last window
    double noise = 0.0;                          ///< standard deviation of the measured signal
    double storage = 1.0;                        ///< what makes a quantity of a rate, where a balance says so
    double leaves_per_s = 0.0;                   ///< how fast what was missing leaves again

    /// The rate that was missing all along a window, from the error at its end, in the signal's unit.
    double quantity(double missed, double lasts_s) const {
      const double leaves = leaves_per_s * lasts_s;
      return missed / lasts_s * storage * (leaves > 1e-6 ? leaves / -std::expm1(-leaves) : 1.0);
    }
  };
  std::vector<Samples> of;         ///< by signal
  std::vector<std::string> names;  ///< of the variables: inputs, signals, time
  std::vector<std::string> units;  ///< of the variables
};

/// Simulates short windows from the measured states: what each misses at its end, over its length.
inline MissingRates missing_rates(const Model& model, const Catalogue& catalogue,
                                  const std::vector<Inputs>& recordings) {
  const Plant& plant = plant_of(model);
  const PlantInfo& info = *plant.info();
  const std::size_t signals = info.signals.size();
  using Samples = MissingRates::Samples;
  MissingRates result;
  std::vector<Samples>& of = result.of;
  std::vector<std::string>&names = result.names, &units = result.units;
  of.resize(signals);
  for (const PlantInput& one : info.inputs) names.push_back(one.name), units.push_back(one.unit);
  for (const PlantSignal& one : info.signals) names.push_back(one.name), units.push_back(one.unit);
  names.push_back("t_s"), units.push_back("s");
  for (Samples& one : of) one.variables.resize(names.size());
  for (std::size_t k = 0; k < signals; ++k)
    if (const auto& balance = info.signals[k].balance) {
      of[k].storage = model.get(balance->constant);
      for (const std::string& name : balance->leaves_by)
        of[k].leaves_per_s += model.get(name) / of[k].storage;
    }
  for (const Inputs& inputs : recordings) {
    const Eigen::Index length = std::max<Eigen::Index>(1, inputs.rows() / own_plant_thresholds.windows);
    const auto rollout = plant.rollout(model, catalogue, {}, {}, SimulationMode::free_running);
    Readings readings;
    for (const RunSpan& run : inputs.runs)
      // A window ends with the row it is judged at; what nobody measures is carried on to the row after it.
      for (Eigen::Index begin = run.begin; begin + length < run.end; begin += length + 1) {
        const Segment window{&inputs, run, begin, begin + length + 1, true, begin > run.begin, false};
        bool usable = true;
        for (const PlantState& state : info.states)
          if (state.measured_by >= 0 && inputs.judged(static_cast<Signal>(state.measured_by)))
            usable = usable && std::isfinite(inputs.of(static_cast<Signal>(state.measured_by))[begin]);
        if (!usable) continue;
        rollout->roll(window, Start::Zero(plant.start_size(window)), readings);
        const Eigen::Index end = begin + length;
        const double lasts_s = inputs.t_s[end] - inputs.t_s[begin];
        for (std::size_t k = 0; k < signals; ++k) {
          const Signal signal = static_cast<Signal>(k);
          if (!inputs.judged(signal)) continue;
          const double missed = inputs.of(signal)[end] - readings.value(end, static_cast<int>(k));
          if (!std::isfinite(missed)) continue;
          Samples& samples = of[k];
          samples.rate.push_back(samples.quantity(missed, lasts_s));
          samples.interval_s = lasts_s;
          std::size_t at = 0;
          const auto put = [&](double value) { samples.variables[at++].push_back(value); };
          for (std::size_t i = 0; i < info.inputs.size(); ++i)
            put(inputs.own_inputs[i].segment(begin, length).mean());
          for (std::size_t i = 0; i < signals; ++i) {
            const bool there = inputs.judged(static_cast<Signal>(i));
            put(there ? inputs.of(static_cast<Signal>(i))[begin] : missing);
          }
          put(0.5 * (inputs.t_s[begin] + inputs.t_s[end]));
        }
      }
    for (std::size_t k = 0; k < signals; ++k)
      if (inputs.judged(static_cast<Signal>(k))) {
        const Eigen::VectorXd& values = inputs.of(static_cast<Signal>(k));
        of[k].noise = std::max(of[k].noise, noise_of_smooth(values, inputs.runs));
      }
  }
  return result;
}

/// The places where a plant of your own and recordings part, from its short simulations. Each starts from the measured
/// state. Its error at the end, over its length, is the rate that the equations lack.
///
/// It asks nothing but a rollout, so that a simulator behind a function call is localised, too. `found` receives a location
/// and a picture for each signal that misses more than its noise explains.
template <class Found>
void localise_own_plant(const Model& model, const Catalogue& catalogue, const std::vector<Inputs>& recordings,
                        Found& found) {
  const PlantInfo& info = *plant_of(model).info();
  const MissingRates rates = missing_rates(model, catalogue, recordings);
  const std::vector<std::string>&names = rates.names, &units = rates.units;
  for (std::size_t k = 0; k < rates.of.size(); ++k) {
    const MissingRates::Samples& samples = rates.of[k];
    if (samples.rate.size() < 30) continue;
    double squares = 0.0;
    for (double rate : samples.rate) squares += rate * rate;
    const double expected = samples.quantity(samples.noise * std::sqrt(2.0), samples.interval_s);
    const double seen = std::sqrt(squares / static_cast<double>(samples.rate.size()));
    if (seen < own_plant_thresholds.noise_factor * expected) continue;
    std::size_t best = names.size() - 1;
    double order = 0.0;
    for (std::size_t i = 0; i < names.size(); ++i) {
      const double ratio =
          OrderedRate(samples.rate, samples.variables[i], own_plant_thresholds.bins).correlation_ratio();
      if (ratio > order) order = ratio, best = i;
    }
    MissingQuantity picture;
    picture.signal = plant::SignalName(info.signals[k].name);
    const std::optional<plant::PlantBalance>& balance = info.signals[k].balance;
    picture.quantity =
        balance ? balance->quantity
                : plant::QuantityName("missing rate of " + plant::the_variable(info.signals[k].name));
    picture.unit = balance ? balance->unit : info.signals[k].unit + "/s";
    picture.variable = names[best];
    picture.variable_unit = units[best];
    OrderedRate(samples.rate, samples.variables[best], own_plant_thresholds.bins).draw(picture);
    Location location;
    location.signal = picture.signal;
    location.submodel = plant::SubmodelName(info.signals[k].submodel);
    location.share = std::clamp(1.0 - expected * expected / (seen * seen), 0.0, 1.0);
    char text[400];
    std::snprintf(
        text, sizeof text,
        "From each measured state on, %s misses %.3g %s (root mean square), where noise explains %.3g;",
        plant::the_variable(info.signals[k].name).c_str(), seen, picture.unit.c_str(), expected);
    location.evidence = text;
    if (order > own_plant_thresholds.least_order) {
      std::snprintf(text, sizeof text, " it follows %s most (correlation ratio %.2f).",
                    plant::the_variable(names[best]).c_str(), order);
      location.regime = Regime{names[best], picture.x[0], picture.x[picture.x.size() - 1]};
    } else {
      std::snprintf(text, sizeof text, " nothing recorded orders it.");
    }
    location.evidence += text;
    if (!info.signals[k].note.empty()) location.evidence += " It is " + info.signals[k].note + ".";
    found.where.push_back(std::move(location));
    found.quantities.push_back(std::move(picture));
  }
  sort_by(found.where, [](const Location& one) { return -one.share; });
}

/// Draws what the causes of an augmented model supply into pictures of missing rates.
/// @param simulated   the recordings, their signals replaced by the augmented model's
/// @param quantities  their `effect` is written
inline void draw_own_effect(const Model& baseline, const Catalogue& catalogue,
                            const std::vector<Inputs>& simulated, std::vector<MissingQuantity>& quantities) {
  const PlantInfo& info = *plant_of(baseline).info();
  const MissingRates rates = missing_rates(baseline, catalogue, simulated);
  for (MissingQuantity& picture : quantities) {
    const auto variable = std::find(rates.names.begin(), rates.names.end(), picture.variable);
    for (std::size_t k = 0; k < info.signals.size() && variable != rates.names.end(); ++k) {
      if (to_string(picture.signal) != info.signals[k].name) continue;
      const auto& values = rates.of[k].variables[static_cast<std::size_t>(variable - rates.names.begin())];
      const auto vector = [](const std::vector<double>& list) {
        return Eigen::VectorXd(
            Eigen::Map<const Eigen::VectorXd>(list.data(), static_cast<Eigen::Index>(list.size())));
      };
      set_effect(picture, vector(values), vector(rates.of[k].rate));
    }
  }
}

}  // namespace thermopower::gap::engine
