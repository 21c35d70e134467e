// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/signal.hpp>

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

/// Columns with a value each.
using ColumnValues = std::vector<std::pair<std::string, double>>;

/// What the next experiment may do: what it varies, and what it must not exceed. Every limit holds for every explanation that is
/// still possible.
///
/// How to: @ref design_the_next_experiment.
struct Limits {
  double duration_s = 0.0;  ///< longest experiment, s, > 0
  double row_s = 0.0;       ///< time between rows of the schedule, s, > 0, at most a tenth of `duration_s`
  std::vector<VariedInput> vary;  ///< at least one
  ColumnValues hold;              ///< inputs that stay as they are
  ColumnValues start;             ///< `motor_C`, `angle_deg` and `rate_dps` before the first row
  Bounds angle_deg;               ///< of the axis
  Bounds rate_dps;                ///< of the axis, both signs
  Bounds current_A;               ///< of the motor
  Bounds temperature_C;           ///< of the motor

  /// A limit of a simulated signal.
  struct Bounded {
    const char* field;       ///< its name
    plant::Signal signal;    ///< that is limited
    Bounds Limits::*bounds;  ///< where the limit is
  };
  /// Every limit of a simulated signal.
  static constexpr std::array<Bounded, 4> bounded();

  /// The value that a column starts from or is held at; `otherwise` where nothing is said.
  static double value_or(const ColumnValues& list, std::string_view column, double otherwise) {
    for (const auto& [name, value] : list)
      if (name == column) return value;
    return otherwise;
  }

  /// The shortest experiment that is proposed, s: a diagnosis needs some readings, holds a part of them out, and asks how far their
  /// prediction reaches.
  double shortest_s() const {
    constexpr double rows = 150.0, of_the_longest = 0.25;
    return std::min(duration_s, std::max(rows * row_s, of_the_longest * duration_s));
  }

  /// The varied input of that name, or nullptr.
  const VariedInput* varied(std::string_view column) const {
    for (const VariedInput& one : vary)
      if (one.column == column) return &one;
    return nullptr;
  }

  /// Whether an input of that name is varied or held.
  bool gives(std::string_view column) const {
    return varied(column) != nullptr || !std::isnan(value_or(hold, column, std::nan("")));
  }

  /// Inputs that may be varied or held.
  static constexpr std::array<std::string_view, 13> inputs{
      "power_param",  "drive_A",     "voltage_V", "target_deg", "target_dps", "torque_Nm", "heat_W",
      "airspeed_mps", "neighbour_C", "supply_V",  "ambient_C",  "motor_C",    "current_A"};

  /// The first field that is wrong and what was expected, as in `duration_s is -1; expected ...`, or nothing.
  std::optional<std::string> validate() const;

  /// A number as sentences have it.
  static std::string text_of(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value);
    return text;
  }
};

constexpr std::array<Limits::Bounded, 4> Limits::bounded() {
  return {{{"angle_deg", plant::Signal::angle_deg, &Limits::angle_deg},
           {"rate_dps", plant::Signal::rate_dps, &Limits::rate_dps},
           {"current_A", plant::Signal::current_A, &Limits::current_A},
           {"temperature_C", plant::Signal::motor_C, &Limits::temperature_C}}};
}

inline std::optional<std::string> Limits::validate() const {
  const auto wrong = [](const std::string& field, double value, const std::string& expected) {
    return field + " is " + text_of(value) + "; expected " + expected;
  };
  const auto not_an_input = [](const std::string& field, std::string_view column) {
    if (std::find(inputs.begin(), inputs.end(), column) != inputs.end()) return std::string();
    std::string list;
    for (const std::string_view one : inputs) list += (list.empty() ? "" : ", ") + std::string(one);
    return field + " is not an input; expected one of " + list;
  };
  constexpr double most_rows = 200000.0;
  for (const auto& [field, value] : {std::pair{"duration_s", duration_s}, {"row_s", row_s}})
    if (!(value > 0.0) || !std::isfinite(value)) return wrong(field, value, "a number of seconds above 0");
  if (row_s > 0.1 * duration_s)
    return wrong("row_s", row_s, "at most a tenth of duration_s, " + text_of(0.1 * duration_s));
  if (duration_s / row_s > most_rows)
    return wrong("row_s", row_s,
                 "at least " + text_of(duration_s / most_rows) + ": a schedule has at most 200000 rows");
  if (vary.empty()) return "vary is empty; expected at least one input, such as drive_A";
  if (std::all_of(vary.begin(), vary.end(), [](const VariedInput& one) { return one.once; }))
    return "vary holds nothing that may change during the experiment; expected one input without \"once\"";
  for (const VariedInput& one : vary) {
    const std::string field = "vary." + one.column;
    if (const std::string problem = not_an_input(field, one.column); !problem.empty()) return problem;
    if (!(one.from < one.to) || !std::isfinite(one.from) || !std::isfinite(one.to))
      return field + ".from is " + text_of(one.from) + " and .to is " + text_of(one.to) +
             "; expected two numbers, the smaller first";
    if (!(one.slope_per_s > 0.0)) return wrong(field + ".slope_per_s", one.slope_per_s, "a number above 0");
  }
  for (const auto& [column, value] : hold) {
    if (varied(column) != nullptr) return "hold." + column + " is in vary, too; expected one of both";
    if (const std::string problem = not_an_input("hold." + column, column); !problem.empty()) return problem;
    if (!std::isfinite(value)) return wrong("hold." + column, value, "a number");
  }
  for (const auto& [column, value] : start) {
    if (column != "motor_C" && column != "angle_deg" && column != "rate_dps")
      return "start." + column + " is not known; expected motor_C, angle_deg or rate_dps";
    if (!std::isfinite(value)) return wrong("start." + column, value, "a number");
  }
  for (const Bounded& one : bounded())
    if (const Bounds& range = this->*one.bounds; !(range.low < range.high))
      return std::string(one.field) + " is from " + text_of(range.low) + " to " + text_of(range.high) +
             "; expected the smaller number first";
  return std::nullopt;
}

/// Limits of which one is raised.
struct RaisedLimit {
  Limits limits;      ///< with the one that is raised
  std::string field;  ///< of the limits
  double to = 0.0;    ///< its new value
};

/// Each limit raised by one and a half, two and four, the smallest raise first. An input that never comes to rest may come nearer to it.
inline std::vector<RaisedLimit> raised_limits(const Limits& limits) {
  std::vector<RaisedLimit> all;
  const auto add = [&](const std::string& field, double to, const auto& change) {
    RaisedLimit raised{limits, field, to};
    change(raised.limits);
    if (!raised.limits.validate()) all.push_back(std::move(raised));
  };
  for (const double factor : {1.5, 2.0, 4.0}) {
    const double longer_s = factor * limits.duration_s;
    add("duration_s", longer_s, [&](Limits& one) { one.duration_s = longer_s; });
    for (std::size_t i = 0; i < limits.vary.size(); ++i) {
      const VariedInput& input = limits.vary[i];
      const double to =
                       input.column == "power_param" ? std::min(factor * input.to, 255.0) : factor * input.to,
                   from = std::max(0.0, input.to - factor * (input.to - input.from));
      if (to > input.to)
        add("vary." + input.column + ".to", to, [&](Limits& one) {
          one.vary[i].to = to;
          if (input.from < 0.0) one.vary[i].from = factor * input.from;
        });
      if (input.from > 0.0)
        add("vary." + input.column + ".from", from, [&](Limits& one) { one.vary[i].from = from; });
    }
    for (const Limits::Bounded& bounded : Limits::bounded()) {
      const Bounds& old = limits.*bounded.bounds;
      if (!old.any()) continue;
      const double ambient_C = Limits::value_or(limits.hold, "ambient_C", 25.0);
      const bool is_thermal = bounded.signal == plant::Signal::motor_C;
      const double rest =
          Limits::value_or(limits.start, to_string(bounded.signal), is_thermal ? ambient_C : 0.0);
      const Bounds wider{rest - factor * (rest - old.low), rest + factor * (old.high - rest)};
      add(bounded.field, std::isfinite(wider.high) ? wider.high : wider.low,
          [&](Limits& one) { one.*bounded.bounds = wider; });
    }
  }
  return all;
}

}  // namespace thermopower::design
