// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include <stdint.h>

#include "adj_vars.hpp"
#include "frame.hpp"
#include "ids.hpp"
#include "writer.hpp"

/// @file
/// @brief What a board answers besides data: CONFIRM, ERROR, BOARD_INFO.

namespace thermopower {
namespace sbgc {

/// @brief The board has executed a command.
///
/// Its id is that of CONTROL; the direction tells them apart, and so does the size here: read() refuses the
/// 13 and 15 bytes of a Control.
/// Source: SimpleBGC serial protocol specification 2.5, CMD_CONFIRM.
///
/// @snippet sbgc_examples.cpp answers
/// How to: @ref wire_up_sbgc.
/// @ingroup sbgc
struct Confirm {
  uint8_t confirmed_id = 0;   ///< command that was executed, see command::Id
  Bytes data = {nullptr, 0};  ///< depends on the command, mostly empty; a view, valid as long as its frame

  /// @brief Reads a frame. @return false, with nothing changed, when it is none.
  bool read(const Frame& frame) noexcept {
    if (frame.id != command::confirm || frame.size < 1 || frame.size == 13 || frame.size == 15) return false;
    confirmed_id = frame.payload[0];
    data = Bytes{frame.payload + 1, static_cast<uint8_t>(frame.size - 1)};
    return true;
  }
  /// @brief Whether it was a command that sets adjustable variables, as POWER is set: no other CONFIRM says that a
  /// POWER is in force.
  bool is_of_power() const noexcept { return confirmed_id == command::set_adj_vars_val; }
  /// @brief CONFIRM.
  static constexpr uint8_t id() noexcept { return command::confirm; }
  /// @brief 1 byte and the data.
  uint16_t payload_size() const noexcept { return static_cast<uint16_t>(1 + data.size); }
  /// @brief Writes the payload.
  template <class Sink>
  void write_payload(Sink& sink) const {
    sink.put(confirmed_id);
    put_bytes(sink, data.data, data.size);
  }
};

/// @brief The board could not execute a command.
/// Source: SimpleBGC serial protocol specification 2.5, CMD_ERROR.
///
/// @snippet sbgc_examples.cpp answers
/// How to: @ref wire_up_sbgc.
/// @ingroup sbgc
struct Error {
  uint8_t code = 0;      ///< what went wrong
  uint8_t data[4] = {};  ///< depends on the code

  /// @brief Reads a frame. @return false, with nothing changed, when it is none or shorter than 5 bytes.
  bool read(const Frame& frame) noexcept {
    if (frame.id != command::error || frame.size < payload_size()) return false;
    code = frame.payload[0];
    for (uint8_t i = 0; i < 4; ++i) data[i] = frame.payload[1 + i];
    return true;
  }
  /// @brief ERROR.
  static constexpr uint8_t id() noexcept { return command::error; }
  /// @brief 5.
  static constexpr uint8_t payload_size() noexcept { return 5; }
  /// @brief Writes the payload.
  template <class Sink>
  void write_payload(Sink& sink) const {
    sink.put(code);
    put_bytes(sink, data, 4);
  }
};

/// @brief Tells a gimbal controller what the board answered to its commands. A CONFIRM of another command than one that
/// sets POWER changes nothing.
/// @param frame   any frame  @param gimbal  has `confirmed(const Confirm&)` and `refused()`, as GimbalController
/// @return was it an answer?
/// @ingroup sbgc
template <class Gimbal>
bool hear_answer(const Frame& frame, Gimbal& gimbal) noexcept {
  if (frame.id == command::error) {
    gimbal.refused();
    return true;
  }
  Confirm confirm;
  if (!confirm.read(frame)) return false;
  gimbal.confirmed(confirm);
  return true;
}

/// @brief Tells a gimbal controller what POWER the board says it has: the answer to ask_power().
/// @param frame   any frame  @param gimbal  has `read_back(axis, power)`, as GimbalController
/// @return was it one with variables of the board?
/// @ingroup sbgc
template <class Gimbal>
bool hear_power(const Frame& frame, Gimbal& gimbal) noexcept {
  AdjVarsView vars;
  if (!vars.read(frame)) return false;
  for (uint8_t axis = 0; axis < 3; ++axis) {
    int32_t power = 0;
    if (!vars.find(static_cast<uint8_t>(variable::power_roll + axis), power)) continue;
    // What cannot be is the most there is.
    gimbal.read_back(axis, power >= 0 && power <= 255 ? static_cast<uint8_t>(power) : uint8_t(255));
  }
  return true;
}

/// @brief What board it is. Asked for with `Request(command::board_info)`.
/// Source: SimpleBGC serial protocol specification 2.5, CMD_BOARD_INFO.
///
/// @snippet sbgc_examples.cpp answers
/// How to: @ref wire_up_sbgc.
/// @ingroup sbgc
struct BoardInfo {
  uint8_t board_version = 0;           ///< tenths: 30 is board 3.0
  uint16_t firmware_version = 0;       ///< thousandths and betas: 2687 is 2.68b7
  uint8_t state_flags = 0;             ///< bit 0: debug mode
  uint16_t board_features = 0;         ///< flags
  uint8_t connection_flags = 0;        ///< bit 0: USB
  uint32_t firmware_extra_id = 0;      ///< identifies special builds
  uint16_t board_features_ext = 0;     ///< more flags
  uint8_t reserved[3] = {};            ///< IMU models and build number in later firmware
  uint16_t base_firmware_version = 0;  ///< as firmware_version

  /// @brief Reads a frame. @return false, with nothing changed, when it is none or shorter than 18 bytes.
  bool read(const Frame& frame) noexcept {
    if (frame.id != command::board_info || frame.size < payload_size()) return false;
    const uint8_t* at = frame.payload;
    board_version = at[0];
    firmware_version = read_u16(at + 1);
    state_flags = at[3];
    board_features = read_u16(at + 4);
    connection_flags = at[6];
    firmware_extra_id = read_u32(at + 7);
    board_features_ext = read_u16(at + 11);
    for (uint8_t i = 0; i < 3; ++i) reserved[i] = at[13 + i];
    base_firmware_version = read_u16(at + 16);
    return true;
  }
  /// @brief BOARD_INFO.
  static constexpr uint8_t id() noexcept { return command::board_info; }
  /// @brief 18.
  static constexpr uint8_t payload_size() noexcept { return 18; }
  /// @brief Writes the payload.
  template <class Sink>
  void write_payload(Sink& sink) const {
    sink.put(board_version);
    put_u16(sink, firmware_version);
    sink.put(state_flags);
    put_u16(sink, board_features);
    sink.put(connection_flags);
    put_u32(sink, firmware_extra_id);
    put_u16(sink, board_features_ext);
    put_bytes(sink, reserved, 3);
    put_u16(sink, base_firmware_version);
  }
};

}  // namespace sbgc
}  // namespace thermopower
