// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/prepared_recording.hpp>
#include <thermopower/gap/detail/column_option.hpp>
#include <thermopower/gap/detail/bench_scale_check.hpp>
#include <thermopower/gap/detail/readings.hpp>
#include <thermopower/gap/detail/scale_check.hpp>
#include <thermopower/gap/detail/temperature_check.hpp>
#include <thermopower/gap/simulate.hpp>
#include <thermopower/plant/samples.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <string>
#include <utility>
#include <vector>

/// @file unit_check.hpp
/// Units, signs, exchanged columns and clocks: what the simulation follows far better in another unit was not
/// recorded in the one its column's name says.

namespace thermopower::gap::engine {

/// How far a simulation is from a recording, as UnitThresholds says; NaN where nothing can be compared.
inline double misfit(const Model& model, const Recording& recording, const Catalogue& catalogue) {
  const double interval_s = plant::median_interval_s(recording.t_s, recording.spans(), 0.0);
  SimulationOptions options;
  options.horizon_s = static_cast<double>(UnitThresholds().window_rows) * interval_s;
  constexpr double most = 1e3;
  double sum = 0.0;
  int count = 0;
  for (const SimulatedSignal& signal : simulate(model, recording, options, catalogue)) {
    const Eigen::VectorXd measured = unwrapped(recording.column(to_string(signal.signal)), recording.spans());
    double errors = 0.0, moved = 0.0, reference = 0.0;
    for (Eigen::Index i = 0; i < measured.size(); ++i) {
      const double error = signal.values[i] - measured[i];
      if (!std::isfinite(error)) continue;
      // Where a window starts, simulation and measurement are the same.
      if (signal.signal != Signal::current_A &&
          std::abs(error) <= 1e-9 * std::max(1.0, std::abs(measured[i])))
        reference = measured[i];
      errors += std::min(error * error, UnitThresholds().largest_square);
      moved += (measured[i] - reference) * (measured[i] - reference);
    }
    if (!(errors > 0.0)) continue;
    const double share = moved > 0.0 ? std::min(std::sqrt(errors / moved), most) : most;
    sum += share * share;
    ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : std::numeric_limits<double>::quiet_NaN();
}

/// Some of a recording for the unit check: of an axis four stretches of consecutive rows, of a bench every n-th
/// row with the mean power, so that it spans a time in which temperatures move.
inline Recording sampled(const Recording& recording, bool axis) {
  constexpr Eigen::Index most = UnitThresholds().rows;
  if (recording.rows() <= most) return recording;
  Recording part;
  part.name = recording.name;
  std::vector<Eigen::Index> rows;
  const Eigen::Index stride = axis ? 1 : (recording.rows() + most - 1) / most;
  constexpr Eigen::Index parts = 4;
  const auto add = [&](Eigen::Index from, Eigen::Index end, const std::string& label) {
    const auto begin = static_cast<Eigen::Index>(rows.size());
    for (Eigen::Index i = from; i < end; i += stride) rows.push_back(i);
    if (static_cast<Eigen::Index>(rows.size()) - begin > 1)
      part.runs.push_back({begin, static_cast<Eigen::Index>(rows.size()), label});
    else rows.resize(static_cast<std::size_t>(begin));
  };
  for (const RunSpan& run : recording.spans()) {
    if (!axis) {
      add(run.begin, run.end, run.label);
      continue;
    }
    for (Eigen::Index p = 0; p < parts; ++p) {
      const Eigen::Index begin = p * (recording.rows() - most / parts) / (parts - 1);
      const Eigen::Index from = std::max(begin, run.begin), end = std::min(begin + most / parts, run.end);
      if (from < end) add(from, end, run.label);
    }
  }
  const auto count = static_cast<Eigen::Index>(rows.size());
  const auto pick = [&](const Eigen::VectorXd& values, bool mean) {
    Eigen::VectorXd picked(count);
    for (Eigen::Index k = 0; k < count; ++k) {
      const Eigen::Index row = rows[static_cast<std::size_t>(k)];
      picked[k] = mean ? values.segment(row, std::min(stride, values.size() - row)).mean() : values[row];
    }
    return picked;
  };
  part.t_s = pick(recording.t_s, false);
  for (const Column& column : recording.columns)
    part.columns.push_back({column.name, pick(column.values, column.name == "power_param" && stride > 1)});
  return part;
}

/// Rows of a column moved to later rows by `shift` (to earlier ones where negative), ends repeated.
inline Eigen::VectorXd shifted(const Eigen::VectorXd& values, Eigen::Index shift) {
  Eigen::VectorXd result(values.size());
  for (Eigen::Index i = 0; i < values.size(); ++i)
    result[i] = values[std::clamp<Eigen::Index>(i - shift, 0, values.size() - 1)];
  return result;
}

/// A current follows its voltage within a row: where another shift fits far better, the loggers' clocks differ.
inline void check_current_clock(const Model& model, const Recording& sample, double interval_s,
                                const Catalogue& catalogue, FindingList& list) {
  constexpr Eigen::Index furthest = 12;
  constexpr double least_rows = 30.0;
  if (!model.has_current() || !sample.has("power_param") || !sample.has("current_A")) return;
  SimulationOptions options;
  options.mode = SimulationMode::measured_inputs;
  for (const SimulatedSignal& signal : simulate(model, sample, options, catalogue)) {
    if (signal.signal != Signal::current_A) continue;
    const Eigen::VectorXd& measured = sample.column("current_A");
    const auto left_at = [&](Eigen::Index shift) {
      double xx = 0.0, xy = 0.0, yy = 0.0, rows = 0.0;
      for (const RunSpan& run : sample.spans())
        for (Eigen::Index i = run.begin + furthest; i + furthest < run.end; ++i) {
          const double x = signal.values[i - shift], y = measured[i];
          if (!std::isfinite(x) || !std::isfinite(y)) continue;
          xx += x * x, xy += x * y, yy += y * y, rows += 1.0;
        }
      return rows > least_rows && xx > 0.0 ? (yy - xy * xy / xx) / rows : -1.0;
    };
    const double now = left_at(0);
    double best = now;
    Eigen::Index at = 0;
    for (Eigen::Index shift = -furthest; shift <= furthest; ++shift) {
      const double left = left_at(shift);
      if (left >= 0.0 && left < best) best = left, at = shift;
    }
    if (at == 0 || !(best < UnitThresholds().shifted_back * now)) return;
    list.add(FindingKind::clock_shift, Severity::warning, "current_A",
             std::string(at > 0 ? "follows" : "precedes") + " power_param by " +
                 short_number(static_cast<double>(std::abs(at)) * interval_s) + " s (" +
                 std::to_string(std::abs(at)) + (std::abs(at) == 1 ? " row)" : " rows)"),
             "log both with one clock");
  }
}

/// Only the impossible is a clock's fault: a motion before its command. One that comes after may be the drive's own
/// delay.
inline void check_drive_clock(const Model& model, const Recording& sample, double now, double interval_s,
                              const Catalogue& catalogue, FindingList& list) {
  constexpr Eigen::Index furthest = 8;
  constexpr double least_misfit = 0.02;
  const char* const commands = model.axis && model.axis->voltage_driven() ? "voltage_V" : "drive_A";
  if (!moves(model, sample) || !sample.has(commands) || !(now > least_misfit)) return;
  double best = now;
  Eigen::Index at = 0;
  for (Eigen::Index k = 1; k <= furthest; ++k) {
    Recording early = sample;
    early.set(commands, shifted(sample.column(commands), -k));
    const double left = misfit(model, early, catalogue);
    if (left < best) best = left, at = k;
  }
  if (at > 0 && best < UnitThresholds().shifted_axis * now)
    list.add(FindingKind::clock_shift, Severity::warning, commands,
             "is stamped " + short_number(static_cast<double>(at) * interval_s) +
                 " s later than the motion it causes",
             "log both with one clock");
}

/// A thermometer that stands still: it never changes, where the simulation warms by more than any step of one.
inline void check_thermometer(const Model& model, const Recording& sample, const Catalogue& catalogue,
                              FindingList& list) {
  const Eigen::VectorXd* measured = sample.find("motor_C");
  if (measured == nullptr || !model.has_thermal()) return;
  std::vector<double> values = finite_samples(*measured);
  if (values.empty() || quantile_of(values, 0.0) != quantile_of(values, 1.0)) return;
  SimulationOptions options;
  options.horizon_s = std::numeric_limits<double>::infinity();
  for (const SimulatedSignal& signal : simulate(model, sample, options, catalogue)) {
    if (signal.signal != Signal::motor_C) continue;
    std::vector<double> simulated = finite_samples(signal.values);
    if (simulated.empty()) return;
    const double moves = quantile_of(simulated, 1.0) - quantile_of(simulated, 0.0);
    if (moves > UnitThresholds().stands_still_K)
      list.add(FindingKind::frozen_samples, Severity::error, "motor_C",
               "never changes, where the model's goes through " + short_number(moves) +
                   " degC: a thermometer that stands still",
               "look at what reads the sensor, or leave the column out");
  }
}

/// Temperatures and powers that none can be.
/// @param most_power  largest power_param of all recordings that were given together
inline void check_ranges(const Recording& recorded, double most_power, FindingList& list) {
  TemperatureCheck(recorded).find(list);
  if (recorded.has("power_param") && most_power > 0.0 && most_power <= 1.0)
    list.add(FindingKind::wrong_unit, Severity::error, "power_param",
             "never exceeds 1: a duty of 0..1 where 0..255 is expected", column_option("power_param", "1"));
}

/// Whether a reading is about what moves an axis, or how it moves.
inline bool is_of_axis(const Reading& one) {
  constexpr const char* columns[] = {"drive_A", "voltage_V", "angle_deg", "rate_dps", "t_s"};
  return std::find(std::begin(columns), std::end(columns), one.column) != std::end(columns);
}

/// What units, signs, order and clocks of a recording's columns are wrong, as far as the simulation can tell.
/// @param most_power  largest power_param of all recordings that were given together: a part of them may well be off
inline std::vector<Finding> check_units(const Model& model, const Recording& recorded,
                                        const PreparedRecording& prepared, const Catalogue& catalogue,
                                        double most_power) {
  constexpr UnitThresholds limit;
  if (model.own) return {};  // nobody but its author knows the units of its columns
  FindingList list(recorded);
  const Inputs& inputs = prepared.inputs();
  const bool axis = moves(model, recorded);
  bool sound_axis = false;
  if (inputs.bench()) {
    const BenchScaleCheck bench(model, prepared, catalogue, most_power);
    if (bench.find_exchanged(list)) return list.take();
    check_ranges(prepared.recording(), most_power, list);
    if (list.empty()) bench.find(list);
  } else {
    check_ranges(prepared.recording(), most_power, list);
  }
  if (inputs.axis()) {
    const AxisScaleCheck scale(model, prepared);
    scale.find(list);
    sound_axis = scale.is_sound();
  }
  if (!list.empty()) return list.take();
  Recording sample = sampled(prepared.recording(), axis);
  constexpr Eigen::Index few = 20;
  if (sample.rows() < few) return {};
  const double now = misfit(model, sample, catalogue);
  if (std::isfinite(now) && now > limit.follows) {
    std::vector<Reading> readings = ReadingList(model, recorded).take();
    const Reading* best = nullptr;
    double least = now;
    for (const Reading& one : readings) {
      if (now < one.least_misfit || (sound_axis && is_of_axis(one))) continue;
      Recording other = sample;
      one.apply(other);
      const double left = misfit(model, other, catalogue);
      if (!(left < least)) continue;
      // A drive that pushes against a stop or a brake had better not push at all. That is no unit: in its own, it moves.
      if (one.without) {
        Recording idle = sample;
        one.without(idle);
        if (!(left < limit.better_than_without * misfit(model, idle, catalogue))) continue;
      }
      least = left, best = &one;
    }
    if (best != nullptr && least * best->far_better < now && least < limit.believable) {
      list.add(best->kind, Severity::error, best->column,
               best->words + " (the simulation then follows the data " + short_number(now / least) +
                   " times better)",
               best->mend);
      return list.take();
    }
  }
  check_thermometer(model, sample, catalogue, list);  // after exchanged columns: the air may stand still
  check_current_clock(model, sample, prepared.interval_s(), catalogue, list);
  if (std::isfinite(now)) check_drive_clock(model, sample, now, prepared.interval_s(), catalogue, list);
  return list.take();
}

}  // namespace thermopower::gap::engine
