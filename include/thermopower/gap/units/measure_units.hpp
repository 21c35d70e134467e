// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/prepared_recording.hpp>
#include <thermopower/gap/units/heat_evidence.hpp>
#include <thermopower/gap/units/motion_evidence.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>
#include <vector>

/// @file measure_units.hpp
/// From a prepared recording to the numbers that tell its units.

namespace thermopower::gap::engine {

/// The range of a temperature column.
inline TemperatureRange temperature_range(const Recording& recording, const std::string& column) {
  TemperatureRange range;
  const Eigen::VectorXd* samples = recording.find(column);
  if (samples == nullptr) return range;
  std::vector<double> values = finite_samples(*samples);
  if (values.empty()) return range;
  constexpr double low = 0.005, high = 0.95;
  range.whole_numbers = std::all_of(values.begin(), values.end(),
                                    [](double value) { return std::abs(value - std::round(value)) < 1e-6; });
  range.low = quantile_of(values, low);
  range.high = quantile_of(values, high);
  range.typical = median_of(values);
  assert(range.low <= range.typical && range.typical <= range.high);
  return range;
}

/// What an axis says of units.
inline void measure_axis(const Model& model, const PreparedRecording& prepared, UnitEvidence& to) {
  constexpr MotionEvidenceThresholds limit;
  const Inputs& inputs = prepared.inputs();
  assert(model.axis);
  const RigidAxisModel& axis = *model.axis;
  const bool voltage = axis.voltage_driven();
  const bool has_rate = inputs.judged(Signal::rate_dps), has_angle = inputs.judged(Signal::angle_deg);
  const MotionEvidence motion(inputs, voltage);
  const auto tell = [](const ColumnRatio& ratio, double sd, Measured& measured) {
    measured.value = std::abs(ratio.value);
    measured.sd = sd;
    measured.forwards_nats = std::copysign(MotionEvidenceThresholds().most_nats, ratio.value);
  };
  constexpr double slope_sd = 0.03, target_sd = 0.3, least_sd = 0.1;
  const ColumnRatio slope = motion.rate_by_slope_of_angle();
  if (slope.is_told()) tell(slope, slope_sd, to[UnitMeasure::slope]);
  if (inputs.closed_loop) {
    const bool of_angle = inputs.target_deg.size() > 0;
    const ColumnRatio target = of_angle ? motion.target_by(inputs.target_deg, inputs.of(Signal::angle_deg))
                                        : motion.target_by(inputs.target_dps, inputs.of(Signal::rate_dps));
    if (target.alike > limit.follows) tell(target, target_sd, to[UnitMeasure::target]);
  }
  // A command that drives a joint through two columns of the same motion: exchanged ones are each other's slopes.
  constexpr double same = 0.05;
  const auto is_slope = [&](const ColumnRatio& ratio) {
    return ratio.is_told() && std::abs(std::log(ratio.value)) < same;
  };
  if (has_rate && has_angle && !is_slope(slope)) {
    const char* const command = voltage ? "voltage_V" : "drive_A";
    if (is_slope(motion.angle_by_slope_of_rate())) to.exchanged.push_back({"angle_deg", "rate_dps"});
    else if (is_slope(motion.rate_by_slope_of_command())) to.exchanged.push_back({command, "angle_deg"});
    else if (is_slope(motion.command_by_slope_of_angle())) to.exchanged.push_back({command, "rate_dps"});
  }
  if (inputs.closed_loop && !prepared.recording().has(voltage ? "voltage_V" : "drive_A")) return;
  const double ohm = voltage ? axis.resistance_ohm : 1.0, gain = axis.torque_constant_Nm_per_A / ohm;
  const double inertia = axis.inertia_kgm2 / gain * rad_per_deg,
               drag = (axis.viscous_Nms_per_rad / gain + (voltage ? axis.torque_constant_Nm_per_A : 0.0)) *
                      rad_per_deg;
  // The rate tells the acceleration from one difference; what the angle tells best is used where it tells more.
  const EffortOnMotion by_rate = motion.effort(true), by_angle = motion.effort(false);
  const bool closer = has_rate && (by_rate.inertia.partial >= by_angle.inertia.partial || !slope.is_told());
  const EffortOnMotion& effort = closer ? by_rate : by_angle;
  // The effort's noise makes a factor too small, the motion's makes it too large: it lies between the two regressions.
  const double scale = !closer && has_rate ? slope.value : 1.0;  // of what the angle's unit is called
  if (EffortOnMotion::is_told(effort.inertia)) {
    Measured& drive = to[UnitMeasure::drive];
    drive.value = std::abs(scale * inertia / effort.inertia.value * effort.inertia.partial);
    drive.sd = std::max(least_sd, -std::log(effort.inertia.partial));
  }
  to[UnitMeasure::drive].forwards_nats =
      motion.sign_with_delays(closer, effort.forwards_nats) * (scale < 0.0 ? -1.0 : 1.0);
  if (EffortOnMotion::is_told(effort.drag) && drag > 0.0 && effort.drag.value > 0.0) {
    to[UnitMeasure::drag].value = std::abs(scale * drag / effort.drag.value * effort.drag.partial);
    to[UnitMeasure::drag].sd = std::max(least_sd, -std::log(effort.drag.partial));
  }
  if (EffortOnMotion::is_told(effort.torque)) {
    Measured& torque = to[UnitMeasure::torque];
    torque.value = std::abs(1.0 / (gain * effort.torque.value)) / effort.torque.partial;
    torque.sd = std::max(least_sd, -std::log(effort.torque.partial));
    torque.forwards_nats = std::copysign(limit.most_nats, -effort.torque.value);
  }
}

/// Everything that a recording says of units.
inline UnitEvidence measure_units(const Model& model, const PreparedRecording& prepared,
                                  const Catalogue& catalogue) {
  UnitEvidence evidence;
  const Recording& recording = prepared.recording();
  const Inputs& inputs = prepared.inputs();
  evidence.columns.push_back("t_s");
  for (const Column& one : recording.columns)
    if (recording.has(one.name)) evidence.columns.push_back(one.name);
  if (recording.has("power_param"))
    for (const double power : recording.column("power_param"))
      if (power > evidence.most_power) evidence.most_power = power;
  evidence.interval_s = prepared.interval_s();
  evidence.is_axis = inputs.axis();
  evidence.is_bench = inputs.bench();
  evidence.uses_temperature = model.has_thermal() || model.has_current();
  evidence.motor = temperature_range(recording, "motor_C");
  evidence.air = temperature_range(recording, "ambient_C");
  if (recording.has("supply_V")) {
    std::vector<double> volts = finite_samples(recording.column("supply_V"));
    const double typical = median_of(volts);
    Measured& supply = evidence[UnitMeasure::supply];
    if (model.supply) supply.value = std::abs(typical) / model.supply->nominal_V;
    supply.forwards_nats = std::copysign(MotionEvidenceThresholds().most_nats, typical);
    constexpr double supply_sd = 0.5;
    supply.sd = supply_sd;
  }
  if (evidence.is_bench) HeatEvidence(model, inputs, recording, catalogue).tell(evidence);
  if (evidence.is_axis) measure_axis(model, prepared, evidence);
  return evidence;
}

}  // namespace thermopower::gap::engine
