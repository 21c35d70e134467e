// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/recording.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

/// @file evidence.hpp
/// The few numbers of a recording that tell a unit, a sign or exchanged columns. Each is measured once; every hypothesis says
/// what it should be.

namespace thermopower::gap::engine {

/// A number that a recording's columns make together, measured by expected: 1 where units and constants are right.
enum class UnitMeasure {
  slope,    ///< the rate by the slope of the angle
  drive,    ///< acceleration for each unit of the command, by the model's
  drag,     ///< the model's effort for each unit of the rate, by the measured one
  torque,   ///< a torque from outside by what it does
  target,   ///< the target by the motion that follows it
  current,  ///< the current by what the circuit draws
  supply,   ///< the supply by the model's nominal one
  heating,  ///< the rate of warming for each watt, by the model's
  cooling,  ///< the rate of cooling for each kelvin, by the model's
};

/// How many there are.
inline constexpr std::size_t unit_measure_count = 9;

/// What a recording says of a measure.
struct Measured {
  double value = missing;      ///< measured by expected, without its sign; NaN: not told
  double sd = 0.1;             ///< standard deviation of its logarithm
  double forwards_nats = 0.0;  ///< log likelihood of a positive sign against a negative one

  /// Whether the recording tells it.
  bool is_told() const { return std::isfinite(value) && value > 0.0; }
};

/// How warm a column's numbers are.
struct TemperatureRange {
  double low = missing;        ///< coldest but for a few samples; NaN: not recorded
  double typical = missing;    ///< median
  double high = missing;       ///< hottest but for a few samples
  bool whole_numbers = false;  ///< all samples are

  /// Whether it was recorded.
  bool is_known() const { return std::isfinite(typical); }
};

/// Everything that a recording, or a run of it, says of units.
struct UnitEvidence {
  std::array<Measured, unit_measure_count> measures;  ///< indexed by UnitMeasure
  TemperatureRange motor;                             ///< of motor_C
  TemperatureRange air;                               ///< of ambient_C
  double air_offset_K =
      missing;  ///< by how much warmer than ambient_C the air is to which the motor cools down; NaN: not told
  double most_power = 0.0;        ///< largest power_param
  double interval_s = missing;    ///< median between rows
  bool is_axis = false;           ///< an axis is judged
  bool is_bench = false;          ///< a body or a circuit is judged
  bool uses_temperature = false;  ///< the model uses the temperatures
  std::string heated_by;  ///< column whose unit the heat depends on: power_param, current_A, drive_A, heat_W
  std::vector<std::string> columns;  ///< that have samples, `t_s` among them
  std::vector<std::pair<std::string, std::string>>
      exchanged;  ///< pairs that fit far better the other way round

  /// The measure of one kind.
  Measured& operator[](UnitMeasure kind) { return measures[static_cast<std::size_t>(kind)]; }
  /// The measure of one kind.
  const Measured& operator[](UnitMeasure kind) const { return measures[static_cast<std::size_t>(kind)]; }
  /// Whether a column has samples.
  bool has(const std::string& column) const {
    for (const std::string& one : columns)
      if (one == column) return true;
    return false;
  }
};

}  // namespace thermopower::gap::engine
