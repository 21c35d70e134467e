// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include <stdint.h>

#include "frame.hpp"
#include "ids.hpp"
#include "units.hpp"
#include "writer.hpp"

/// @file
/// @brief CONTROL: where the gimbal shall move.

namespace thermopower {
namespace sbgc {

/// @brief How CONTROL moves an axis: the lower 4 bits of AxisControl::mode.
/// @ingroup sbgc
namespace control_mode {
/// @brief See the namespace.
enum Mode : uint8_t {
  none = 0,            ///< leave the axis alone
  speed = 1,           ///< turn at `speed`
  angle = 2,           ///< go to `angle`, no faster than `speed`
  speed_angle = 3,     ///< turn at `speed` and keep to `angle`
  remote_control = 4,  ///< `angle` is a remote control signal, -500..500
  angle_rel_frame = 5  ///< as angle, relative to the frame
};
}  // namespace control_mode

/// @brief What one axis shall do.
/// @ingroup sbgc
struct AxisControl {
  uint8_t mode = control_mode::none;  ///< control_mode::Mode; bits 4 to 7 are flags
  int16_t speed = 0;                  ///< 0.1220740379 deg/s, see speed_units()
  int16_t angle = 0;                  ///< 360/16384 degrees, see angle_units()
};

/// @brief Moves the gimbal. The board does not answer unless it was configured to.
///
/// Firmware 2.55b5 and later takes a mode for each axis (15 bytes); older firmware one mode for all (13
/// bytes). Source: SimpleBGC serial protocol specification 2.5, CMD_CONTROL.
///
/// @snippet sbgc_examples.cpp control
/// How to: @ref wire_up_sbgc.
/// @ingroup sbgc
struct Control {
  AxisControl axis[3];    ///< roll, pitch, yaw
  bool one_mode = false;  ///< use the older form: the mode of roll goes for all axes

  /// @brief Reads a frame of either form. @return false, with nothing changed, when it is none.
  bool read(const Frame& frame) noexcept {
    if (frame.id != command::control || (frame.size != 13 && frame.size != 15)) return false;
    one_mode = frame.size == 13;
    const uint8_t* values = frame.payload + (one_mode ? 1 : 3);
    for (uint8_t i = 0; i < 3; ++i) {
      axis[i].mode = frame.payload[one_mode ? 0 : i];
      axis[i].speed = read_i16(values + 4 * i);
      axis[i].angle = read_i16(values + 4 * i + 2);
    }
    return true;
  }
  /// @brief CONTROL.
  static constexpr uint8_t id() noexcept { return command::control; }
  /// @brief 15, or 13 with one mode.
  uint8_t payload_size() const noexcept { return one_mode ? 13 : 15; }
  /// @brief Writes the payload.
  template <class Sink>
  void write_payload(Sink& sink) const {
    for (uint8_t i = 0; i < (one_mode ? 1 : 3); ++i) sink.put(axis[i].mode);
    for (uint8_t i = 0; i < 3; ++i) {
      put_i16(sink, axis[i].speed);
      put_i16(sink, axis[i].angle);
    }
  }
};

}  // namespace sbgc
}  // namespace thermopower
