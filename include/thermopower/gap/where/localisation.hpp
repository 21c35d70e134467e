// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/inputs.hpp>
#include <thermopower/gap/where/localise_balances.hpp>
#include <thermopower/gap/where/own_balances.hpp>
#include <thermopower/plant/axis_balances.hpp>
#include <thermopower/plant/bench_balances.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

/// @file
/// Where a model of our own plants and its recordings part.

namespace thermopower::gap::engine {

/// Recordings one after another, as far as they have the same input columns as the longest.
inline Recording joined(const std::vector<Recording>& recordings) {
  if (recordings.empty()) return {};
  const Recording& longest =
      *std::max_element(recordings.begin(), recordings.end(),
                        [](const Recording& a, const Recording& b) { return a.rows() < b.rows(); });
  std::vector<const Recording*> parts;
  Eigen::Index rows = 0, at = 0;
  for (const Recording& one : recordings)
    if (std::all_of(longest.columns.begin(), longest.columns.end(),
                    [&](const Column& column) { return one.has(column.name) || !longest.has(column.name); }))
      parts.push_back(&one), rows += one.rows();
  if (parts.size() == 1) return *parts.front();
  Recording out;
  out.name = longest.name;
  out.t_s.resize(rows);
  for (const Column& column : longest.columns)
    out.columns.push_back({column.name, Eigen::VectorXd::Constant(rows, missing)});
  for (const Recording* part : parts) {
    out.t_s.segment(at, part->rows()) = part->t_s;
    for (Column& column : out.columns)
      if (const Eigen::VectorXd* values = part->find(column.name))
        column.values.segment(at, part->rows()) = *values;
    for (RunSpan run : part->spans()) {
      run.begin += at;
      run.end += at;
      out.runs.push_back(std::move(run));
    }
    at += part->rows();
  }
  return out;
}

/// At most `most` rows: evenly spread stretches of consecutive ones, each a run of its own.
inline Recording stretches(const Recording& recording, Eigen::Index most) {
  if (recording.rows() <= most) return recording;
  constexpr Eigen::Index parts = 40;
  const Eigen::Index length = most / parts;
  std::vector<Recording> list;
  for (Eigen::Index p = 0; p < parts; ++p) {
    const Eigen::Index begin = p * (recording.rows() - length) / (parts - 1);
    list.push_back(recording.slice(begin, begin + length));
  }
  return joined(list);
}

/// The balances of a model at the rows of recordings one after another. Recordings that lack input columns of the
/// longest one are left out; signals that are not judged have no balance.
class RecordedBalances {
public:
  /// Keeps references to model and catalogue: they must outlive this object.
  /// @throws InvalidInput where a recording is invalid
  RecordedBalances(const Model& model, const std::vector<Recording>& recordings, const Catalogue& catalogue) {
    constexpr Eigen::Index axis_rows = 60000;  // at 1 kHz a minute: more says no more about where
    for (const Recording& one : recordings)
      if (const auto problem = one.validate())
        throw InvalidInput("recording '" + one.name + "': " + *problem);
    if (model.own) {
      for (const Recording& one : recordings) own_.push_back(prepare(model, one));
      sources_ = own_balances(model, catalogue, own_);
      return;
    }
    const Recording all = joined(recordings);
    if (all.rows() < where_limits.least_rows) return;
    if (model.has_axis()) {
      const Recording part = stretches(all, axis_rows);
      axis_ = prepare(model, part);
      std::vector<std::string> known{"drive_A",   "rate_dps",  "angle_deg", "motor_C",
                                     "voltage_V", "torque_Nm", "heat_W"};
      if (axis_.closed_loop) known.insert(known.end(), {"target_deg", "target_dps"});
      if (axis_.effort_is_output) known.emplace_back("current_A");
      append(plant::axis_balances(model, catalogue, axis_, covariates(part, known)));
    }
    if (!model.has_current() && !model.has_thermal()) return;
    bench_ = prepare(model, all);
    std::vector<std::string> known{"power_param", "drive_A", "supply_V",  "ambient_C",
                                   "current_A",   "motor_C", "angle_deg", "heat_W"};
    if (model.has_heater()) known.insert(known.end(), {"target_C", heater_power_column});
    append(plant::bench_balances(model, catalogue, bench_, covariates(all, known)));
  }
  RecordedBalances(const RecordedBalances&) = delete;  // the balances refer to its rows
  RecordedBalances& operator=(const RecordedBalances&) = delete;

  /// The balances; they must not outlive this object.
  const std::vector<plant::BalanceSource>& sources() const { return sources_; }

private:
  void append(std::vector<plant::BalanceSource> more) {
    for (plant::BalanceSource& one : more) sources_.push_back(std::move(one));
  }

  /// Numeric columns that are none of the `known` ones, and change.
  static std::vector<plant::Covariate> covariates(const Recording& recording,
                                                  const std::vector<std::string>& known) {
    std::vector<plant::Covariate> list;
    for (const Column& column : recording.columns) {
      if (std::find(known.begin(), known.end(), column.name) != known.end() || !recording.has(column.name))
        continue;
      plant::Covariate one{column.name, plant::without_holes(column.values, recording.spans(), 0.0)};
      if (one.values.maxCoeff() > one.values.minCoeff()) list.push_back(std::move(one));
    }
    return list;
  }

  Inputs axis_, bench_;
  std::vector<Inputs> own_;
  std::vector<plant::BalanceSource> sources_;
};

/// Where a model and recordings part (localise_balances()), by the balances of the model's plant with the effects
/// that the model already has. A fault in a signal that is not judged cannot be seen.
/// @throws InvalidInput where a recording is invalid, or the catalogue does not know an effect of the model
inline Localisation localise(const Model& model, const std::vector<Recording>& recordings,
                             const Catalogue& catalogue) {
  return localise_balances(RecordedBalances(model, recordings, catalogue).sources());
}

/// Fills MissingQuantity::effect: the missing quantity that the baseline would show if the augmented
/// simulation were the truth.
/// @param simulated the recordings with their outputs replaced by the augmented model's simulation, in the same order;
/// released early, as they may be long
inline void draw_effect(const Model& baseline, std::vector<Recording> simulated, const Catalogue& catalogue,
                        std::vector<MissingQuantity>& quantities) {
  const RecordedBalances balances(baseline, simulated, catalogue);
  simulated.clear();
  draw_supplied(balances.sources(), quantities);
}

}  // namespace thermopower::gap::engine
