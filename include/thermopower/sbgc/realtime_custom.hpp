// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include <math.h>
#include <stdint.h>

#include "frame.hpp"
#include "ids.hpp"
#include "writer.hpp"

/// @file
/// @brief REALTIME_DATA_CUSTOM: telemetry made of chosen fields, among them what newer boards know of their motors.

namespace thermopower {
namespace sbgc {

/// @brief What REALTIME_DATA_CUSTOM is asked for; add the numbers.
/// @ingroup sbgc
namespace custom {
/// @brief One bit each; see the namespace. Those of the specification that are not listed have no fixed size there.
enum Field : uint32_t {
  imu_angles = 1u << 0,        ///< 3 x int16, 360/16384 degrees
  target_angles = 1u << 1,     ///< 3 x int16, 360/16384 degrees
  target_speed = 1u << 2,      ///< 3 x int16, 0.1220740379 deg/s
  frame_cam_angle = 1u << 3,   ///< 3 x int16, 360/16384 degrees
  gyro = 1u << 4,              ///< 3 x int16, 0.06103701895 deg/s
  rc = 1u << 5,                ///< 6 x int16
  vectors = 1u << 6,           ///< 6 x float: the camera's vertical and its heading
  rc_channels = 1u << 7,       ///< 18 x int16
  acc = 1u << 8,               ///< 3 x int16, 1/512 g
  encoders = 1u << 11,         ///< 3 x 24 bits
  imu_angles_rad = 1u << 12,   ///< 3 x float, radians
  script_floats = 1u << 13,    ///< 10 x float
  script_integers = 1u << 14,  ///< 10 x int16
  power_state = 0x8000u        ///< motors and battery, firmware 2.70b6 and later
};
/// @brief Bytes of a field in the answer; 0 for one that is not listed.
inline uint8_t size_of(uint32_t field) noexcept {
  switch (field) {
    case rc:
      return 12;
    case vectors:
      return 24;
    case rc_channels:
      return 36;
    case encoders:
      return 9;
    case imu_angles_rad:
      return 12;
    case script_floats:
      return 40;
    case script_integers:
      return 20;
    case power_state:
      return 46;
    default:
      return field <= acc ? uint8_t(6) : uint8_t(0);
  }
}
}  // namespace custom

/// @brief Asks for chosen fields once; DataStreamInterval asks for them regularly.
/// Source: SimpleBGC serial protocol specification 2.5, CMD_REALTIME_DATA_CUSTOM.
///
/// @snippet sbgc_examples.cpp custom telemetry
/// How to: @ref wire_up_sbgc.
/// @ingroup sbgc
struct RealtimeCustomRequest {
  uint32_t fields = 0;  ///< custom::Field, added

  /// @brief Reads a frame. @return false, with nothing changed, when it is none or shorter than 10 bytes.
  bool read(const Frame& frame) noexcept {
    if (frame.id != id() || frame.size != payload_size()) return false;
    fields = read_u32(frame.payload);
    return true;
  }
  /// @brief REALTIME_DATA_CUSTOM.
  static constexpr uint8_t id() noexcept { return command::realtime_data_custom; }
  /// @brief 10.
  static constexpr uint8_t payload_size() noexcept { return 10; }
  /// @brief Writes the payload.
  template <class Sink>
  void write_payload(Sink& sink) const {
    put_u32(sink, fields);
    for (uint8_t reserved = 0; reserved < 6; ++reserved) sink.put(0);
  }
};

/// @brief View of an answer to REALTIME_DATA_CUSTOM; valid as long as its frame. The answer does not say which fields are
/// in it: the fields asked for are given to the constructor.
///
/// What was not asked for reads as implausible: NaN, or -128 degC. Axes are 0 roll, 1 pitch, 2 yaw; a larger axis reads
/// as yaw.
/// Source: SimpleBGC serial protocol specification 2.5, CMD_REALTIME_DATA_CUSTOM.
///
/// @snippet sbgc_examples.cpp custom telemetry
/// How to: @ref wire_up_sbgc.
/// @ingroup sbgc
class RealtimeCustom {
public:
  /// @param fields custom::Field, added, as they were asked for
  explicit RealtimeCustom(uint32_t fields) noexcept : fields_(fields) {}

  /// @brief Bytes of the answer; 0 when a field is among them that is not listed.
  uint16_t payload_size() const noexcept {
    uint16_t size = 2;
    for (uint32_t field = 1, left = fields_; left != 0; field <<= 1, left >>= 1) {
      if ((left & 1u) == 0) continue;
      if (custom::size_of(field) == 0) return 0;
      size = static_cast<uint16_t>(size + custom::size_of(field));
    }
    return size;
  }
  /// @brief Looks at a frame's payload. @return false, with this object unchanged, when it is another, too short for the
  /// fields, or a field is among them that is not listed.
  bool read(const Frame& frame) noexcept {
    const uint16_t size = payload_size();
    if (frame.id != command::realtime_data_custom || size == 0 || frame.size < size) return false;
    payload_ = frame.payload;
    return true;
  }

  /// @brief The board's clock, milliseconds, wraps.
  uint16_t timestamp_ms() const noexcept { return read_u16(payload_); }
  /// @brief Where a field is in the payload; null when it was not asked for.
  const uint8_t* field(custom::Field wanted) const noexcept {
    if (payload_ == nullptr || (fields_ & wanted) == 0) return nullptr;
    const uint8_t* at = payload_ + 2;
    for (uint32_t before = 1; before < static_cast<uint32_t>(wanted); before <<= 1)
      if ((fields_ & before) != 0) at += custom::size_of(before);
    return at;
  }

  /// @brief Current of a motor in A, measured or estimated by the board; NaN when `power_state` was not asked for.
  float motor_current_A(uint8_t axis) const noexcept {
    const uint8_t* at = motor(axis);
    return at == nullptr ? static_cast<float>(NAN) : static_cast<float>(read_u16(at + 2)) * 0.001f;
  }
  /// @brief Temperature of a motor in degC, measured or estimated by the board; -128 when `power_state` was not asked for.
  int8_t motor_C(uint8_t axis) const noexcept {
    const uint8_t* at = motor(axis);
    return at == nullptr ? int8_t(-128) : static_cast<int8_t>(at[4]);
  }
  /// @brief Power of a motor, -1..1; NaN when `power_state` was not asked for.
  float motor_power(uint8_t axis) const noexcept {
    const uint8_t* at = motor(axis);
    return at == nullptr ? static_cast<float>(NAN) : static_cast<float>(read_i16(at)) * 0.0001f;
  }
  /// @brief Has the motor's current passed the board's limit?
  bool is_over_current(uint8_t axis) const noexcept {
    const uint8_t* at = motor(axis);
    return at != nullptr && (at[5] & 2) != 0;
  }
  /// @brief 0 motors off, 1 on, 2 off for a calibration, 3 off when parked, 4 in a safe stop; -128 when `power_state`
  /// was not asked for.
  int8_t power_state() const noexcept {
    const uint8_t* at = field(custom::power_state);
    return at == nullptr ? int8_t(-128) : static_cast<int8_t>(at[39]);
  }
  /// @brief Battery in volts; NaN when `power_state` was not asked for.
  float battery_V() const noexcept {
    const uint8_t* at = field(custom::power_state);
    return at == nullptr ? static_cast<float>(NAN) : static_cast<float>(read_u16(at + 40)) * 0.01f;
  }
  /// @brief Current drawn from the supply in A; NaN when `power_state` was not asked for.
  float current_A() const noexcept {
    const uint8_t* at = field(custom::power_state);
    return at == nullptr ? static_cast<float>(NAN) : static_cast<float>(read_u16(at + 42)) * 0.001f;
  }
  /// @brief Does the board warn that a motor is too hot?
  bool warns_of_heat() const noexcept {
    const uint8_t* at = field(custom::power_state);
    return at != nullptr && (at[44] & 2) != 0;
  }

private:
  const uint8_t* motor(uint8_t axis) const noexcept {
    const uint8_t* at = field(custom::power_state);
    return at == nullptr ? nullptr : at + 13 * (axis > 2 ? 2 : axis);
  }
  uint32_t fields_;
  const uint8_t* payload_ = nullptr;
};

}  // namespace sbgc
}  // namespace thermopower
