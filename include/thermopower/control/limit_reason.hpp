// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <stdint.h>

/// @file limit_reason.hpp
/// Why an actuator got the power it got.

namespace thermopower {

/// The reason behind a power that is less than what was asked for. Numbers are stable, for logs. Below 64 the
/// controller is limiting, which is its job; from 64 up something is wrong (a fault), and the power is the
/// least there is.
/// @ingroup control
enum class LimitReason : uint8_t {
  // A line each, for the reference page.
  // clang-format off
  none = 0,                   ///< The demand was granted.
  safety_temperature = 1,     ///< Eq 4.23: at this rate the limit would be reached within the safety time; the ceiling falls.
  over_temperature = 2,       ///< Above the limit: least power.
  recovering = 3,             ///< Cool again; the ceiling rises but is still below the demand.
  winding_limit = 4,          ///< More would bring the winding to its limit within the horizon.
  body_limit = 5,             ///< More would bring the body (or the only node) to its limit within the horizon.
  node_limit = 6,             ///< More would bring one of several nodes to its limit; the limiter's state says which.

  supply_headroom = 16,       ///< The supply is above the nominal: more POWER would heat more than the motor's table knows.

  no_telemetry_yet = 64,      ///< Nothing valid was ever received.
  link_silent = 65,           ///< No telemetry for longer than the time-out.
  error_not_finite = 66,      ///< The position error is NaN, infinite, or too large to be an angle (a million degrees).
  air_implausible = 67,       ///< No thermometer gives a plausible air temperature.
  supply_low = 68,            ///< The supply is below the lowest voltage at which the actuator may be driven, or negative.
  supply_not_finite = 69,     ///< The supply voltage is NaN or infinite.
  temperature_not_finite = 70,///< The estimated temperature or its rate is NaN or infinite, or it is below absolute zero.
  time_invalid = 71,          ///< The time step is NaN, infinite or negative.
  config_invalid = 72,        ///< `validate()` refused the configuration.
  not_obeyed = 73,            ///< The board has another power in force than it was told, or confirms none.
  supply_implausible = 74,    ///< The supply reads higher than it can be.
  sensor_missing = 75,        ///< The motor has to be measured, and is not.
  sensor_out_of_range = 76,   ///< A thermometer reads what it cannot read where it sits: torn, shorted, or not a number.
  sensor_too_fast = 77,       ///< A thermometer's reading jumps faster than its place can warm or cool.
  sensor_stuck = 78,          ///< A thermometer's reading stands still while heat flows.
  sensor_disagrees = 79,      ///< A thermometer reads colder than the model by more than declared.
  supply_above_nominal = 80,  ///< The supply reads above what was configured by more than the margin: another battery.
  board_overheated = 81,      ///< The board has stopped its motors because something is too hot, or was loaded too long.
  sensors_exchanged = 82,     ///< Two thermometers read each other's temperature.
  time_stands_still = 83,     ///< The time step is 0 in step after step, or in most of them.

  heat_disagrees = 90,        ///< A `ModelMonitor`: less or more heat shows than was put in, by more than the bounds explain.
  thermometer_disagrees = 91, ///< The same, and no constant change of heat, loss or air explains it: the thermometer.
  winding_disagrees = 92,     ///< Voltage and current do not fit the winding's resistance: shorted turns or a loose contact.
  friction_disagrees = 93     ///< The torque does not fit the motion: friction has grown, or the load is gone.
  // clang-format on
};

/// True when the reason is a fault and not the limiter doing its work.
/// @ingroup control
constexpr bool is_fault(LimitReason reason) { return static_cast<uint8_t>(reason) >= 64; }

/// What a limiter returns.
/// @ingroup control
struct LimitedPower {
  uint8_t power;       ///< Granted power parameter; never above the demand.
  LimitReason reason;  ///< Why it is less than the demand; `none` when it is not.
};

/// What is left to an actuator that is cut: the lowest power parameter the controller board takes (0 is not
/// valid, section 4.2). A power law that asks for 0, for an actuator that may be switched off, is granted 0.
/// @ingroup control
constexpr uint8_t least_power() { return 1; }

}  // namespace thermopower
