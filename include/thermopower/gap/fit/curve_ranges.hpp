// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/inputs.hpp>
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

/// The ranges of the variables of curves in recordings, and how large the values of the curves may be.
class CurveRanges {
public:
  /// Keeps references to both.
  CurveRanges(const Model& model, const std::vector<Inputs>& recordings)
      : model_(model), recordings_(recordings) {}

  /// Smallest and largest value of a variable, without values that stray by more than a tenth of the range of the others.
  /// Equal if it is not recorded or does not change.
  std::pair<double, double> range(plant::CurveVariable variable) const {
    std::vector<double> values;
    for (const Inputs& inputs : recordings_) collect(variable, inputs, values);
    constexpr double outermost = 1e-3, strays = 0.1;
    if (values.empty()) return {0.0, 0.0};
    std::sort(values.begin(), values.end());
    assert(values.front() <= values.back());
    const auto at = [&](double share) {
      return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
    };
    const double low = at(outermost), high = at(1.0 - outermost), beyond = strays * (high - low);
    return {std::max(values.front(), low - beyond), std::min(values.back(), high + beyond)};
  }

  /// Size of what a curve's values are relative to, in their unit; 0 where nothing tells it.
  double size(plant::CurveScale scale) const {
    double largest = 0.0;
    for (const Inputs& inputs : recordings_) largest = std::max(largest, size(scale, inputs));
    return largest;
  }

private:
  static double largest(const Eigen::VectorXd& values) {
    double most = 0.0;
    for (Eigen::Index i = 0; i < values.size(); ++i)
      if (std::isfinite(values[i])) most = std::max(most, std::abs(values[i]));
    return most;
  }

  /// The command of an axis, as a current; empty without one.
  Eigen::VectorXd drive_A(const Inputs& inputs) const {
    if (!inputs.axis() || !model_.axis) return {};
    if (inputs.closed_loop) return inputs.servo_A;
    if (!model_.axis->voltage_driven()) return inputs.drive_A;
    return inputs.voltage_V / model_.axis->resistance_ohm;
  }

  static Eigen::VectorXd current_A(const Inputs& inputs) {
    if (inputs.judged(Signal::current_A)) return inputs.of(Signal::current_A);
    return inputs.heat == plant::HeatSource::drive ? inputs.drive_A : inputs.held_current_A;
  }

  static Eigen::VectorXd motor_C(const Inputs& inputs) {
    return inputs.judged(Signal::motor_C) ? inputs.of(Signal::motor_C) : inputs.held_motor_C;
  }

  static Eigen::VectorXd rise_K(const Inputs& inputs) {
    if (!inputs.judged(Signal::motor_C) || inputs.ambient_C.size() == 0) return {};
    return inputs.of(Signal::motor_C) - inputs.ambient_C;
  }

  /// Measured rate; of an angle alone its slopes over four intervals.
  static Eigen::VectorXd rate_dps(const Inputs& inputs) {
    if (!inputs.axis()) return {};
    if (inputs.judged(Signal::rate_dps)) return inputs.of(Signal::rate_dps);
    if (!inputs.judged(Signal::angle_deg)) return {};
    constexpr Eigen::Index around = 2;
    const Eigen::VectorXd& angle = inputs.of(Signal::angle_deg);
    Eigen::VectorXd rate = Eigen::VectorXd::Constant(angle.size(), plant::missing);
    for (const RunSpan& run : inputs.runs)
      for (Eigen::Index i = run.begin + around; i + around < run.end; ++i)
        rate[i] = (angle[i + around] - angle[i - around]) / (inputs.t_s[i + around] - inputs.t_s[i - around]);
    return rate;
  }

  void collect(plant::CurveVariable variable, const Inputs& inputs, std::vector<double>& values) const {
    Eigen::VectorXd found;
    switch (variable) {
      case plant::CurveVariable::angle_deg:
        if (inputs.axis() && inputs.judged(Signal::angle_deg)) found = inputs.of(Signal::angle_deg);
        break;
      case plant::CurveVariable::rate_dps:
        found = rate_dps(inputs);
        break;
      case plant::CurveVariable::drive_A:
        found = drive_A(inputs);
        break;
      case plant::CurveVariable::rise_K:
        if (inputs.bench()) found = rise_K(inputs);
        break;
      case plant::CurveVariable::current_A:
        if (inputs.bench()) found = current_A(inputs);
        break;
      case plant::CurveVariable::motor_C:
        if (inputs.bench()) found = motor_C(inputs);
        break;
    }
    for (Eigen::Index i = 0; i < found.size(); ++i)
      if (std::isfinite(found[i])) values.push_back(found[i]);
  }

  double size(plant::CurveScale scale, const Inputs& inputs) const {
    switch (scale) {
      case plant::CurveScale::drive_Nm:
        return model_.axis ? std::abs(model_.axis->torque_constant_Nm_per_A) * largest(drive_A(inputs)) : 0.0;
      case plant::CurveScale::drive_A:
        return largest(drive_A(inputs));
      case plant::CurveScale::heat_W:
        return inputs.bench() ? heat_W(inputs) : 0.0;
      case plant::CurveScale::supply_V:
        return inputs.bench() ? std::max(inputs.nominal_V, largest(inputs.supply_V)) : 0.0;
    }
    return 0.0;
  }

  /// Largest heat: as recorded, of the largest current, or what holds the largest rise.
  double heat_W(const Inputs& inputs) const {
    if (inputs.heat_W.size() > 0) return largest(inputs.heat_W);
    const double most_A = largest(current_A(inputs));
    const auto* ohmic = std::get_if<OhmicCurrentModel>(&model_.current);
    if (most_A > 0.0 && ohmic != nullptr) return ohmic->resistance_ohm * most_A * most_A;
    if (most_A > 0.0) return inputs.nominal_V * most_A;
    const auto* lumped = std::get_if<LumpedThermalModel>(&model_.thermal);
    return lumped != nullptr ? lumped->conductance_W_per_K * largest(rise_K(inputs)) : 0.0;
  }

  const Model& model_;
  const std::vector<Inputs>& recordings_;
};

/// Gives the curves of a catalogue their ranges in recordings; those whose variable they do not show can then not be judged.
inline void support_curves(Catalogue& catalogue, const Model& model, const std::vector<Inputs>& recordings) {
  const CurveRanges ranges(model, recordings);
  const std::vector<EffectInfo> infos = catalogue.list();
  for (const EffectInfo& info : infos) {
    if (!info.curve) continue;
    const auto [from, to] = ranges.range(info.curve->variable);
    if (from < to) catalogue.support(info.id, from, to, ranges.size(info.curve->scale));
  }
}

}  // namespace thermopower::gap::engine
