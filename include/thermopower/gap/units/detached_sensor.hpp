// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/finding_list.hpp>
#include <thermopower/gap/observe/prepared_recording.hpp>
#include <thermopower/plant/axis_rollout.hpp>
#include <thermopower/plant/bench_at_rows.hpp>
#include <thermopower/plant/samples.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <variant>
#include <utility>
#include <vector>

/// @file detached_sensor.hpp
/// Sensors that are not attached: thermometers that do not follow the power, and an axis whose sensors show no motion at all.

namespace thermopower::gap::engine {

/// Thresholds of a thermometer that does not follow the power.
/// Held by tests/gap/units/unit_posterior_test.cpp.
struct DetachedSensorThresholds {
  double least_K = 10.0;  ///< that the model's motor warms by: thermometers come in steps of a degree or two
  double share =
      0.05;  ///< of that by which the thermometer may differ from the air: constants are off by less
  double level =
      0.25;  ///< of that by which it may lie beside the air, wherever it lies: a warm motor lies higher
  double typical = 0.95;  ///< share of the samples that are compared
  double follows = 0.25;  ///< share of the variance that a warming motor explains: it is attached
  double least_gain =
      0.1;  ///< kelvin for each of the model's that a warming motor shows: constants are off by less
  double slowest = 10.0;        ///< times that the motor's time constant may be off, either way
  std::size_t least_rows = 20;  ///< samples
};

/// The widest the readings of a sensor lie apart; 0 without any.
inline double range_of(const Eigen::VectorXd& values) {
  const std::vector<double> read = finite_samples(values);
  if (read.empty()) return 0.0;
  const auto [low, high] = std::minmax_element(read.begin(), read.end());
  return *high - *low;
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
  const double time_constant_s = body->heat_capacity_J_per_K / body->conductance_W_per_K;
  const Eigen::VectorXd rise_K =
      heat_W.array().isFinite().select(heat_W.array(), 0.0) / body->conductance_W_per_K;
  const auto risen_K = [&](double slower) {  // of one body, every run from the air on
    return plant::lagged(rise_K, slower * time_constant_s, true, inputs.t_s, inputs.runs);
  };
  const double warms_K = risen_K(1.0).maxCoeff();
  if (!(warms_K > limit.least_K)) return;
  if (range_of(motor) == 0.0) {
    list.add(FindingKind::frozen_samples, Severity::error, "motor_C",
             "never changes, where the model's goes through " + short_number(warms_K) +
                 " degC: a thermometer that stands still",
             "look at what reads the sensor, or leave the column out");
    return;
  }
  const Eigen::VectorXd above = motor - inputs.ambient_C;
  std::vector<double> differences = finite_samples(above);
  if (differences.size() < limit.least_rows) return;
  // It follows the air, or lies somewhere and follows nothing.
  const auto spread_K = [&](std::vector<double> values) {
    const double middle = median_of(values);
    for (double& one : values) one = std::abs(one - middle);
    return quantile_of(values, limit.typical);
  };
  if (std::abs(median_of(differences)) > limit.level * warms_K ||
      std::min(spread_K(differences), spread_K(samples)) > limit.share * warms_K)
    return;
  for (const double slower : {1.0 / limit.slowest, 1.0, limit.slowest}) {
    const Eigen::VectorXd rise = risen_K(slower);
    double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
    for (Eigen::Index i = 0; i < rise.size(); ++i) {
      if (!std::isfinite(above[i])) continue;
      n += 1.0, x += rise[i], y += above[i];
      xx += rise[i] * rise[i], xy += rise[i] * above[i], yy += above[i] * above[i];
    }
    xx -= x * x / n, xy -= x * y / n, yy -= y * y / n;
    if (xy > limit.least_gain * xx && xy * xy > limit.follows * xx * yy) return;
  }
  list.add(
      FindingKind::detached_sensor, Severity::error, "motor_C",
      "does not follow the power: it stays near the air's temperature, where the model's motor warms by " +
          short_number(warms_K) + " K; is the sensor attached?",
      "attach the sensor to the motor, or leave the column out");
}

/// Thresholds of an axis that never moves. Held by tests/gap/units/unit_posterior_test.cpp.
struct StillAxisThresholds {
  double noise = 12.0;  ///< times the noise between rows within which all readings lie: it never moved
  double moves = 20.0;  ///< times that range that the model's axis moves by, and at least a degree
  Eigen::Index least_rows = 50;  ///< of a recording: fewer say nothing
};

/// How far a rigid axis would turn by a recorded drive, deg: what the model says, with its own friction and nothing else.
inline double travel_deg(const Model& model, const Inputs& inputs) {
  const RigidAxisModel& axis = *model.axis;
  const Eigen::VectorXd& drive = plant::command(inputs, axis.voltage_driven());
  const double torque = axis.torque_constant_Nm_per_A;
  const double per_drive = axis.voltage_driven() ? torque / axis.resistance_ohm : torque;
  const double damping = axis.drag_Nms_per_rad();
  double widest = 0.0;
  for (const RunSpan& run : inputs.runs) {
    double angle = 0.0, rate = 0.0, low = 0.0, high = 0.0;
    for (Eigen::Index i = run.begin + 1; i < run.end; ++i) {
      const double step_s = inputs.t_s[i] - inputs.t_s[i - 1];
      const double push = std::isfinite(drive[i - 1]) ? per_drive * drive[i - 1] : 0.0;
      const double stays = std::exp(-step_s * damping / axis.inertia_kgm2);
      const double end = damping > 0.0 ? push / damping : rate + push * step_s / axis.inertia_kgm2;
      rate = damping > 0.0 ? stays * rate + (1.0 - stays) * end : end;
      angle += rate * step_s * plant::deg_per_rad;
      low = std::min(low, angle), high = std::max(high, angle);
    }
    widest = std::max(widest, high - low);
  }
  return widest;
}

/// Whether angle and rate show no motion in a whole recording whose drive would turn the model's axis far.
inline bool shows_no_motion(const Model& model, const Inputs& inputs) {
  constexpr StillAxisThresholds limit;
  if (!model.axis || model.own || inputs.closed_loop || inputs.rows() < limit.least_rows ||
      plant::command(inputs, model.axis->voltage_driven()).size() == 0)
    return false;
  const bool angle = inputs.judged(Signal::angle_deg), rate = inputs.judged(Signal::rate_dps);
  if (!angle && !rate) return false;
  const auto noise = [&](Signal of) { return plant::sample_noise(inputs.of(of), inputs.runs); };
  const double turned_deg = angle ? range_of(inputs.of(Signal::angle_deg)) : 0.0;
  if (angle && turned_deg > limit.noise * noise(Signal::angle_deg)) return false;
  if (rate) {  // an axis that turns at one rate moves
    const double moves_dps = limit.noise * noise(Signal::rate_dps);
    for (const double one : inputs.of(Signal::rate_dps))
      if (std::abs(one) > moves_dps) return false;
  }
  return travel_deg(model, inputs) > std::max(1.0, limit.moves * turned_deg);
}

/// Adds a finding to every recording in which an axis never moved: nothing can be learned from it, whether a sensor is loose or the
/// axis is held. Where others show a motion, it stops nothing.
/// @param train  what a model is fitted to
/// @param add    takes a recording and its severity
template <class Add>
void check_motion_sensors(const Model& model, const std::vector<PreparedRecording>& train, Add&& add) {
  std::vector<const PreparedRecording*> still;
  for (const PreparedRecording& one : train)
    if (shows_no_motion(model, one.inputs())) still.push_back(&one);
  const Severity severity = still.size() == train.size() ? Severity::error : Severity::warning;
  for (const PreparedRecording* one : still) {
    FindingList list(one->recording());
    const bool angle = one->inputs().judged(Signal::angle_deg);
    list.add(FindingKind::detached_sensor, severity, angle ? "angle_deg" : "rate_dps",
             "shows no motion, where the model's axis turns by " +
                 short_number(travel_deg(model, one->inputs())) +
                 " deg; is the sensor attached, and the axis free?",
             "attach the sensor to the axis and free it, or leave the recording out");
    add(list.take());
  }
}

}  // namespace thermopower::gap::engine
