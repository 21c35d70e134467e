// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <string>

/// @file scales.hpp
/// The units that loggers write where others are expected. A factor that is not in these lists is not a unit.

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
    {"rate_dps", "rad/s", "in radians per second where degrees per second are expected",
     1.0 / 57.29577951308232},
    {"rate_dps", "rpm", "in turns per minute where degrees per second are expected", 1.0 / 6.0},
    {"rate_dps", "rev/s", "in turns per second where degrees per second are expected", 1.0 / 360.0},
    {"rate_dps", "-deg/s", "has the wrong sign against the command and angle_deg", -1.0},
    {"angle_deg", "rad", "in radians where degrees are expected", 1.0 / 57.29577951308232},
    {"angle_deg", "rev", "in turns where degrees are expected", 1.0 / 360.0},
    {"angle_deg", "-deg", "has the wrong sign: it falls where rate_dps says that the axis turns forwards",
     -1.0},
    {"drive_A", "mA", "in milliamperes where amperes are expected", 1e3},
    {"drive_A", "uA", "in microamperes where amperes are expected", 1e6},
    {"drive_A", "-A", "has the wrong sign: it accelerates the axis backwards", -1.0},
    {"voltage_V", "mV", "in millivolts where volts are expected", 1e3},
    {"voltage_V", "-V", "has the wrong sign: it accelerates the axis backwards", -1.0},
    {"target_deg", "rad", "in radians where degrees are expected", 1.0 / 57.29577951308232},
    {"target_deg", "-deg", "has the wrong sign: the axis moves the other way", -1.0},
    {"target_dps", "rad/s", "in radians per second where degrees per second are expected",
     1.0 / 57.29577951308232},
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

/// Two columns that a log may have exchanged.
struct ColumnPair {
  const char* first;   ///< one column
  const char* second;  ///< the other one
};

/// The pairs that are looked for.
inline constexpr ColumnPair exchangeable_columns[] = {
    {"angle_deg", "rate_dps"},    {"drive_A", "angle_deg"},   {"drive_A", "rate_dps"},
    {"voltage_V", "angle_deg"},   {"voltage_V", "rate_dps"},  {"motor_C", "ambient_C"},
    {"power_param", "current_A"}, {"power_param", "motor_C"}, {"current_A", "motor_C"},
    {"current_A", "supply_V"},    {"motor_C", "supply_V"}};

/// Option of the program that states a column's unit.
inline std::string column_option(const std::string& column, const std::string& unit) {
  return "--column " + column + "=" + column + ":" + unit;
}

/// Options of the program that exchange two columns.
inline std::string exchange_option(const std::string& a, const std::string& b) {
  return "--column " + a + "=" + b + " --column " + b + "=" + a;
}

}  // namespace thermopower::gap::engine
