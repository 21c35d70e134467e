// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/bell_regression.hpp>
#include <thermopower/gap/data/robust.hpp>
#include <thermopower/gap/model.hpp>
#include <thermopower/gap/units/evidence.hpp>
#include <thermopower/gap/units/scales.hpp>
#include <thermopower/plant/bench_at_rows.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <variant>
#include <vector>

/// @file heat_evidence.hpp
/// What the columns of a bench say of their units: the current against the circuit's, and the rate of warming against what heat
/// and loss make it.

namespace thermopower::gap::engine {

/// Thresholds of what counts as told about the size of a bench's columns.
/// Held by tests/gap/data/scale_test.cpp.
struct HeatEvidenceThresholds {
  std::size_t shortest = 2;         ///< intervals of the shortest bell
  std::size_t longest = 2048;       ///< of the longest
  std::size_t least_windows = 24;   ///< of a regression
  double heating = 0.6;             ///< correlation of heat and rate of warming beside the loss
  double losing = 0.35;             ///< the same of the loss beside the heat
  double significance = 3.0;        ///< standard errors that each is from 0
  double of_largest = 0.1;          ///< of the largest expected current: smaller ones are not compared
  std::size_t least_currents = 20;  ///< that are compared
  double exchanged = 1.4;           ///< times that a current may be off with two columns exchanged back
  double sound = 2.0;               ///< factor by which a current may be off as recorded
  double offset_partial = 0.6;      ///< correlation of loss and warming that tells the air's temperature
  double spread = 2.0;  ///< of the 90th by the 10th percentile: one factor fits all that differ by no more
};

/// By how much the warming follows heat and loss: 1 each where capacity and loss are the model's.
struct WarmingTold {
  ToldCoefficient heat;  ///< of what the heat warms the body by
  ToldCoefficient loss;  ///< of what the loss cools it by
  double offset_K =
      0.0;  ///< by how much warmer than the recorded one the air is to which the body cools down

  /// Whether both are told.
  bool is_told() const {
    constexpr HeatEvidenceThresholds limit;
    return heat.partial > limit.heating && loss.partial > limit.losing && heat.value > 0.0 &&
           loss.value > 0.0 && heat.significance() > limit.significance &&
           loss.significance() > limit.significance;
  }
};

/// A body's heat balance at the rows of a recording.
struct WarmingRows {
  const Eigen::VectorXd& t_s;        ///< stamps
  const std::vector<RunSpan>& runs;  ///< rows between which time passes
  const Eigen::VectorXd& body_C;     ///< measured
  Eigen::VectorXd heating_K_per_s;   ///< heat by capacity
  Eigen::VectorXd cooling_K_per_s;   ///< loss by capacity
  double relaxation_per_s = 0.0;     ///< conductance by capacity
};

/// The rate of warming regressed on what heat and loss should make it, by the bells that tell both best.
inline WarmingTold regress_warming(const WarmingRows& rows) {
  constexpr HeatEvidenceThresholds limit;
  WarmingTold best;
  assert(rows.heating_K_per_s.size() == rows.t_s.size() && rows.cooling_K_per_s.size() == rows.t_s.size());
  const ReadRows read(rows.t_s, rows.runs, rows.body_C);
  for (std::size_t length = limit.shortest; length <= limit.longest; length *= 2) {
    KeptRegression regression;
    read.for_each_bell(length, [&](const std::vector<ReadRows::Part>& parts) {
      Eigen::VectorXd terms = Eigen::VectorXd::Zero(3);
      double response = 0.0;
      for (const ReadRows::Part& one : parts) {
        response += one.weight * (rows.body_C[one.next] - rows.body_C[one.row]);
        for (Eigen::Index row = one.row; row < one.next; ++row) {
          const double step_s = rows.t_s[row + 1] - rows.t_s[row];
          terms[0] += one.weight * step_s * rows.heating_K_per_s[row];
          terms[1] -= one.weight * step_s * rows.cooling_K_per_s[row];
        }
        terms[2] += one.weight * one.step_s;
      }
      regression.add(terms, response);
    });
    if (regression.rows() < limit.least_windows) continue;
    const std::vector<ToldCoefficient> told = regression.solve();
    if (told.empty()) continue;
    if (std::min(told[0].partial, told[1].partial) <= std::min(best.heat.partial, best.loss.partial))
      continue;
    best = {told[0], told[1], 0.0};
    const double by_air_per_s = told[1].value * rows.relaxation_per_s;
    best.offset_K = by_air_per_s != 0.0 ? told[2].value / by_air_per_s : 0.0;
  }
  return best;
}

/// Measured by expected: its median over the rows where something is expected, and how far single rows are from it.
struct FactorTold {
  double value = missing;  ///< NaN: too few rows
  double low = missing;    ///< 10th percentile
  double high = missing;   ///< 90th percentile

  /// Whether one factor fits all rows.
  bool is_one() const {
    const double least = std::min(std::abs(low), std::abs(high)),
                 most = std::max(std::abs(low), std::abs(high));
    return low * high > 0.0 && most < HeatEvidenceThresholds().spread * least;
  }
};

/// The factor between two columns of as many rows.
inline FactorTold factor_of(const Eigen::VectorXd& measured, const Eigen::VectorXd& expected) {
  constexpr HeatEvidenceThresholds limit;
  constexpr double low = 0.1, high = 0.9;
  assert(measured.size() >= expected.size());
  double most = 0.0;
  for (const double value : expected)
    if (std::isfinite(value)) most = std::max(most, std::abs(value));
  std::vector<double> factors;
  for (Eigen::Index i = 0; i < expected.size(); ++i)
    if (std::isfinite(measured[i]) && std::abs(expected[i]) > limit.of_largest * most)
      factors.push_back(measured[i] / expected[i]);
  if (factors.size() < limit.least_currents) return {};
  FactorTold told;
  told.value = median_of(factors);
  told.low = quantile_of(factors, low);
  told.high = quantile_of(factors, high);
  return told;
}

/// What a bench says of units.
class HeatEvidence {
public:
  /// All must outlive this object.
  HeatEvidence(const Model& model, const Inputs& inputs, const Recording& recording,
               const Catalogue& catalogue)
      : model_(model),
        inputs_(inputs),
        recording_(recording),
        lumped_(std::get_if<LumpedThermalModel>(&model.thermal)) {
    law_ = plant::BenchAtRows(model, catalogue, inputs, {}).evaluate(plant::heat_told(inputs));
    if (model.has_current() && recording.has("power_param") && recording.has("current_A"))
      current_ = factor_of(recording.column("current_A"), law_.law_A);
    if (inputs.judged(Signal::motor_C)) warming_ = warming(inputs.of(Signal::motor_C), nullptr);
  }

  /// Writes what is told.
  void tell(UnitEvidence& to) const {
    constexpr HeatEvidenceThresholds limit;
    if (current_.low * current_.high > 0.0) {
      Measured& current = to[UnitMeasure::current];
      current.value = std::abs(current_.value);
      current.sd = 0.5 * std::max(0.2, std::abs(std::log(current_.high / current_.low)));
      current.forwards_nats = std::copysign(sure_nats, current_.value);
    }
    const Inputs& inputs = inputs_;
    to.heated_by = inputs.heat_W.size() > 0              ? "heat_W"
                   : inputs.heat == HeatSource::law      ? "power_param"
                   : inputs.heat == HeatSource::drive    ? "drive_A"
                   : inputs.heat == HeatSource::measured ? "current_A"
                                                         : "";
    tell_coefficient(warming_.heat, to[UnitMeasure::heating], limit.heating);
    tell_coefficient(warming_.loss, to[UnitMeasure::cooling], limit.losing);
    if (warming_.is_told() && warming_.loss.partial > limit.offset_partial)
      to.air_offset_K = warming_.offset_K;
    for (const ColumnPair& pair : exchangeable_columns)
      if (fits_exchanged(pair)) to.exchanged.push_back({pair.first, pair.second});
  }

  /// How the motor warms by heat and loss.
  const WarmingTold& warming() const { return warming_; }
  /// What the laws say at each row.
  const plant::BenchAtRows::Values& law() const { return law_; }

private:
  static constexpr double sure_nats = 12.0;

  static void tell_coefficient(const ToldCoefficient& told, Measured& to, double partial) {
    if (!(told.partial > partial) || !(told.significance() > HeatEvidenceThresholds().significance)) return;
    to.value = std::abs(told.value);
    to.sd = std::max(0.12, 1.0 / told.significance());
    to.forwards_nats = told.value > 0.0 ? sure_nats : -sure_nats;
  }

  /// The warming of a body. @param air  NaN-free; null: as recorded
  WarmingTold warming(const Eigen::VectorXd& body_C, const Eigen::VectorXd* air_C) const {
    if (lumped_ == nullptr) return {};
    const double per_s = lumped_->conductance_W_per_K / lumped_->heat_capacity_J_per_K;
    const Eigen::VectorXd cooling = air_C != nullptr
                                        ? Eigen::VectorXd(per_s * (body_C - *air_C))
                                        : Eigen::VectorXd(law_.loss_W.cwiseQuotient(law_.capacity));
    return regress_warming(
        {inputs_.t_s, inputs_.runs, body_C, law_.heat_W.cwiseQuotient(law_.capacity), cooling, per_s});
  }

  bool fits_exchanged(const ColumnPair& pair) const {
    constexpr HeatEvidenceThresholds limit;
    const std::string a = pair.first, b = pair.second;
    if (!recording_.has(a) || !recording_.has(b)) return false;
    if (b == "ambient_C") {
      if (warming_.is_told() || lumped_ == nullptr || !inputs_.judged(Signal::motor_C)) return false;
      const WarmingTold then = warming(recording_.column(b), &recording_.column(a));
      return then.is_told();
    }
    // What warms with the heat is no supply.
    if (a == "motor_C" && warming_.heat.partial > limit.heating) return false;
    if (!std::holds_alternative<OhmicCurrentModel>(model_.current) || !recording_.has("power_param") ||
        !recording_.has("current_A") ||
        (current_.is_one() && std::abs(std::log(std::abs(current_.value))) < std::log(limit.sound)))
      return false;
    const FactorTold then = ohmic_current(a, b);
    return then.is_one() && then.value > 0.0 && std::abs(std::log(then.value)) < std::log(limit.exchanged);
  }

  /// The measured current by that of the circuit, with two columns exchanged.
  FactorTold ohmic_current(const std::string& a, const std::string& b) const {
    const auto& winding = std::get<OhmicCurrentModel>(model_.current);
    const auto column = [&](const std::string& name) -> const Eigen::VectorXd* {
      return recording_.find(name == a ? b : name == b ? a : name);
    };
    constexpr double full_power = 255.0;
    const Eigen::VectorXd &power = *column("power_param"), &amperes = *column("current_A");
    const Eigen::VectorXd *supply = column("supply_V"), *motor = column("motor_C");
    Eigen::VectorXd expected(power.size());
    for (Eigen::Index i = 0; i < power.size(); ++i) {
      const double volts = supply != nullptr ? (*supply)[i] : inputs_.nominal_V;
      const double above_K = motor != nullptr ? (*motor)[i] - winding.reference_C : 0.0;
      const bool is_power = power[i] >= 0.0 && power[i] <= full_power;
      expected[i] = is_power ? volts * std::sqrt(power[i] / full_power) /
                                   (winding.resistance_ohm * (1.0 + winding.tempco_per_K * above_K))
                             : missing;
    }
    return factor_of(amperes, expected);
  }

  const Model& model_;
  const Inputs& inputs_;
  const Recording& recording_;
  const LumpedThermalModel* lumped_;
  plant::BenchAtRows::Values law_;
  FactorTold current_;
  WarmingTold warming_;
};

}  // namespace thermopower::gap::engine
