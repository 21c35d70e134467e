// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/inputs.hpp>
#include <thermopower/gap/data/robust.hpp>
#include <thermopower/gap/model.hpp>
#include <thermopower/plant/axis_rollout.hpp>
#include <thermopower/plant/catalogue.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace thermopower::gap::engine {

/// The command of an axis, as a current; empty without one.
inline Eigen::VectorXd drive_as_current(const Model& model, const Inputs& inputs) {
  if (!inputs.axis() || !model.axis) return {};
  if (inputs.closed_loop) return inputs.servo_A;
  if (!model.axis->voltage_driven()) return inputs.drive_A;
  return inputs.voltage_V / model.axis->resistance_ohm;
}

/// Measured rate; of an angle alone its slopes over four intervals.
inline Eigen::VectorXd rate_or_slopes(const Inputs& inputs) {
  if (!inputs.axis()) return {};
  if (inputs.judged(Signal::rate_dps)) return inputs.of(Signal::rate_dps);
  constexpr Eigen::Index around = 2;
  const Eigen::VectorXd& angle = inputs.of(Signal::angle_deg);
  Eigen::VectorXd rate = Eigen::VectorXd::Constant(angle.size(), plant::missing);
  for (const RunSpan& run : inputs.runs)
    for (Eigen::Index i = run.begin + around; i + around < run.end; ++i)
      rate[i] = (angle[i + around] - angle[i - around]) / (inputs.t_s[i + around] - inputs.t_s[i - around]);
  return rate;
}

/// The values of a curve's variable in a recording; empty where it is not recorded.
inline Eigen::VectorXd curve_values(plant::CurveVariable variable, const Model& model, const Inputs& inputs) {
  switch (variable) {
    case plant::CurveVariable::angle_deg:
      if (inputs.axis()) return inputs.of(Signal::angle_deg);
      break;
    case plant::CurveVariable::rate_dps:
      return rate_or_slopes(inputs);
    case plant::CurveVariable::drive_A:
      return drive_as_current(model, inputs);
    case plant::CurveVariable::rise_K:
      if (inputs.bench() && inputs.judged(Signal::motor_C) && inputs.ambient_C.size() > 0)
        return inputs.of(Signal::motor_C) - inputs.ambient_C;
      break;
    case plant::CurveVariable::current_A:
      if (!inputs.bench()) break;
      if (inputs.judged(Signal::current_A)) return inputs.of(Signal::current_A);
      return inputs.heat == plant::HeatSource::drive ? inputs.drive_A : inputs.held_current_A;
    case plant::CurveVariable::motor_C:
      if (!inputs.bench()) break;
      return inputs.judged(Signal::motor_C) ? inputs.of(Signal::motor_C) : inputs.held_motor_C;
  }
  return {};
}

/// Smallest and largest value of a curve's variable, without values that stray by more than a tenth of the range of the others.
/// Equal if it is not recorded or does not change.
inline std::pair<double, double> curve_range(plant::CurveVariable variable, const Model& model,
                                             const std::vector<Inputs>& recordings) {
  constexpr double outermost = 1e-3, strays = 0.1;
  std::vector<double> values;
  for (const Inputs& inputs : recordings)
    for (const double value : finite_samples(curve_values(variable, model, inputs))) values.push_back(value);
  if (values.empty()) return {0.0, 0.0};
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  };
  const double low = at(outermost), high = at(1.0 - outermost), beyond = strays * (high - low);
  return {std::max(values.front(), low - beyond), std::min(values.back(), high + beyond)};
}

/// Size in a recording of what a curve's values are relative to, in their unit; 0 where nothing tells it.
inline double curve_size(plant::CurveScale scale, const Model& model, const Inputs& inputs) {
  const auto largest = [](const Eigen::VectorXd& values) {
    double most = 0.0;
    for (const double value : finite_samples(values)) most = std::max(most, std::abs(value));
    return most;
  };
  const auto largest_of = [&](plant::CurveVariable variable) {
    return largest(curve_values(variable, model, inputs));
  };
  if (scale == plant::CurveScale::drive_A) return largest_of(plant::CurveVariable::drive_A);
  if (scale == plant::CurveScale::drive_Nm)
    return model.axis
               ? std::abs(model.axis->torque_constant_Nm_per_A) * largest_of(plant::CurveVariable::drive_A)
               : 0.0;
  if (!inputs.bench()) return 0.0;
  if (scale == plant::CurveScale::supply_V) return std::max(inputs.nominal_V, largest(inputs.supply_V));
  // Heat as recorded, of the largest current, or as holds the largest rise.
  if (inputs.heat_W.size() > 0) return largest(inputs.heat_W);
  const double most_A = largest_of(plant::CurveVariable::current_A);
  const auto* ohmic = std::get_if<OhmicCurrentModel>(&model.current);
  if (most_A > 0.0 && ohmic != nullptr) return ohmic->resistance_ohm * most_A * most_A;
  if (most_A > 0.0) return inputs.nominal_V * most_A;
  const auto* lumped = std::get_if<LumpedThermalModel>(&model.thermal);
  return lumped != nullptr ? lumped->conductance_W_per_K * largest_of(plant::CurveVariable::rise_K) : 0.0;
}

/// Gives the curves of a catalogue their ranges in recordings; those whose variable they do not show can then not be judged.
inline void support_curves(Catalogue& catalogue, const Model& model, const std::vector<Inputs>& recordings) {
  const std::vector<EffectInfo> infos = catalogue.list();  // support() changes them
  for (const EffectInfo& info : infos) {
    if (!info.curve) continue;
    const auto [from, to] = curve_range(info.curve->variable, model, recordings);
    double size = 0.0;
    for (const Inputs& inputs : recordings)
      size = std::max(size, curve_size(info.curve->scale, model, inputs));
    if (from < to) catalogue.support(info.id, from, to, size);
  }
}

}  // namespace thermopower::gap::engine
