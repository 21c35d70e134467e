// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include <stdint.h>

#include "frame.hpp"
#include "ids.hpp"
#include "units.hpp"

/// @file
/// @brief The answers to GET_ANGLES and GET_ANGLES_EXT: angles alone, in a seventh of the bytes of the telemetry.

namespace thermopower {
namespace sbgc {

/// @brief View of an answer to GET_ANGLES, 18 bytes; valid as long as its frame. Asked for with
/// `Request(command::get_angles)`. Axes are 0 roll, 1 pitch, 2 yaw; a larger axis reads as yaw.
/// Source: SimpleBGC serial protocol specification 2.5, CMD_GET_ANGLES.
///
/// @snippet sbgc_examples.cpp angles
/// How to: @ref wire_up_sbgc.
/// @ingroup sbgc
class Angles {
public:
  /// @brief Bytes of the answer.
  static constexpr uint8_t payload_size() noexcept { return 18; }
  /// @brief Looks at a frame's payload. @return false, with this object unchanged, when it is another or too short.
  bool read(const Frame& frame) noexcept {
    if (frame.id != command::get_angles || frame.size < payload_size()) return false;
    payload_ = frame.payload;
    return true;
  }
  /// @brief Camera angle, 360/16384 degrees.
  int16_t imu_angle(uint8_t axis) const noexcept { return at(axis, 0); }
  /// @brief Angle to be held, 360/16384 degrees.
  int16_t target_angle(uint8_t axis) const noexcept { return at(axis, 2); }
  /// @brief Speed that the target moves with, 0.1220740379 deg/s.
  int16_t target_speed(uint8_t axis) const noexcept { return at(axis, 4); }
  /// @brief Camera angle in degrees, -720..720.
  float imu_angle_deg(uint8_t axis) const noexcept { return angle_deg(imu_angle(axis)); }
  /// @brief Angle to be held, in degrees, -720..720.
  float target_angle_deg(uint8_t axis) const noexcept { return angle_deg(target_angle(axis)); }
  /// @brief Target minus camera angle in degrees. Not wrapped to one turn.
  float error_deg(uint8_t axis) const noexcept {
    return angle_deg(static_cast<int32_t>(target_angle(axis)) - static_cast<int32_t>(imu_angle(axis)));
  }

private:
  int16_t at(uint8_t axis, uint8_t offset) const noexcept {
    return read_i16(payload_ + 6 * (axis > 2 ? 2 : axis) + offset);
  }
  const uint8_t* payload_ = nullptr;
};

/// @brief View of an answer to GET_ANGLES_EXT, 54 bytes; valid as long as its frame. Asked for with
/// `Request(command::get_angles_ext)`. Axes as in Angles.
/// Source: SimpleBGC serial protocol specification 2.5, CMD_GET_ANGLES_EXT.
///
/// @snippet sbgc_examples.cpp angles
/// How to: @ref wire_up_sbgc.
/// @ingroup sbgc
class AnglesExt {
public:
  /// @brief Bytes of the answer.
  static constexpr uint8_t payload_size() noexcept { return 54; }
  /// @brief Looks at a frame's payload. @return false, with this object unchanged, when it is another or too short.
  bool read(const Frame& frame) noexcept {
    if (frame.id != command::get_angles_ext || frame.size < payload_size()) return false;
    payload_ = frame.payload;
    return true;
  }
  /// @brief Camera angle, 360/16384 degrees.
  int16_t imu_angle(uint8_t axis) const noexcept { return read_i16(start(axis)); }
  /// @brief Angle to be held, 360/16384 degrees.
  int16_t target_angle(uint8_t axis) const noexcept { return read_i16(start(axis) + 2); }
  /// @brief Angle between camera and frame by the encoders, 360/16384 degrees, any number of turns.
  int32_t frame_cam_angle(uint8_t axis) const noexcept { return read_i32(start(axis) + 4); }
  /// @brief Target minus camera angle in degrees. Not wrapped to one turn.
  float error_deg(uint8_t axis) const noexcept {
    return angle_deg(static_cast<int32_t>(target_angle(axis)) - static_cast<int32_t>(imu_angle(axis)));
  }

private:
  const uint8_t* start(uint8_t axis) const noexcept { return payload_ + 18 * (axis > 2 ? 2 : axis); }
  const uint8_t* payload_ = nullptr;
};

}  // namespace sbgc
}  // namespace thermopower
