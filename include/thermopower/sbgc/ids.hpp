// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include <stdint.h>

/// @file
/// @brief Numbers the SimpleBGC protocol gives to commands and to adjustable variables.

namespace thermopower {
namespace sbgc {

/// @brief Command identifiers of the SimpleBGC serial protocol 2.5.
///
/// Unscoped on purpose: they convert to the `uint8_t` of a frame, and an identifier that is not listed here
/// can be used as a plain number. 0 is never valid.
/// @ingroup sbgc
namespace command {
/// @brief One byte of the frame header; see the namespace for the rules.
enum Id : uint8_t {
  read_params_3 = 21,    ///< asks for a profile's parameters, see ReadParams3; answer: 134 bytes, see Params3
  write_params_3 = 22,   ///< keeps a profile's parameters, see Params3
  realtime_data_3 = 23,  ///< request: empty; answer: 63 bytes, see RealtimeData
  realtime_data_4 = 25,  ///< request: empty; answer: 124 bytes, see RealtimeData
  set_adj_vars_val = 31,      ///< sets variables in RAM, see SetAdjVars; also the answer to get_adj_vars_val
  save_params_3 = 32,         ///< writes adjustable variables to the board's EEPROM
  get_angles_ext = 61,        ///< request: empty; answer: 54 bytes, see AnglesExt
  get_adj_vars_val = 64,      ///< asks for variables, see GetAdjVars
  confirm = 67,               ///< board to host: a command was executed, see Confirm
  control = 67,               ///< host to board: move the gimbal, see Control (same number as confirm)
  get_angles = 73,            ///< request: empty; answer: 18 bytes, see Angles
  motors_on = 77,             ///< see MotorsOn
  data_stream_interval = 85,  ///< have the board send data regularly, see DataStreamInterval
  board_info = 86,            ///< see BoardInfo
  realtime_data_custom = 88,  ///< answer made of chosen fields, see RealtimeCustom
  motors_off = 109,           ///< see MotorsOff
  reset = 114,                ///< see Reset
  error = 255                 ///< board to host: a command failed, see Error
};
}  // namespace command

/// @brief Identifiers of adjustable variables; each holds 0..255 and acts until the board restarts.
///
/// Axis order is roll, pitch, yaw: `p_roll + axis` is the gain of an axis, `power_roll + axis` its power.
/// @ingroup sbgc
namespace variable {
/// @brief One byte of SetAdjVars and GetAdjVars; see the namespace.
enum Id : uint8_t {
  p_roll = 0,        ///< proportional gain, roll
  p_pitch = 1,       ///< proportional gain, pitch
  p_yaw = 2,         ///< proportional gain, yaw
  i_roll = 3,        ///< integral gain, roll
  i_pitch = 4,       ///< integral gain, pitch
  i_yaw = 5,         ///< integral gain, yaw
  d_roll = 6,        ///< derivative gain, roll
  d_pitch = 7,       ///< derivative gain, pitch
  d_yaw = 8,         ///< derivative gain, yaw
  power_roll = 9,    ///< motor power, roll: duty = value / 255
  power_pitch = 10,  ///< motor power, pitch
  power_yaw = 11     ///< motor power, yaw
};
}  // namespace variable

}  // namespace sbgc
}  // namespace thermopower
