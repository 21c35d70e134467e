// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/prepared_recording.hpp>
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

/// Thresholds of the unit check. A misfit is the root mean square of simulated minus measured over that of
/// measured minus where the simulation started: 0 for a perfect simulation, 1 for one that is no better than
/// standing still.
/// Held by tests/gap/data/units_test.cpp.
struct UnitThresholds {
  double follows =
      0.2;  ///< misfit below which the simulation follows the data as they are, and nothing is asked
  double far_better =
      3.0;  ///< times by which another unit must lower the misfit: no effect of a real motor does that
  double believable = 0.7;  ///< misfit that the data must have in the other unit
  double better_than_without =
      0.9;  ///< of the misfit without a column: what that column must lower it to in the unit that makes it small
  double off_by_factor =
      0.1;  ///< of the factor by which an output is said to be too small: what the misfit must be as it is
  double kelvin_C = 200.0;     ///< air is never so hot: kelvin
  double fahrenheit_C = 45.0;  ///< air hardly ever is: degrees Fahrenheit are asked about
  double stands_still_K =
      10.0;  ///< that the simulation warms by: thermometers come in steps of a degree or two, none of ten
  double warmer_than_air_K =
      15.0;                       ///< a motor that starts so much above the air may be in degrees Fahrenheit
  Eigen::Index rows = 3000;       ///< of the recording that are simulated
  Eigen::Index window_rows = 50;  ///< of an axis between restarts
  double shifted_back =
      0.6;  ///< of the current's variance that remains when another shift of the clock is right
  double shifted_axis = 0.55;  ///< of an axis's misfit
  double largest_square =
      1e18;  ///< of an error: a simulation that left the number range is very bad, not undefined
};

/// Another reading of a recording: what might be wrong with it, and how to read it then.
struct Reading {
  FindingKind kind = FindingKind::wrong_unit;  ///< wrong_unit, wrong_sign or swapped_columns
  std::string column;                          ///< whose finding it is
  std::string words;                           ///< "is in kelvin where degrees Celsius are expected"
  std::string mend;                            ///< options of the program
  std::function<void(Recording&)> apply;       ///< turns the recording into what it should be
  double least_misfit = 0.0;                   ///< misfit as recorded below which it cannot be that
  std::function<void(Recording&)> without =
      nullptr;  ///< takes away what it makes small; empty where it does not
};

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

/// Whether the model's axis is judged on a recording, and not its body.
inline bool moves(const Model& model, const Recording& recording) {
  return model.has_axis() && (recording.has("rate_dps") || recording.has("angle_deg"));
}

/// Makes the readings of a recording that are worth asking about.
class ReadingList {
public:
  /// @param model     what judges them
  /// @param recording as it was given
  ReadingList(const Model& model, const Recording& recording) : recording_(recording) {
    times();
    temperatures();
    electrical(model);
    if (moves(model, recording)) motion();
    swaps();
  }
  /// The readings, the commonest mistakes first.
  std::vector<Reading> take() { return std::move(list_); }

private:
  static void scale(Recording& r, const char* column, double factor, double offset = 0.0) {
    if (!r.has(column)) return;
    r.set(column, ((r.column(column).array() - offset) * factor).matrix());
  }
  static std::string option(const std::string& column, const std::string& unit) {
    return "--column " + column + "=" + column + ":" + unit;
  }
  void scaled(const char* column, const char* unit, double factor, const std::string& words) {
    if (!recording_.has(column)) return;
    const std::string name = column;
    list_.push_back({FindingKind::wrong_unit, name, words, option(name, unit),
                     [name, factor](Recording& r) { scale(r, name.c_str(), factor); }});
    constexpr const char* outputs[] = {"current_A", "angle_deg", "rate_dps"};
    if (factor < 1.0 && std::find(std::begin(outputs), std::end(outputs), name) == std::end(outputs))
      list_.back().without = [name](Recording& r) { scale(r, name.c_str(), 0.0); };
  }
  void turned(const char* column, const char* unit, const std::string& words) {
    if (!recording_.has(column)) return;
    const std::string name = column;
    list_.push_back({FindingKind::wrong_sign, name, words, option(name, std::string("-") + unit),
                     [name](Recording& r) { scale(r, name.c_str(), -1.0); }});
  }
  double typical(const char* column) const {
    std::vector<double> values = finite_samples(recording_.column(column));
    return median_of(values);
  }
  double first_of(const char* column) const {
    for (const double value : recording_.column(column))
      if (std::isfinite(value)) return value;
    return missing;
  }
  double largest(const char* column) const {
    std::vector<double> values = finite_samples(recording_.column(column).cwiseAbs());
    return quantile_of(values, 1.0);
  }

  void times() {
    const auto add = [&](const char* unit, double factor, const char* words) {
      list_.push_back({FindingKind::wrong_unit, "t_s", words, option("t_s", unit),
                       [factor](Recording& r) { r.t_s *= factor; }});
    };
    add("ms", 1e-3, "is in milliseconds where seconds are expected");
    add("us", 1e-6, "is in microseconds where seconds are expected");
    add("min", 60.0, "is in minutes where seconds are expected");
  }

  void temperatures() {
    constexpr UnitThresholds limit;
    const bool motor = recording_.has("motor_C"), air = recording_.has("ambient_C");
    const auto both = [&](const char* unit, double factor, double offset, const char* words) {
      std::string mend;
      for (const char* name : {"motor_C", "ambient_C", "neighbour_C"})
        if (recording_.has(name)) mend += (mend.empty() ? "" : " ") + option(name, unit);
      list_.push_back({FindingKind::wrong_unit, motor ? "motor_C" : "ambient_C", words, mend,
                       [factor, offset](Recording& r) {
                         for (const char* name : {"motor_C", "ambient_C", "neighbour_C"})
                           scale(r, name, factor, offset);
                       }});
    };
    const auto one = [&](const char* name, const char* unit, double factor, double offset,
                         const char* words) {
      const std::string column = name;
      list_.push_back({FindingKind::wrong_unit, column, words, option(column, unit),
                       [column, factor, offset](Recording& r) { scale(r, column.c_str(), factor, offset); }});
    };
    constexpr double per_fahrenheit = 5.0 / 9.0, ice_F = 32.0, ice_K = 273.15;
    const char* const fahrenheit = "is in degrees Fahrenheit where degrees Celsius are expected";
    const char* const kelvin = "is in kelvin where degrees Celsius are expected";
    const bool hot_air = air && typical("ambient_C") > limit.fahrenheit_C;
    const bool hot_start = motor && first_of("motor_C") > limit.fahrenheit_C &&
                           (!air || first_of("motor_C") > first_of("ambient_C") + limit.warmer_than_air_K);
    if (hot_air && motor) both("degF", per_fahrenheit, ice_F, fahrenheit), both("K", 1.0, ice_K, kelvin);
    if (hot_air) one("ambient_C", "degF", per_fahrenheit, ice_F, fahrenheit);
    if (hot_air) one("ambient_C", "K", 1.0, ice_K, kelvin);
    if (hot_start) one("motor_C", "degF", per_fahrenheit, ice_F, fahrenheit);
    if (hot_start) one("motor_C", "K", 1.0, ice_K, kelvin);
  }

  void electrical(const Model& model) {
    if (recording_.has("power_param")) {
      const double most = largest("power_param");
      if (most <= 1.0) scaled("power_param", "1", 255.0, "is a duty of 0..1 where 0..255 is expected");
      else if (most <= 100.0) scaled("power_param", "%", 2.55, "is in percent where 0..255 is expected");
    }
    scaled("supply_V", "mV", 1e-3, "is in millivolts where volts are expected");
    scaled("current_A", "mA", 1e-3, "is in milliamperes where amperes are expected");
    turned("current_A", "A", "has the wrong sign: a motor's current is positive where its voltage is");
    if (model.has_thermal()) {
      scaled("heat_W", "mW", 1e-3, "is in milliwatts where watts are expected");
      scaled("heat_W", "kW", 1e3, "is in kilowatts where watts are expected");
      turned("heat_W", "W", "has the wrong sign: it cools the body");
    }
    if (moves(model, recording_)) {
      scaled("drive_A", "mA", 1e-3, "is in milliamperes where amperes are expected");
      scaled("voltage_V", "mV", 1e-3, "is in millivolts where volts are expected");
      if (model.has_servo() && !recording_.has("drive_A")) {
        scaled("target_deg", "rad", deg_per_rad, "is in radians where degrees are expected");
        scaled("target_dps", "rad/s", deg_per_rad,
               "is in radians per second where degrees per second are expected");
        turned("target_deg", "deg", "has the wrong sign: the axis moves the other way");
        turned("target_dps", "deg/s", "has the wrong sign: the axis moves the other way");
      }
      scaled("torque_Nm", "mNm", 1e-3, "is in millinewton metres where newton metres are expected");
      scaled("torque_Nm", "Ncm", 1e-2, "is in newton centimetres where newton metres are expected");
      turned("torque_Nm", "Nm", "has the wrong sign: it accelerates the axis backwards");
      turned("drive_A", "A", "has the wrong sign: it accelerates the axis backwards");
      turned("voltage_V", "V", "has the wrong sign: it accelerates the axis backwards");
    }
  }

  void motion() {
    constexpr double rpm = 6.0;  // deg/s in one turn a minute
    const bool rate = recording_.has("rate_dps"), angle = recording_.has("angle_deg");
    if (rate && angle)
      list_.push_back({FindingKind::wrong_unit, "rate_dps",
                       "and angle_deg are in radians where degrees are expected",
                       option("rate_dps", "rad/s") + " " + option("angle_deg", "rad"),
                       [](Recording& r) {
                         scale(r, "rate_dps", deg_per_rad);
                         scale(r, "angle_deg", deg_per_rad);
                       },
                       UnitThresholds().off_by_factor * deg_per_rad});
    scaled("rate_dps", "rad/s", deg_per_rad,
           "is in radians per second where degrees per second are expected");
    scaled("rate_dps", "rpm", rpm, "is in turns per minute where degrees per second are expected");
    // With a rate beside it, an angle that is off by a factor is a cause (angle_scale) and no finding.
    if (!rate) scaled("angle_deg", "rad", deg_per_rad, "is in radians where degrees are expected");
    turned("rate_dps", "deg/s", "has the wrong sign against drive and angle");
    turned("angle_deg", "deg", "has the wrong sign: it falls where the axis is driven and turns forwards");
  }

  void swaps() {
    constexpr std::pair<const char*, const char*> pairs[] = {{"motor_C", "ambient_C"},
                                                             {"angle_deg", "rate_dps"},
                                                             {"current_A", "supply_V"},
                                                             {"current_A", "motor_C"}};
    for (const auto& [a, b] : pairs) {
      if (!recording_.has(a) || !recording_.has(b)) continue;
      const std::string first = a, second = b;
      list_.push_back({FindingKind::swapped_columns, first, "and " + second + " are exchanged",
                       "--column " + first + "=" + second + " --column " + second + "=" + first,
                       [first, second](Recording& r) {
                         const Eigen::VectorXd kept = r.column(first);
                         r.set(first, r.column(second));
                         r.set(second, kept);
                       }});
    }
  }

  const Recording& recording_;
  std::vector<Reading> list_;
};

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

/// What units, signs, order and clocks of a recording's columns are wrong, as far as the simulation can tell.
/// @param most_power  largest power_param of all recordings that were given together: a part of them may well be off
inline std::vector<Finding> check_units(const Model& model, const Recording& recorded,
                                        const PreparedRecording& prepared, const Catalogue& catalogue,
                                        double most_power) {
  constexpr UnitThresholds limit;
  if (model.own) return {};  // nobody but its author knows the units of its columns
  FindingList list(recorded);
  for (const char* name : {"ambient_C", "motor_C"}) {
    if (!recorded.has(name)) continue;
    std::vector<double> values = finite_samples(recorded.column(name));
    const double least = quantile_of(values, 0.05);
    if (least > limit.kelvin_C)
      list.add(FindingKind::wrong_unit, Severity::error, name,
               "is at least " + short_number(least) + ": in kelvin where degrees Celsius are expected",
               std::string("--column ") + name + "=" + name + ":K");
  }
  if (recorded.has("power_param") && most_power > 0.0 && most_power <= 1.0)
    list.add(FindingKind::wrong_unit, Severity::error, "power_param",
             "never exceeds 1: a duty of 0..1 where 0..255 is expected",
             "--column power_param=power_param:1");
  const bool axis = moves(model, recorded);
  Recording sample = sampled(prepared.recording(), axis);
  constexpr Eigen::Index few = 20;
  if (sample.rows() < few) return list.take();
  const double now = misfit(model, sample, catalogue);
  std::vector<Finding> so_far = list.take();
  if (!so_far.empty()) return so_far;
  FindingList more(recorded);
  if (std::isfinite(now) && now > limit.follows) {
    std::vector<Reading> readings = ReadingList(model, recorded).take();
    const Reading* best = nullptr;
    double least = now;
    for (const Reading& one : readings) {
      if (now < one.least_misfit) continue;
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
    if (best != nullptr && least * limit.far_better < now && least < limit.believable) {
      more.add(best->kind, Severity::error, best->column,
               best->words + " (the simulation then follows the data " + short_number(now / least) +
                   " times better)",
               best->mend);
      return more.take();
    }
  }
  check_thermometer(model, sample, catalogue, more);  // after exchanged columns: the air may stand still
  check_current_clock(model, sample, prepared.interval_s(), catalogue, more);
  if (std::isfinite(now)) check_drive_clock(model, sample, now, prepared.interval_s(), catalogue, more);
  return more.take();
}

}  // namespace thermopower::gap::engine
