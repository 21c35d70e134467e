// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace thermopower::design {

/// An input that an experiment may vary.
///
/// How to: @ref design_the_next_experiment.
struct VariedInput {
  std::string column;  ///< as recordings name it: `drive_A`, `power_param`, `target_deg`, ...
  double from = 0.0;   ///< smallest value, in the column's unit
  double to = 0.0;     ///< largest value, above `from`
  /// How fast it may change, in its unit per second, > 0. Infinite: it may jump.
  double slope_per_s = std::numeric_limits<double>::infinity();
  /// It has one value during an experiment: somebody sets it before, such as a motor that starts hot (`motor_C` of an axis).
  bool once = false;

  /// The value at which nothing happens: 0 where the range holds it, else the end that is nearer to 0.
  double at_rest() const {
    assert(from <= to);
    return std::clamp(0.0, from, to);
  }
};

/// A range that a quantity must not leave.
///
/// How to: @ref design_the_next_experiment.
struct Bounds {
  double low = -std::numeric_limits<double>::infinity();  ///< smallest allowed value
  double high = std::numeric_limits<double>::infinity();  ///< largest allowed value

  /// Whether there is a limit at all.
  bool any() const { return std::isfinite(low) || std::isfinite(high); }
};

/// What the next experiment may do: what it varies, and what it must not exceed. Every limit holds for every explanation that is
/// still possible.
///
/// How to: @ref design_the_next_experiment.
struct Limits {
  double duration_s = 0.0;  ///< longest experiment, s, > 0
  double row_s = 0.0;       ///< time between rows of the schedule, s, > 0, at most a tenth of `duration_s`
  std::vector<VariedInput> vary;                     ///< at least one
  std::vector<std::pair<std::string, double>> hold;  ///< inputs that stay as they are: column and value
  std::vector<std::pair<std::string, double>>
      start;             ///< `motor_C`, `angle_deg` and `rate_dps` before the first row
  Bounds angle_deg;      ///< of the axis
  Bounds rate_dps;       ///< of the axis, both signs
  Bounds current_A;      ///< of the motor
  Bounds temperature_C;  ///< of the motor

  /// The value that a column starts from or is held at; `otherwise` where nothing is said.
  static double value_or(const std::vector<std::pair<std::string, double>>& list, std::string_view column,
                         double otherwise) {
    for (const auto& [name, value] : list)
      if (name == column) return value;
    return otherwise;
  }

  /// The shortest experiment that is proposed, s: a diagnosis needs some readings, and holds a part of them out.
  double shortest_s() const {
    constexpr double rows = 150.0;
    return std::min(duration_s, rows * row_s);
  }

  /// The varied input of that name, or nullptr.
  const VariedInput* varied(std::string_view column) const {
    for (const VariedInput& one : vary)
      if (one.column == column) return &one;
    return nullptr;
  }

  /// Inputs that may be varied or held.
  static constexpr std::array<std::string_view, 13> inputs{
      "power_param",  "drive_A",     "voltage_V", "target_deg", "target_dps", "torque_Nm", "heat_W",
      "airspeed_mps", "neighbour_C", "supply_V",  "ambient_C",  "motor_C",    "current_A"};

  /// The first field that is wrong and what was expected, as in `duration_s is -1; expected ...`, or nothing.
  std::optional<std::string> validate() const {
    const auto positive = [](double value) { return value > 0.0 && std::isfinite(value); };
    if (!positive(duration_s)) return wrong("duration_s", duration_s, "a number of seconds above 0");
    if (!positive(row_s)) return wrong("row_s", row_s, "a number of seconds above 0");
    if (row_s > 0.1 * duration_s)
      return wrong("row_s", row_s, "at most a tenth of duration_s, " + text_of(0.1 * duration_s));
    if (duration_s / row_s > 200000.0)
      return wrong("row_s", row_s,
                   "at least " + text_of(duration_s / 200000.0) + ": a schedule has at most 200000 rows");
    if (vary.empty()) return std::string("vary is empty; expected at least one input, such as drive_A");
    if (std::all_of(vary.begin(), vary.end(), [](const VariedInput& one) { return one.once; }))
      return std::string(
          "vary holds nothing that may change during the experiment; expected one input without \"once\"");
    for (const VariedInput& one : vary) {
      const std::string field = "vary." + one.column;
      if (!is_input(one.column)) return field + " is not an input; expected one of " + list_of_inputs();
      if (!(one.from < one.to) || !std::isfinite(one.from) || !std::isfinite(one.to))
        return field + ".from is " + text_of(one.from) + " and .to is " + text_of(one.to) +
               "; expected two numbers, the smaller first";
      if (!(one.slope_per_s > 0.0)) return wrong(field + ".slope_per_s", one.slope_per_s, "a number above 0");
      for (const auto& [column, value] : hold)
        if (column == one.column) return "hold." + column + " is in vary, too; expected one of both";
    }
    for (const auto& [column, value] : hold) {
      if (!is_input(column))
        return "hold." + column + " is not an input; expected one of " + list_of_inputs();
      if (!std::isfinite(value)) return wrong("hold." + column, value, "a number");
    }
    for (const auto& [column, value] : start) {
      if (column != "motor_C" && column != "angle_deg" && column != "rate_dps")
        return "start." + column + " is not known; expected motor_C, angle_deg or rate_dps";
      if (!std::isfinite(value)) return wrong("start." + column, value, "a number");
    }
    const std::pair<const char*, const Bounds*> bounds[] = {{"angle_deg", &angle_deg},
                                                            {"rate_dps", &rate_dps},
                                                            {"current_A", &current_A},
                                                            {"temperature_C", &temperature_C}};
    for (const auto& [name, range] : bounds)
      if (!(range->low < range->high))
        return std::string(name) + " is from " + text_of(range->low) + " to " + text_of(range->high) +
               "; expected the smaller number first";
    return std::nullopt;
  }

  /// A number as sentences have it.
  static std::string text_of(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value);
    return text;
  }

private:
  static bool is_input(std::string_view column) {
    return std::find(inputs.begin(), inputs.end(), column) != inputs.end();
  }
  static std::string list_of_inputs() {
    std::string list;
    for (const std::string_view one : inputs) list += (list.empty() ? "" : ", ") + std::string(one);
    return list;
  }
  static std::string wrong(const std::string& field, double value, const std::string& expected) {
    return field + " is " + text_of(value) + "; expected " + expected;
  }
};

}  // namespace thermopower::design
