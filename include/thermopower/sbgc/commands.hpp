// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include <stdint.h>

#include "frame.hpp"
#include "ids.hpp"
#include "writer.hpp"

/// @file
/// @brief Short commands: requests, motors on and off, reset, data streams, and raw access to all others.

namespace thermopower {
namespace sbgc {

/// @brief A command without payload: asks for data (`Request(command::realtime_data_4)`), or any other such
/// command.
///
/// @snippet sbgc_examples.cpp codec
/// How to: @ref wire_up_sbgc.
/// @ingroup sbgc
struct Request {
  uint8_t requested_id = 0;  ///< see command::Id; 0 cannot be sent

  Request() noexcept = default;
  /// @param command_id see command::Id.
  explicit Request(uint8_t command_id) noexcept : requested_id(command_id) {}

  /// @brief Reads a frame. @return false, with nothing changed, when it has a payload.
  bool read(const Frame& frame) noexcept {
    if (frame.id == 0 || frame.size != 0) return false;
    requested_id = frame.id;
    return true;
  }
  /// @brief The id requested.
  uint8_t id() const noexcept { return requested_id; }
  /// @brief 0.
  static constexpr uint8_t payload_size() noexcept { return 0; }
  /// @brief Writes nothing.
  template <class Sink>
  void write_payload(Sink&) const noexcept {}
};

/// @brief Any command with any payload, for those that have no type here.
///
/// @snippet sbgc_examples.cpp commands
/// How to: @ref wire_up_sbgc.
/// @ingroup sbgc
struct Raw {
  uint8_t raw_id;  ///< 1..255
  Bytes data;      ///< the payload, not copied: a view of a frame's payload, or of the caller's bytes

  /// @brief Looks at a frame. @return false, with nothing changed, when there is none.
  bool read(const Frame& frame) noexcept {
    if (frame.id == 0) return false;
    raw_id = frame.id;
    data = Bytes{frame.payload, frame.size};
    return true;
  }
  /// @brief The id.
  uint8_t id() const noexcept { return raw_id; }
  /// @brief Size of the data.
  uint8_t payload_size() const noexcept { return data.size; }
  /// @brief Writes the data.
  template <class Sink>
  void write_payload(Sink& sink) const {
    put_bytes(sink, data.data, data.size);
  }
};

/// @brief Switches the motors on; the board answers Confirm.
/// Source: SimpleBGC serial protocol specification 2.5, CMD_MOTORS_ON.
///
/// @snippet sbgc_examples.cpp commands
/// How to: @ref wire_up_sbgc.
/// @ingroup sbgc
struct MotorsOn {
  /// @brief Is the frame one?
  bool read(const Frame& frame) const noexcept { return frame.id == id(); }
  /// @brief MOTORS_ON.
  static constexpr uint8_t id() noexcept { return command::motors_on; }
  /// @brief 0.
  static constexpr uint8_t payload_size() noexcept { return 0; }
  /// @brief Writes nothing.
  template <class Sink>
  void write_payload(Sink&) const noexcept {}
};

/// @brief Switches the motors off; the board answers Confirm.
/// Source: SimpleBGC serial protocol specification 2.5, CMD_MOTORS_OFF.
///
/// @snippet sbgc_examples.cpp commands
/// How to: @ref wire_up_sbgc.
/// @ingroup sbgc
struct MotorsOff {
  /// @brief How (firmware 2.68b7 and later; older firmware always frees the motors).
  enum Mode : uint8_t {
    released = 0,  ///< windings open, the motor turns freely
    brake = 1,     ///< windings shorted, the motor brakes
    safe_stop = 2  ///< power is reduced, off when the gimbal has stopped
  };
  uint8_t mode = released;  ///< see Mode

  /// @brief Reads a frame; without payload the mode is `released`. @return false, unchanged, when it is none.
  bool read(const Frame& frame) noexcept {
    if (frame.id != id()) return false;
    mode = frame.size == 0 ? uint8_t(released) : frame.payload[0];
    return true;
  }
  /// @brief MOTORS_OFF.
  static constexpr uint8_t id() noexcept { return command::motors_off; }
  /// @brief 1.
  static constexpr uint8_t payload_size() noexcept { return 1; }
  /// @brief Writes the payload.
  template <class Sink>
  void write_payload(Sink& sink) const {
    sink.put(mode);
  }
};

/// @brief Restarts the board.
/// Source: SimpleBGC serial protocol specification 2.5, CMD_RESET.
///
/// @snippet sbgc_examples.cpp commands
/// How to: @ref wire_up_sbgc.
/// @ingroup sbgc
struct Reset {
  /// @brief Flags.
  enum Flag : uint8_t {
    notify = 1,       ///< the board sends an empty RESET before it restarts
    backup_state = 2  ///< the board keeps its state across the restart
  };
  uint8_t flags = 0;      ///< see Flag
  uint16_t delay_ms = 0;  ///< time until the restart, ms

  /// @brief Reads a frame; without payload all is 0. @return false, unchanged, when it is none.
  bool read(const Frame& frame) noexcept {
    if (frame.id != id() || (frame.size != 0 && frame.size < payload_size())) return false;
    flags = frame.size == 0 ? uint8_t(0) : frame.payload[0];
    delay_ms = frame.size == 0 ? uint16_t(0) : read_u16(frame.payload + 1);
    return true;
  }
  /// @brief RESET.
  static constexpr uint8_t id() noexcept { return command::reset; }
  /// @brief 3.
  static constexpr uint8_t payload_size() noexcept { return 3; }
  /// @brief Writes the payload.
  template <class Sink>
  void write_payload(Sink& sink) const {
    sink.put(flags);
    put_u16(sink, delay_ms);
  }
};

/// @brief Has the board send a command's data regularly (firmware 2.59 and later); the board answers Confirm.
/// Source: SimpleBGC serial protocol specification 2.5, CMD_DATA_STREAM_INTERVAL.
///
/// @snippet sbgc_examples.cpp commands
/// How to: @ref wire_up_sbgc.
/// @ingroup sbgc
struct DataStreamInterval {
  uint8_t streamed_id = 0;    ///< command whose answers are wanted, such as command::realtime_data_4
  uint16_t interval_ms = 0;   ///< time between them, ms; 0 stops the stream
  uint8_t config[8] = {};     ///< depends on the command
  uint8_t reserved[10] = {};  ///< 0

  /// @brief Reads a frame. @return false, with nothing changed, when it is none or shorter than 21 bytes.
  bool read(const Frame& frame) noexcept {
    if (frame.id != id() || frame.size < payload_size()) return false;
    streamed_id = frame.payload[0];
    interval_ms = read_u16(frame.payload + 1);
    for (uint8_t i = 0; i < sizeof(config); ++i) config[i] = frame.payload[3 + i];
    for (uint8_t i = 0; i < sizeof(reserved); ++i) reserved[i] = frame.payload[11 + i];
    return true;
  }
  /// @brief DATA_STREAM_INTERVAL.
  static constexpr uint8_t id() noexcept { return command::data_stream_interval; }
  /// @brief 21.
  static constexpr uint8_t payload_size() noexcept { return 21; }
  /// @brief Writes the payload.
  template <class Sink>
  void write_payload(Sink& sink) const {
    sink.put(streamed_id);
    put_u16(sink, interval_ms);
    put_bytes(sink, config, sizeof(config));
    put_bytes(sink, reserved, sizeof(reserved));
  }
};

}  // namespace sbgc
}  // namespace thermopower
