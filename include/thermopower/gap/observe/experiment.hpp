// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/observe/prepared_recording.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

/// @file experiment.hpp
/// Whether what was done can tell anything: was the actuator driven, sampled often enough, and are the held-out data
/// others than the training data.

namespace thermopower::gap::engine {

/// Thresholds of the check of the experiment.
/// Held by tests/gap/data/units_test.cpp.
struct ExperimentThresholds {
  double rows_per_window = 4.0;  ///< fewer say nothing about what happens between restarts of the axis
  double slow_axis_s =
      1.0;  ///< interval between rows of an axis that is odd: another unit is asked for first
  double not_driven = 0.02;  ///< of the training data's largest command
  double not_moving = 0.2;   ///< of the training data's range of a judged signal
  double mostly = 0.5;       ///< of a temperature's range, by which it cools or what stands next to it moves
  double same_rows = 0.9;    ///< share of equal rows of two recordings that are one
  Eigen::Index pattern_rows = 24;  ///< rows by which a recording is sought in another
};

/// The largest magnitude of the command that drives what is judged, 0 where it is never driven; NaN without one.
inline double largest_command(const Inputs& inputs) {
  double most = missing;
  const auto look = [&](const Eigen::VectorXd& values) {
    if (values.size() > 0) most = std::fmax(most, values.cwiseAbs().maxCoeff());
  };
  if (inputs.axis() || inputs.heat == HeatSource::drive) look(inputs.drive_A);
  if (inputs.axis()) look(inputs.voltage_V), look(inputs.torque_Nm), look(inputs.servo_A);
  if (inputs.bench()) look(inputs.power_param), look(inputs.heat_W);
  if (inputs.bench() && inputs.heat == HeatSource::measured) look(inputs.held_current_A);
  return most;
}

/// The same of several recordings.
inline double largest_command(const std::vector<PreparedRecording>& recordings) {
  double most = missing;
  for (const PreparedRecording& one : recordings) most = std::fmax(most, largest_command(one.inputs()));
  return most;
}

/// The column that commands what is judged.
inline std::string command_column(const Inputs& inputs) {
  if (inputs.closed_loop) return inputs.target_deg.size() > 0 ? "target_deg" : "target_dps";
  if (inputs.axis())
    return inputs.drive_A.size() > 0 || inputs.voltage_V.size() == 0 ? "drive_A" : "voltage_V";
  return inputs.heat == HeatSource::recorded ? "heat_W" : "power_param";
}

/// 5th to 95th percentile of a judged signal.
inline double range_of(const Inputs& inputs, Signal signal) {
  std::vector<double> values = finite_samples(inputs.of(signal));
  return middle_range_of(values);
}

/// The widest range of every signal in some recordings, 0 where none judges it.
inline std::array<double, signal_count> ranges_of(const std::vector<PreparedRecording>& recordings) {
  std::array<double, signal_count> ranges{};
  for (const PreparedRecording& one : recordings)
    for (std::size_t i = 0; i < signal_count; ++i)
      if (const auto signal = static_cast<Signal>(i); one.inputs().judged(signal))
        ranges[i] = std::max(ranges[i], range_of(one.inputs(), signal));
  return ranges;
}

/// Whether a body tells something though nothing drives it: it cools, or what is mounted next to it warms or cools as much.
inline bool is_driven_by_others(const Inputs& inputs) {
  constexpr ExperimentThresholds limit;
  if (inputs.axis() || !inputs.bench() || !inputs.judged(Signal::motor_C)) return false;
  const double range = range_of(inputs, Signal::motor_C);
  if (!(range > 0.0)) return false;
  const std::vector<double> own = finite_samples(inputs.of(Signal::motor_C));
  std::vector<double> next = finite_samples(inputs.neighbour_C);
  return std::max(own.front() - own.back(), middle_range_of(next)) > limit.mostly * range;
}

/// Whether the outputs of `part` are those of some rows of `whole`.
inline bool is_part_of(const PreparedRecording& part, const PreparedRecording& whole) {
  constexpr ExperimentThresholds limit;
  const Inputs& a = part.inputs();
  const Inputs& b = whole.inputs();
  std::vector<std::pair<const Eigen::VectorXd*, const Eigen::VectorXd*>> signals;
  for (int i = 0; i < signal_count; ++i) {
    const auto signal = static_cast<Signal>(i);
    if (a.judged(signal) && b.judged(signal)) signals.push_back({&a.of(signal), &b.of(signal)});
  }
  const Eigen::Index length = limit.pattern_rows;
  if (signals.empty() || a.rows() < length || b.rows() < length) return false;
  const auto same = [&](Eigen::Index i, Eigen::Index k) {
    bool any = false;
    for (const auto& [x, y] : signals) {
      const bool known = std::isfinite((*x)[i]) && std::isfinite((*y)[k]);
      if (known && (*x)[i] != (*y)[k]) return false;
      any = any || known;
    }
    return any;
  };
  // The pattern lies where something changes, so that a rest does not pass for another.
  Eigen::Index from = 0, most = 0;
  for (Eigen::Index start = 0; start + length <= a.rows(); start += length) {
    Eigen::Index changes = 0;
    for (Eigen::Index i = start + 1; i < start + length; ++i)
      for (const auto& [x, y] : signals) changes += (*x)[i] != (*x)[i - 1] ? 1 : 0;
    if (changes > most) most = changes, from = start;
  }
  if (most < length / 4) return false;
  for (Eigen::Index at = 0; at + length <= b.rows(); ++at) {
    Eigen::Index i = 0;
    while (i < length && same(from + i, at + i)) ++i;
    if (i < length) continue;
    Eigen::Index equal = 0, compared = 0;
    for (Eigen::Index row = 0; row < a.rows(); ++row) {
      const Eigen::Index there = row - from + at;
      if (there < 0 || there >= b.rows()) continue;
      ++compared;
      equal += same(row, there) ? 1 : 0;
    }
    if (2 * compared >= a.rows() &&
        static_cast<double>(equal) >= limit.same_rows * static_cast<double>(compared))
      return true;
  }
  return false;
}

/// Faults of the experiment as a whole.
/// @param horizon_s  length of the axis' windows in s
inline std::vector<Finding> check_experiment(const std::vector<PreparedRecording>& train,
                                             const std::vector<PreparedRecording>& held_out,
                                             double horizon_s) {
  constexpr ExperimentThresholds limit;
  std::vector<Finding> findings;
  const auto add = [&](FindingKind kind, const PreparedRecording& where, const std::string& column,
                       const std::string& message, const std::string& mend) {
    findings.push_back({kind, Severity::error, where.inputs().name, column, message, mend});
  };
  double slowest_s = 0.0;
  const PreparedRecording* slow = nullptr;
  for (const auto* all : {&train, &held_out})
    for (const PreparedRecording& one : *all)
      if (one.inputs().axis() && one.interval_s() > slowest_s) slowest_s = one.interval_s(), slow = &one;
  if (slow != nullptr && horizon_s < limit.rows_per_window * slowest_s * (1.0 - 1e-6))
    add(FindingKind::sampled_too_slowly, *slow, "t_s",
        "has a row every " + short_number(slowest_s) + " s, fewer than " +
            short_number(limit.rows_per_window) + " in a window of " + short_number(horizon_s) + " s",
        std::string(slowest_s > limit.slow_axis_s ? "say so where t_s is in another unit than seconds "
                                                    "(--column t_s=t_s:ms); else sample faster, or "
                                                  : "sample faster, or ") +
            "judge over longer windows: --horizon " +
            short_number(std::ceil(10.0 * limit.rows_per_window * slowest_s * 2.0) / 10.0));
  const double driven = largest_command(train), held_driven = largest_command(held_out);
  const bool by_others = std::any_of(train.begin(), train.end(), [](const PreparedRecording& one) {
    return std::isfinite(largest_command(one.inputs())) && is_driven_by_others(one.inputs());
  });
  if (driven == 0.0 && !by_others)
    add(FindingKind::never_driven, train.front(), command_column(train.front().inputs()),
        "is 0 throughout: nothing was driven", "record while the actuator is driven at several levels");
  const std::array<double, signal_count> ranges = ranges_of(train), held_ranges = ranges_of(held_out);
  bool held_moves = false;
  for (std::size_t i = 0; i < signal_count; ++i)
    held_moves = held_moves || held_ranges[i] > limit.not_moving * ranges[i];
  constexpr auto heat = static_cast<std::size_t>(Signal::motor_C);
  held_moves = held_moves || (held_ranges[heat] > limit.not_driven * ranges[heat] &&
                              std::any_of(held_out.begin(), held_out.end(), [](const PreparedRecording& one) {
                                return is_driven_by_others(one.inputs());
                              }));
  if (driven > 0.0 && held_driven <= limit.not_driven * driven && !held_moves)
    add(FindingKind::held_out_not_excited, held_out.front(), "",
        "is never driven and does not move: no model can be judged on it",
        "hold out data in which the actuator is driven");
  for (const PreparedRecording& held : held_out)
    for (const PreparedRecording& one : train)
      if (is_part_of(held, one)) {
        // A part of a recording knows which row of it is its first.
        const bool is_its_end = held.recording().first_row > 0 && held.inputs().name == one.inputs().name;
        add(FindingKind::held_out_in_training, held, "",
            is_its_end
                ? "holds the same samples in the part that is held out of it as before that: it repeats itself"
                : "holds the same samples as the training recording '" + one.inputs().name + "'",
            is_its_end ? "look at what logs, or hold out another recording with --heldout"
                       : "hold out another recording, or leave --heldout away");
      }
  for (std::size_t i = 0; i < train.size(); ++i)
    for (std::size_t k = i + 1; k < train.size(); ++k)
      if (is_part_of(train[k], train[i]))
        add(FindingKind::recording_given_twice, train[k], "",
            "holds the same samples as '" + train[i].inputs().name + "'", "give each recording once");
  return findings;
}

}  // namespace thermopower::gap::engine
