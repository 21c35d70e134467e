// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include <stdint.h>

/// @file
/// @brief The errors that a board reports in its telemetry: RealtimeData::system_error() and system_sub_error().

namespace thermopower {
namespace sbgc {

/// @brief Bits of RealtimeData::system_error().
/// @ingroup sbgc
namespace system_error {
/// @brief One bit each; see the namespace.
enum Bit : uint16_t {
  no_sensor = 1u << 0,        ///< an IMU does not answer
  calibrate_acc = 1u << 1,    ///< the accelerometer is not calibrated
  set_power = 1u << 2,        ///< POWER is not set
  calibrate_poles = 1u << 3,  ///< the poles are not calibrated
  protection = 1u << 4,       ///< a protection acts
  serial = 1u << 5,           ///< the serial line has errors
  low_battery = 1u << 6,      ///< the battery is below its alarm
  empty_battery = 1u << 7,    ///< the battery is below what the motors may run on
  gui_version = 1u << 8,      ///< the configuration program has another version
  missed_steps = 1u << 9,     ///< a motor has slipped
  system = 1u << 10,          ///< the board's program
  emergency_stop = 1u << 11   ///< the motors are off; RealtimeData::system_sub_error() says why
};
}  // namespace system_error

/// @brief Values of RealtimeData::system_sub_error() that are about heat and current; others are plain numbers.
/// @ingroup sbgc
namespace sub_error {
/// @brief See the namespace.
enum Code : uint8_t {
  driver_hot = 2,           ///< a motor driver is too hot
  driver_fault = 3,         ///< a motor driver reports low voltage, too much current or a short circuit
  board_hot = 8,            ///< the controller or its power stage is too hot
  motor_hot = 13,           ///< the board's own protection of the motors has acted
  loaded_too_long = 18,     ///< the motors were fully loaded for too long
  can_driver_current = 19,  ///< a driver on the CAN bus has a short circuit
  can_driver_hot = 23,      ///< a driver on the CAN bus is too hot
  can_motor_hot = 24,       ///< the motor of a driver on the CAN bus is too hot
  can_motor_current = 25,   ///< the motor of a driver on the CAN bus takes too much current
  over_current = 32         ///< the board has too much current or a short circuit
};
}  // namespace sub_error

/// @brief Whether a board has stopped its motors because something is too hot, or was loaded for too long.
/// @ingroup sbgc
inline bool is_overheated(uint16_t errors, uint8_t detail) noexcept {
  if ((errors & system_error::emergency_stop) == 0) return false;
  return detail == sub_error::driver_hot || detail == sub_error::board_hot ||
         detail == sub_error::motor_hot || detail == sub_error::loaded_too_long ||
         detail == sub_error::can_driver_hot || detail == sub_error::can_motor_hot;
}

}  // namespace sbgc
}  // namespace thermopower
