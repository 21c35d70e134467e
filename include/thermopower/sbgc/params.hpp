// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include <stdint.h>

#include "frame.hpp"
#include "ids.hpp"
#include "writer.hpp"

/// @file
/// @brief READ_PARAMS_3 and WRITE_PARAMS_3: what a profile has for good, gains and POWER among it.

namespace thermopower {
namespace sbgc {

/// @brief Asks for the parameters of a profile; the board answers with the same id and 134 bytes: Params3.
/// Source: SimpleBGC serial protocol specification 2.5, CMD_READ_PARAMS_3.
///
/// @snippet sbgc_examples.cpp parameters
/// How to: @ref wire_up_sbgc.
/// @ingroup sbgc
struct ReadParams3 {
  uint8_t profile = current();  ///< 0..4, or current()

  /// @brief The profile in use.
  static constexpr uint8_t current() noexcept { return 255; }
  /// @brief Reads a frame. @return false, with nothing changed, when it is none.
  bool read(const Frame& frame) noexcept {
    if (frame.id != id() || frame.size != payload_size()) return false;
    profile = frame.payload[0];
    return true;
  }
  /// @brief READ_PARAMS_3.
  static constexpr uint8_t id() noexcept { return command::read_params_3; }
  /// @brief 1.
  static constexpr uint8_t payload_size() noexcept { return 1; }
  /// @brief Writes the payload.
  template <class Sink>
  void write_payload(Sink& sink) const {
    sink.put(profile);
  }
};

/// @brief The parameters of a profile: read, changed and sent back, the board keeps them in its EEPROM and answers Confirm.
///
/// The fields that matter to a controller of POWER have names; all others stay as they were read. The EEPROM bears
/// some 100 000 writes: to change POWER or P in operation, take SetAdjVars.
/// Source: SimpleBGC serial protocol specification 2.5, CMD_READ_PARAMS_3 and CMD_WRITE_PARAMS_3.
///
/// @snippet sbgc_examples.cpp parameters
/// How to: @ref wire_up_sbgc.
/// @ingroup sbgc
class Params3 {
public:
  Params3() noexcept : bytes_{} {}

  /// @brief Copies a frame's payload. @return false, with this object unchanged, unless it is READ_PARAMS_3 or
  /// WRITE_PARAMS_3 with 134 bytes or more.
  bool read(const Frame& frame) noexcept {
    if (frame.id != command::read_params_3 && frame.id != command::write_params_3) return false;
    if (frame.size < payload_size()) return false;
    for (uint8_t i = 0; i < payload_size(); ++i) bytes_[i] = frame.payload[i];
    return true;
  }

  /// @brief Profile these belong to, 0..4; 255: the one in use.
  uint8_t profile() const noexcept { return bytes_[0]; }
  /// @brief Proportional gain of an axis, 0 roll, 1 pitch, 2 yaw (a larger one is yaw); 0..255.
  uint8_t p_gain(uint8_t axis) const noexcept { return bytes_[at(axis, 0)]; }
  /// @brief Integral gain, 0..255.
  uint8_t i_gain(uint8_t axis) const noexcept { return bytes_[at(axis, 1)]; }
  /// @brief Derivative gain, 0..255.
  uint8_t d_gain(uint8_t axis) const noexcept { return bytes_[at(axis, 2)]; }
  /// @brief POWER that the board starts with, 0..255.
  uint8_t power(uint8_t axis) const noexcept { return bytes_[at(axis, 3)]; }
  /// @brief Poles of the motor.
  uint8_t poles(uint8_t axis) const noexcept { return bytes_[at(axis, 5)]; }
  /// @brief Battery voltage below which the board switches the motors off, V.
  float lowest_battery_V() const noexcept { return static_cast<float>(read_i16(bytes_ + 93)) * 0.01f; }
  /// @brief Battery voltage that the board's own compensation refers to, V; 0 or less: none.
  float reference_battery_V() const noexcept { return static_cast<float>(read_i16(bytes_ + 95)) * 0.01f; }

  /// @brief Changes the profile they are written to.
  void set_profile(uint8_t profile) noexcept { bytes_[0] = profile; }
  /// @brief Changes a proportional gain.
  void set_p_gain(uint8_t axis, uint8_t value) noexcept { bytes_[at(axis, 0)] = value; }
  /// @brief Changes the POWER that the board starts with.
  void set_power(uint8_t axis, uint8_t value) noexcept { bytes_[at(axis, 3)] = value; }

  /// @brief WRITE_PARAMS_3.
  static constexpr uint8_t id() noexcept { return command::write_params_3; }
  /// @brief 134.
  static constexpr uint8_t payload_size() noexcept { return 134; }
  /// @brief Writes the payload.
  template <class Sink>
  void write_payload(Sink& sink) const {
    put_bytes(sink, bytes_, payload_size());
  }

private:
  static uint8_t at(uint8_t axis, uint8_t offset) noexcept {
    return static_cast<uint8_t>(1 + 6 * (axis > 2 ? 2 : axis) + offset);
  }
  uint8_t bytes_[134];
};

}  // namespace sbgc
}  // namespace thermopower
