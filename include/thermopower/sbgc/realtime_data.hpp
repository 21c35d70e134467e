// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include <math.h>
#include <stdint.h>

#include "board_errors.hpp"
#include "frame.hpp"
#include "ids.hpp"
#include "units.hpp"
#include "writer.hpp"

/// @file
/// @brief The board's telemetry, REALTIME_DATA_3 and REALTIME_DATA_4.

namespace thermopower {
namespace sbgc {

/// @brief Telemetry of the board: a view of a REALTIME_DATA_3 or REALTIME_DATA_4 payload, decoded as it is
/// asked.
///
/// Valid as long as the frame it came from. Axes are 0 roll, 1 pitch, 2 yaw; a larger axis reads as yaw.
/// Fields may be asked for after a read() that gave true (a null pointer is what they would be read from
/// before).
///
/// Only REALTIME_DATA_4 has the extension (has_extended()): rotor angles, balance errors, current,
/// magnetometer and temperatures. Without it the temperatures are -128 degC and the current in amperes is
/// NaN, so that a value that was never sent reads as implausible and not as a mild 0; the other extended
/// fields read 0.
///
/// Source: SimpleBGC serial protocol specification 2.5, CMD_REALTIME_DATA_3 and CMD_REALTIME_DATA_4.
///
/// @snippet sbgc_examples.cpp telemetry
/// How to: @ref wire_up_sbgc.
/// @ingroup sbgc
class RealtimeData {
public:
  /// @brief Payload sizes in bytes.
  enum Size : uint8_t {
    basic_size = 63,     ///< REALTIME_DATA_3
    extended_size = 124  ///< REALTIME_DATA_4
  };

  /// @brief Looks at a frame's payload.
  /// @return false, with this object unchanged, unless the frame is one of the two and has at least all their
  /// bytes. Bytes that a newer firmware adds at the end are ignored.
  bool read(const Frame& frame) noexcept {
    const bool extended = frame.id == command::realtime_data_4;
    if (!extended && frame.id != command::realtime_data_3) return false;
    if (frame.size < (extended ? extended_size : basic_size)) return false;
    payload_ = frame.payload;
    extended_ = extended;
    return true;
  }

  /// @brief True for REALTIME_DATA_4.
  bool has_extended() const noexcept { return extended_; }

  /// @brief Target minus camera angle in degrees: the angle the motor has to close. Not wrapped to one turn.
  float error_deg(uint8_t axis) const noexcept { return angle_deg(error_units(axis)); }
  /// @brief Target minus camera angle in units of 360/16384 degrees, -65535..65535.
  int32_t error_units(uint8_t axis) const noexcept {
    return static_cast<int32_t>(target_angle(axis)) - static_cast<int32_t>(imu_angle(axis));
  }
  /// @brief Camera angle in degrees, -720..720.
  float imu_angle_deg(uint8_t axis) const noexcept { return angle_deg(imu_angle(axis)); }
  /// @brief Angle of the frame IMU in degrees, -720..720.
  float frame_imu_angle_deg(uint8_t axis) const noexcept { return angle_deg(frame_imu_angle(axis)); }
  /// @brief Angle to be held, in degrees, -720..720.
  float target_angle_deg(uint8_t axis) const noexcept { return angle_deg(target_angle(axis)); }
  /// @brief Battery voltage in volts.
  float battery_V() const noexcept { return static_cast<float>(battery_cV()) * 0.01f; }
  /// @brief Has the board stopped its motors because something is too hot? is_overheated().
  bool is_overheated() const noexcept { return sbgc::is_overheated(system_error(), system_sub_error()); }
  /// @brief Are the motors powered? Bit 0 of flags().
  bool motors_on() const noexcept { return (flags() & 1) != 0; }
  /// @brief Temperature of the camera IMU in degC; extended, else -128.
  int8_t imu_C() const noexcept { return extended_ ? static_cast<int8_t>(payload_[84]) : int8_t(-128); }
  /// @brief Temperature of the frame IMU in degC; extended, else -128.
  int8_t frame_imu_C() const noexcept { return extended_ ? static_cast<int8_t>(payload_[85]) : int8_t(-128); }
  /// @brief Current drawn from the supply in amperes; extended, else NaN.
  float current_A() const noexcept {
    return extended_ ? static_cast<float>(current_mA()) * 0.001f : static_cast<float>(NAN);
  }

  /// @name The fields as sent
  /// @{

  /// @brief Accelerometer, 1/512 g.
  int16_t acc(uint8_t axis) const noexcept { return i16(0, four_times(axis)); }
  /// @brief Gyroscope, 0.06103701895 deg/s.
  int16_t gyro(uint8_t axis) const noexcept { return i16(2, four_times(axis)); }
  /// @brief Serial errors the board has counted.
  uint16_t serial_errors() const noexcept { return read_u16(payload_ + 12); }
  /// @brief System error flags of the board.
  uint16_t system_error() const noexcept { return read_u16(payload_ + 14); }
  /// @brief Detail of system_error().
  uint8_t system_sub_error() const noexcept { return payload_[16]; }
  /// @brief Remote control input: 0 roll, 1 pitch, 2 yaw, 3 command, 4 and 5 external controller; larger
  /// reads 5.
  int16_t rc(uint8_t channel) const noexcept { return i16(20, twice(channel, 5)); }
  /// @brief Camera angle, 360/16384 degrees.
  int16_t imu_angle(uint8_t axis) const noexcept { return i16(32, twice(axis, 2)); }
  /// @brief Angle of the frame IMU, 360/16384 degrees.
  int16_t frame_imu_angle(uint8_t axis) const noexcept { return i16(38, twice(axis, 2)); }
  /// @brief Angle to be held, 360/16384 degrees.
  int16_t target_angle(uint8_t axis) const noexcept { return i16(44, twice(axis, 2)); }
  /// @brief Duration of the board's control cycle, microseconds.
  uint16_t cycle_time_us() const noexcept { return read_u16(payload_ + 50); }
  /// @brief I2C errors the board has counted.
  uint16_t i2c_errors() const noexcept { return read_u16(payload_ + 52); }
  /// @brief Battery voltage, 0.01 V.
  uint16_t battery_cV() const noexcept { return read_u16(payload_ + 55); }
  /// @brief State flags; bit 0: motors are on.
  uint8_t flags() const noexcept { return payload_[57]; }
  /// @brief Which IMU the angles of the calibration commands refer to.
  uint8_t imu() const noexcept { return payload_[58]; }
  /// @brief Profile in use, 0..4.
  uint8_t profile() const noexcept { return payload_[59]; }
  /// @brief Motor power now, 0..255.
  uint8_t motor_power(uint8_t axis) const noexcept { return payload_[60 + (axis > 2 ? 2 : axis)]; }
  /// @brief Extended: angle of the rotor, 360/16384 degrees.
  int16_t rotor_angle(uint8_t axis) const noexcept {
    return extended_ ? i16(63, twice(axis, 2)) : int16_t(0);
  }
  /// @brief Extended: error of balance, -512..512 for the whole power of the motor.
  int16_t balance_error(uint8_t axis) const noexcept {
    return extended_ ? i16(70, twice(axis, 2)) : int16_t(0);
  }
  /// @brief Extended: current drawn from the supply, mA.
  uint16_t current_mA() const noexcept { return extended_ ? read_u16(payload_ + 76) : uint16_t(0); }
  /// @brief Extended: magnetometer, in its own units.
  int16_t magnetometer(uint8_t axis) const noexcept {
    return extended_ ? i16(78, twice(axis, 2)) : int16_t(0);
  }
  /// @brief All bytes, for fields that have no name here.
  Bytes payload() const noexcept { return Bytes{payload_, payload_size()}; }
  /// @}

  /// @name To send it on
  /// @{

  /// @brief REALTIME_DATA_3 or REALTIME_DATA_4.
  uint8_t id() const noexcept { return extended_ ? command::realtime_data_4 : command::realtime_data_3; }
  /// @brief 63 or 124.
  uint8_t payload_size() const noexcept { return extended_ ? extended_size : basic_size; }
  /// @brief Writes the payload.
  template <class Sink>
  void write_payload(Sink& sink) const {
    put_bytes(sink, payload_, payload_size());
  }
  /// @}

private:
  static uint8_t twice(uint8_t index, uint8_t last) noexcept {
    return static_cast<uint8_t>(2 * (index > last ? last : index));
  }
  static uint8_t four_times(uint8_t axis) noexcept { return static_cast<uint8_t>(2 * twice(axis, 2)); }
  int16_t i16(uint8_t offset, uint8_t more) const noexcept { return read_i16(payload_ + offset + more); }

  const uint8_t* payload_ = nullptr;
  bool extended_ = false;
};

}  // namespace sbgc
}  // namespace thermopower
