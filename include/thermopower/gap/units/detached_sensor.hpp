// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/finding_list.hpp>
#include <thermopower/gap/data/prepared_recording.hpp>
#include <thermopower/plant/bench_at_rows.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <variant>
#include <vector>

/// @file detached_sensor.hpp
/// Thermometers that do not follow the power: one that nobody reads, and one that measures the air.

namespace thermopower::gap::engine {

/// Thresholds of a thermometer that does not follow the power.
/// Held by tests/gap/units/unit_posterior_test.cpp.
struct DetachedSensorThresholds {
  double least_K = 10.0;  ///< that the model's motor warms by: thermometers come in steps of a degree or two
  double share =
      0.05;  ///< of that by which the thermometer may differ from the air: constants are off by less
  double accuracy_K = 2.0;  ///< of two thermometers in one air
  double typical = 0.95;    ///< share of the samples that are compared
  double follows = 0.25;    ///< share of the variance that a warming motor explains: it is attached
  double least_gain =
      0.1;  ///< kelvin for each of the model's that a warming motor shows: constants are off by less
  double slowest = 10.0;        ///< times that the motor's time constant may be off, either way
  std::size_t least_rows = 20;  ///< samples
};

/// Rise that heat causes in one body, row by row, every run from the air on.
inline Eigen::VectorXd heated_rise(const Inputs& inputs, const Eigen::VectorXd& heat_W,
                                   double capacity_J_per_K, double conductance_W_per_K) {
  Eigen::VectorXd rise = Eigen::VectorXd::Zero(heat_W.size());
  for (const RunSpan& run : inputs.runs)
    for (Eigen::Index i = run.begin + 1; i < run.end; ++i) {
      const double step_s = inputs.t_s[i] - inputs.t_s[i - 1];
      const double stays = std::exp(-step_s * conductance_W_per_K / capacity_J_per_K);
      const double heat = std::isfinite(heat_W[i - 1]) ? heat_W[i - 1] : 0.0;
      rise[i] = stays * rise[i - 1] + (1.0 - stays) * heat / conductance_W_per_K;
    }
  return rise;
}

/// Adds a finding where motor_C does not follow the power: it never changes, or it only follows the air.
inline void check_thermometer(const Model& model, const PreparedRecording& prepared,
                              const Catalogue& catalogue, FindingList& list) {
  constexpr DetachedSensorThresholds limit;
  const Inputs& inputs = prepared.inputs();
  const auto* const body = std::get_if<LumpedThermalModel>(&model.thermal);
  if (body == nullptr || !inputs.judged(Signal::motor_C)) return;
  const Eigen::VectorXd& motor = inputs.of(Signal::motor_C);
  std::vector<double> samples = finite_samples(motor);
  if (samples.size() < limit.least_rows) return;
  const Eigen::VectorXd heat_W =
      plant::BenchAtRows(model, catalogue, inputs, {}).evaluate(plant::heat_told(inputs)).heat_W;
  const double capacity = body->heat_capacity_J_per_K, conductance = body->conductance_W_per_K;
  const double warms_K = heated_rise(inputs, heat_W, capacity, conductance).maxCoeff();
  if (!(warms_K > limit.least_K)) return;
  if (quantile_of(samples, 0.0) == quantile_of(samples, 1.0)) {
    list.add(FindingKind::frozen_samples, Severity::error, "motor_C",
             "never changes, where the model's goes through " + short_number(warms_K) +
                 " degC: a thermometer that stands still",
             "look at what reads the sensor, or leave the column out");
    return;
  }
  const Eigen::VectorXd above = motor - inputs.ambient_C;
  std::vector<double> differences = finite_samples(above);
  if (differences.size() < limit.least_rows) return;
  const double offset_K = median_of(differences);
  for (double& one : differences) one = std::abs(one - offset_K);
  const double most_K = limit.share * warms_K;
  if (std::abs(offset_K) > std::max(limit.accuracy_K, most_K) ||
      quantile_of(differences, limit.typical) > most_K)
    return;
  for (const double slower : {1.0 / limit.slowest, 1.0, limit.slowest}) {
    const Eigen::VectorXd rise = heated_rise(inputs, heat_W, slower * capacity, conductance);
    double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
    for (Eigen::Index i = 0; i < rise.size(); ++i) {
      if (!std::isfinite(above[i])) continue;
      n += 1.0, x += rise[i], y += above[i];
      xx += rise[i] * rise[i], xy += rise[i] * above[i], yy += above[i] * above[i];
    }
    xx -= x * x / n, xy -= x * y / n, yy -= y * y / n;
    if (xy > limit.least_gain * xx && xy * xy > limit.follows * xx * yy) return;
  }
  list.add(FindingKind::detached_sensor, Severity::error, "motor_C",
           "does not follow the power: it stays at the air's temperature, where the model's motor warms by " +
               short_number(warms_K) + " K; is the sensor attached?",
           "attach the sensor to the motor, or leave the column out");
}

}  // namespace thermopower::gap::engine
