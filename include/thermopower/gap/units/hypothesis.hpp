// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/finding.hpp>
#include <thermopower/gap/units/evidence.hpp>
#include <thermopower/gap/units/scales.hpp>

#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

/// @file hypothesis.hpp
/// The table of hypotheses: which column is in which unit, has its sign turned round, or stands in another one's place.

namespace thermopower::gap::engine {

/// One line of the table. The first one changes nothing.
struct UnitHypothesis {
  std::vector<ColumnScale> scales;                  ///< of the columns that are not as expected
  std::pair<std::string, std::string> exchanged{};  ///< two columns; empty: none

  /// Whether everything is as expected.
  bool is_none() const { return scales.empty() && exchanged.first.empty(); }
  /// Whether it turns a sign round.
  bool turns_sign() const {
    for (const ColumnScale& one : scales)
      if (one.factor < 0.0) return true;
    return false;
  }
  /// Whether a recording has all of its columns.
  bool applies_to(const UnitEvidence& of) const {
    for (const ColumnScale& one : scales)
      if (!of.has(one.column)) return false;
    return exchanged.first.empty() || (of.has(exchanged.first) && of.has(exchanged.second));
  }
  /// The column that a finding names first.
  std::string column() const { return scales.empty() ? exchanged.first : scales.front().column; }
  /// Options of the program that mend it.
  std::string mend() const {
    if (scales.empty()) return exchange_option(exchanged.first, exchanged.second);
    std::string options;
    for (const ColumnScale& one : scales)
      options += (options.empty() ? "" : " ") + column_option(one.column, one.option);
    return options;
  }
  /// What it is a case of.
  FindingKind kind() const {
    return scales.empty()                ? FindingKind::swapped_columns
           : scales.front().factor < 0.0 ? FindingKind::wrong_sign
                                         : FindingKind::wrong_unit;
  }
  /// What is wrong, after the column's name.
  std::string words() const {
    if (scales.empty()) return "and " + exchanged.second + " are exchanged";
    std::string text;
    for (const ColumnScale& one : scales) {
      const std::string is = std::string(one.words).compare(0, 4, "has ") == 0 ? "" : "is ";
      text += (text.empty() ? "" : std::string(", and ") + one.column + " ") + is + one.words;
    }
    return text;
  }
  /// The factor of a column's numbers, with its sign.
  double factor(const std::string& column) const {
    for (const ColumnScale& one : scales)
      if (column == one.column) return one.factor;
    return 1.0;
  }
  /// Degrees Celsius of a recorded temperature.
  double celsius(const std::string& column, double recorded) const {
    for (const ColumnScale& one : scales)
      if (column == one.column) return (recorded - one.offset) / one.factor;
    return recorded;
  }
  /// Recorded number of a temperature in degrees Celsius.
  double recorded(const std::string& column, double celsius_C) const {
    for (const ColumnScale& one : scales)
      if (column == one.column) return one.factor * celsius_C + one.offset;
    return celsius_C;
  }
  /// Whether a column is in degrees Fahrenheit.
  bool is_fahrenheit(const std::string& column) const { return factor(column) == 1.8; }

  /// What each measure of a recording should be, with its sign.
  std::array<double, unit_measure_count> expected(const UnitEvidence& of) const {
    const double rate = factor("rate_dps"), angle = factor("angle_deg"), time = factor("t_s"),
                 command = factor("drive_A") * factor("voltage_V"), motor = factor("motor_C");
    const double duty = 1.0 / std::sqrt(factor("power_param")), supply = factor("supply_V");
    const bool has_rate = of.has("rate_dps");
    const double motion = has_rate ? rate : angle / time;  // of a speed
    double heat = factor("heat_W");
    if (of.heated_by == "current_A") heat = factor("current_A") * factor("current_A");
    if (of.heated_by == "drive_A") heat = factor("drive_A") * factor("drive_A");
    if (of.heated_by == "power_param") heat = supply * supply / (duty * duty);
    std::array<double, unit_measure_count> value{};
    const auto at = [&](UnitMeasure kind) -> double& { return value[static_cast<std::size_t>(kind)]; };
    at(UnitMeasure::slope) = rate * time / angle;
    at(UnitMeasure::drive) = motion / (time * command);
    at(UnitMeasure::drag) = motion / command;
    at(UnitMeasure::torque) = factor("torque_Nm") / command;
    at(UnitMeasure::target) = factor("target_deg") * factor("target_dps");
    at(UnitMeasure::current) = factor("current_A") * duty / supply;
    at(UnitMeasure::supply) = supply;
    at(UnitMeasure::heating) = motor / (time * heat);
    at(UnitMeasure::cooling) = 1.0 / time;
    return value;
  }
};

/// The table for a recording with these columns.
/// @param has  (const std::string& column) -> whether it was recorded
template <class Has>
std::vector<UnitHypothesis> unit_hypotheses(const Has& has) {
  std::vector<UnitHypothesis> table{UnitHypothesis()};
  for (const ColumnScale& one : column_scales)
    if (has(one.column)) table.push_back({{one}});
  for (const ColumnScale& a : column_scales)
    for (const ColumnScale& b : column_scales) {
      if (!has(a.column) || !has(b.column)) continue;
      const auto are = [&](const char* first, const char* second) {
        return a.column == std::string(first) && b.column == std::string(second);
      };
      const bool motion = are("rate_dps", "angle_deg") && a.factor > 0.0 && b.factor > 0.0;
      const bool temperatures = are("motor_C", "ambient_C") && a.option == std::string(b.option);
      if (motion || temperatures) table.push_back({{a, b}});
    }
  for (const ColumnPair& one : exchangeable_columns)
    if (has(one.first) && has(one.second)) table.push_back({{}, {one.first, one.second}});
  return table;
}

}  // namespace thermopower::gap::engine
