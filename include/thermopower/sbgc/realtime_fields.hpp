// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include <stdint.h>

#include "realtime_data.hpp"

/// @file
/// @brief Telemetry to be sent: for emulated boards and for tests.

namespace thermopower {
namespace sbgc {

/// @brief The fields of REALTIME_DATA_3 and REALTIME_DATA_4 as plain numbers, to be filled in and sent.
///
/// RealtimeData reads them without a copy; this is the other direction, or a copy to keep (124 bytes and a
/// little). Units are those of RealtimeData's fields as sent; everything starts at 0. Bytes the protocol
/// reserves are kept too, so that reading a payload and sending it gives the same bytes.
///
/// @snippet sbgc_examples.cpp emulated
/// How to: @ref wire_up_sbgc.
/// @ingroup sbgc
struct RealtimeFields {
  bool extended = true;        ///< send as REALTIME_DATA_4 (else as _3, without the fields from rotor_angle)
  int16_t acc[3] = {};         ///< 1/512 g
  int16_t gyro[3] = {};        ///< 0.06103701895 deg/s
  uint16_t serial_errors = 0;  ///< count
  uint16_t system_error = 0;   ///< flags
  uint8_t system_sub_error = 0;     ///< code
  uint8_t reserved_17[3] = {};      ///< offsets 17 to 19
  int16_t rc[6] = {};               ///< roll, pitch, yaw, command, external roll and pitch
  int16_t imu_angle[3] = {};        ///< 360/16384 degrees
  int16_t frame_imu_angle[3] = {};  ///< 360/16384 degrees
  int16_t target_angle[3] = {};     ///< 360/16384 degrees
  uint16_t cycle_time_us = 0;       ///< microseconds
  uint16_t i2c_errors = 0;          ///< count
  uint8_t reserved_54 = 0;          ///< offset 54
  uint16_t battery_cV = 0;          ///< 0.01 V
  uint8_t flags = 0;                ///< bit 0: motors are on
  uint8_t imu = 0;                  ///< selected IMU
  uint8_t profile = 0;              ///< profile in use
  uint8_t motor_power[3] = {};      ///< 0..255
  int16_t rotor_angle[3] = {};      ///< 360/16384 degrees
  uint8_t reserved_69 = 0;          ///< offset 69
  int16_t balance_error[3] = {};    ///< -512..512
  uint16_t current_mA = 0;          ///< mA
  int16_t magnetometer[3] = {};     ///< sensor units
  int8_t imu_C = 0;                 ///< degC
  int8_t frame_imu_C = 0;           ///< degC
  uint8_t later[38] = {};           ///< offsets 86 to 123: fields of later firmware

  /// @brief Copies all fields of a payload.
  /// @return false, with nothing changed, when the frame is not telemetry; see RealtimeData::read().
  bool read(const Frame& frame) noexcept {
    RealtimeData data;
    if (!data.read(frame)) return false;
    const uint8_t* bytes = data.payload().data;
    extended = data.has_extended();
    for (uint8_t i = 0; i < 3; ++i) {
      acc[i] = data.acc(i);
      gyro[i] = data.gyro(i);
      reserved_17[i] = bytes[17 + i];
      imu_angle[i] = data.imu_angle(i);
      frame_imu_angle[i] = data.frame_imu_angle(i);
      target_angle[i] = data.target_angle(i);
      motor_power[i] = data.motor_power(i);
      rotor_angle[i] = data.rotor_angle(i);
      balance_error[i] = data.balance_error(i);
      magnetometer[i] = data.magnetometer(i);
    }
    for (uint8_t i = 0; i < 6; ++i) rc[i] = data.rc(i);
    serial_errors = data.serial_errors();
    system_error = data.system_error();
    system_sub_error = data.system_sub_error();
    cycle_time_us = data.cycle_time_us();
    i2c_errors = data.i2c_errors();
    reserved_54 = bytes[54];
    battery_cV = data.battery_cV();
    flags = data.flags();
    imu = data.imu();
    profile = data.profile();
    reserved_69 = extended ? bytes[69] : uint8_t(0);
    current_mA = data.current_mA();
    imu_C = data.imu_C();
    frame_imu_C = data.frame_imu_C();
    for (uint8_t i = 0; i < sizeof(later); ++i) later[i] = extended ? bytes[86 + i] : uint8_t(0);
    return true;
  }

  /// @brief REALTIME_DATA_3 or REALTIME_DATA_4.
  uint8_t id() const noexcept { return extended ? command::realtime_data_4 : command::realtime_data_3; }
  /// @brief 63 or 124.
  uint8_t payload_size() const noexcept {
    return extended ? RealtimeData::extended_size : RealtimeData::basic_size;
  }
  /// @brief Writes the payload.
  template <class Sink>
  void write_payload(Sink& sink) const {
    for (uint8_t i = 0; i < 3; ++i) {
      put_i16(sink, acc[i]);
      put_i16(sink, gyro[i]);
    }
    put_u16(sink, serial_errors);
    put_u16(sink, system_error);
    sink.put(system_sub_error);
    put_bytes(sink, reserved_17, 3);
    put_all(sink, rc, 6);
    put_all(sink, imu_angle, 3);
    put_all(sink, frame_imu_angle, 3);
    put_all(sink, target_angle, 3);
    put_u16(sink, cycle_time_us);
    put_u16(sink, i2c_errors);
    sink.put(reserved_54);
    put_u16(sink, battery_cV);
    sink.put(flags);
    sink.put(imu);
    sink.put(profile);
    put_bytes(sink, motor_power, 3);
    if (!extended) return;
    put_all(sink, rotor_angle, 3);
    sink.put(reserved_69);
    put_all(sink, balance_error, 3);
    put_u16(sink, current_mA);
    put_all(sink, magnetometer, 3);
    sink.put(static_cast<uint8_t>(imu_C));
    sink.put(static_cast<uint8_t>(frame_imu_C));
    put_bytes(sink, later, sizeof(later));
  }

private:
  template <class Sink>
  static void put_all(Sink& sink, const int16_t* values, uint8_t count) {
    for (uint8_t i = 0; i < count; ++i) put_i16(sink, values[i]);
  }
};

}  // namespace sbgc
}  // namespace thermopower
