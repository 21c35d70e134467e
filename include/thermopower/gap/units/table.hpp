// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/finding.hpp>
#include <thermopower/gap/units/measures.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

/// @file table.hpp
/// The table of hypotheses: which column is in which unit, has its sign turned round, or stands in another one's place. A factor
/// that is not in it is not a unit.

namespace thermopower::gap::engine {

/// A unit of a column other than the expected one: recorded = factor * expected + offset.
struct ColumnScale {
  const char* column;   ///< whose unit it is
  const char* option;   ///< the unit as `--column` spells it
  const char* words;    ///< the unit in a sentence, after "is"; a sign starts with "has"
  double factor;        ///< by which the numbers are larger; negative for a turned sign
  double offset = 0.0;  ///< by which they are larger besides
};

/// All units and signs that are looked for, column by column.
inline constexpr ColumnScale column_scales[] = {
    {"rate_dps", "rad/s", "in radians per second where degrees per second are expected", rad_per_deg},
    {"rate_dps", "rpm", "in turns per minute where degrees per second are expected", 1.0 / 6.0},
    {"rate_dps", "rev/s", "in turns per second where degrees per second are expected", 1.0 / 360.0},
    {"rate_dps", "-deg/s", "has the wrong sign against the command and angle_deg", -1.0},
    {"angle_deg", "rad", "in radians where degrees are expected", rad_per_deg},
    {"angle_deg", "rev", "in turns where degrees are expected", 1.0 / 360.0},
    {"angle_deg", "-deg", "has the wrong sign: it falls where rate_dps says that the axis turns forwards",
     -1.0},
    {"drive_A", "mA", "in milliamperes where amperes are expected", 1e3},
    {"drive_A", "uA", "in microamperes where amperes are expected", 1e6},
    {"drive_A", "-A", "has the wrong sign: it accelerates the axis backwards", -1.0},
    {"voltage_V", "mV", "in millivolts where volts are expected", 1e3},
    {"voltage_V", "-V", "has the wrong sign: it accelerates the axis backwards", -1.0},
    {"target_deg", "rad", "in radians where degrees are expected", rad_per_deg},
    {"target_deg", "-deg", "has the wrong sign: the axis moves the other way", -1.0},
    {"target_dps", "rad/s", "in radians per second where degrees per second are expected", rad_per_deg},
    {"target_dps", "-deg/s", "has the wrong sign: the axis moves the other way", -1.0},
    {"torque_Nm", "mNm", "in millinewton metres where newton metres are expected", 1e3},
    {"torque_Nm", "Ncm", "in newton centimetres where newton metres are expected", 1e2},
    {"torque_Nm", "-Nm", "has the wrong sign: it accelerates the axis backwards", -1.0},
    {"t_s", "ms", "in milliseconds where seconds are expected", 1e3},
    {"t_s", "us", "in microseconds where seconds are expected", 1e6},
    {"t_s", "ns", "in nanoseconds where seconds are expected", 1e9},
    {"t_s", "min", "in minutes where seconds are expected", 1.0 / 60.0},
    {"t_s", "h", "in hours where seconds are expected", 1.0 / 3600.0},
    {"current_A", "mA", "in milliamperes where amperes are expected", 1e3},
    {"current_A", "uA", "in microamperes where amperes are expected", 1e6},
    {"current_A", "-A", "has the wrong sign: a motor's current is positive where its voltage is", -1.0},
    {"supply_V", "mV", "in millivolts where volts are expected", 1e3},
    {"supply_V", "-V", "has the wrong sign: the voltage of a supply is positive", -1.0},
    {"heat_W", "mW", "in milliwatts where watts are expected", 1e3},
    {"heat_W", "kW", "in kilowatts where watts are expected", 1e-3},
    {"heat_W", "-W", "has the wrong sign: it cools the body", -1.0},
    {"power_param", "%", "in percent where 0..255 is expected", 1.0 / 2.55},
    {"power_param", "1", "a duty of 0..1 where 0..255 is expected", 1.0 / 255.0},
    {"motor_C", "degF", "in degrees Fahrenheit where degrees Celsius are expected", 1.8, 32.0},
    {"motor_C", "K", "in kelvin where degrees Celsius are expected", 1.0, 273.15},
    {"motor_C", "ddegC", "in tenths of a degree where degrees Celsius are expected", 10.0},
    {"motor_C", "mdegC", "in thousandths of a degree where degrees Celsius are expected", 1e3},
    {"ambient_C", "degF", "in degrees Fahrenheit where degrees Celsius are expected", 1.8, 32.0},
    {"ambient_C", "K", "in kelvin where degrees Celsius are expected", 1.0, 273.15},
    {"ambient_C", "ddegC", "in tenths of a degree where degrees Celsius are expected", 10.0},
    {"ambient_C", "mdegC", "in thousandths of a degree where degrees Celsius are expected", 1e3},
};

/// The pairs that are looked for.
inline const ColumnPair exchangeable_columns[] = {
    {"angle_deg", "rate_dps"},    {"drive_A", "angle_deg"},   {"drive_A", "rate_dps"},
    {"voltage_V", "angle_deg"},   {"voltage_V", "rate_dps"},  {"motor_C", "ambient_C"},
    {"power_param", "current_A"}, {"power_param", "motor_C"}, {"current_A", "motor_C"},
    {"current_A", "supply_V"},    {"motor_C", "supply_V"}};

/// One line of the table. The first one changes nothing.
struct UnitHypothesis {
  std::vector<ColumnScale> scales;  ///< of the columns that are not as expected
  ColumnPair exchanged{};           ///< two columns that stand in each other's place

  /// Whether everything is as expected.
  bool is_none() const { return scales.empty() && !exchanges(); }
  /// Whether it exchanges columns.
  bool exchanges() const { return !exchanged.first.empty(); }
  /// Whether it turns a sign round.
  bool turns_sign() const {
    return std::any_of(scales.begin(), scales.end(), [](const ColumnScale& one) { return one.factor < 0.0; });
  }
  /// Whether a recording has all of its columns, and may have exchanged them.
  bool applies_to(const UnitEvidence& evidence) const {
    for (const ColumnScale& one : scales)
      if (!evidence.has(one.column)) return false;
    const auto& pairs = evidence.exchanged;
    return !exchanges() || std::find(pairs.begin(), pairs.end(), exchanged) != pairs.end();
  }
  /// The column that a finding names first.
  std::string column() const { return exchanges() ? exchanged.first : scales.front().column; }
  /// Options of the program that mend it.
  std::string mend() const {
    const auto option = [](const std::string& column, const std::string& is) {
      return "--column " + column + "=" + is;
    };
    if (exchanges())
      return option(exchanged.first, exchanged.second) + " " + option(exchanged.second, exchanged.first);
    std::string options;
    for (const ColumnScale& one : scales)
      options +=
          (options.empty() ? "" : " ") + option(one.column, std::string(one.column) + ":" + one.option);
    return options;
  }
  /// The kind of its finding.
  FindingKind kind() const {
    return exchanges()    ? FindingKind::swapped_columns
           : turns_sign() ? FindingKind::wrong_sign
                          : FindingKind::wrong_unit;
  }
  /// The fault, after the column's name.
  std::string words() const {
    if (exchanges()) return "and " + exchanged.second + " are exchanged";
    std::string text;
    for (const ColumnScale& one : scales) {
      if (!text.empty()) text += std::string(", and ") + one.column + " ";
      text += (one.factor < 0.0 ? "" : "is ") + std::string(one.words);
    }
    return text;
  }
  /// How a column is scaled; null: it is as expected.
  const ColumnScale* of(const std::string& column) const {
    for (const ColumnScale& one : scales)
      if (column == one.column) return &one;
    return nullptr;
  }
  /// The factor of a column's numbers, with its sign.
  double factor(const std::string& column) const { return of(column) != nullptr ? of(column)->factor : 1.0; }
  /// Degrees Celsius of a recorded temperature.
  double celsius(const std::string& column, double recorded) const {
    return of(column) != nullptr ? (recorded - of(column)->offset) / of(column)->factor : recorded;
  }
  /// The number that is recorded of a temperature in degrees Celsius.
  double recorded(const std::string& column, double celsius_C) const {
    return of(column) != nullptr ? of(column)->factor * celsius_C + of(column)->offset : celsius_C;
  }

  /// The value that a measure of a recording should have, with its sign.
  double expected(UnitMeasure measure, const UnitEvidence& evidence) const {
    const double rate = factor("rate_dps"), angle = factor("angle_deg"), time = factor("t_s"),
                 command = factor("drive_A") * factor("voltage_V"), current = factor("current_A"),
                 power = factor("power_param"), supply = factor("supply_V"),
                 speed = evidence.has("rate_dps") ? rate : angle / time;
    const std::string& by = evidence.heated_by;
    const double heat = by == "current_A"     ? current * current
                        : by == "drive_A"     ? factor("drive_A") * factor("drive_A")
                        : by == "power_param" ? supply * supply * power
                                              : factor("heat_W");
    switch (measure) {
      case UnitMeasure::slope:
        return rate * time / angle;
      case UnitMeasure::drive:
        return speed / (time * command);
      case UnitMeasure::drag:
        return speed / command;
      case UnitMeasure::torque:
        return factor("torque_Nm") / command;
      case UnitMeasure::target:
        return factor("target_deg") * factor("target_dps");
      case UnitMeasure::current:
        return current / (supply * std::sqrt(power));
      case UnitMeasure::supply:
        return supply;
      case UnitMeasure::heating:
        return factor("motor_C") / (time * heat);
      case UnitMeasure::cooling:
        return 1.0 / time;
    }
    return 1.0;
  }
};

/// The table for recordings with these columns.
/// @param has  (const std::string& column) -> whether it was recorded
template <class Has>
std::vector<UnitHypothesis> unit_hypotheses(const Has& has) {
  std::vector<UnitHypothesis> table{UnitHypothesis()};
  for (const ColumnScale& one : column_scales)
    if (has(one.column)) table.push_back({{one}});
  // The two columns of a motion, and two temperatures, share a mistake.
  for (const ColumnScale& a : column_scales)
    for (const ColumnScale& b : column_scales) {
      const std::string first = a.column, second = b.column;
      const bool motion = first == "rate_dps" && second == "angle_deg" && a.factor > 0.0 && b.factor > 0.0;
      const bool temperatures =
          first == "motor_C" && second == "ambient_C" && a.option == std::string(b.option);
      if ((motion || temperatures) && has(first) && has(second)) table.push_back({{a, b}});
    }
  for (const ColumnPair& one : exchangeable_columns)
    if (has(one.first) && has(one.second)) table.push_back({{}, one});
  return table;
}

}  // namespace thermopower::gap::engine
