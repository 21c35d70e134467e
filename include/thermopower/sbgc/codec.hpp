// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include <stddef.h>
#include <stdint.h>

#include "adj_vars.hpp"
#include "angles.hpp"
#include "answers.hpp"
#include "board_errors.hpp"
#include "commands.hpp"
#include "control.hpp"
#include "frame.hpp"
#include "params.hpp"
#include "realtime_custom.hpp"
#include "realtime_data.hpp"
#include "realtime_fields.hpp"
#include "receiver.hpp"
#include "writer.hpp"

/// @file
/// @brief SbgcCodec: the whole of the SimpleBGC protocol in one object.

/// @defgroup sbgc The wire
/// @brief The serial protocol of SimpleBGC gimbal controllers: frames, messages, codec.

namespace thermopower {

/// @brief One end of a SimpleBGC serial line: finds frames in what arrives, reads and writes messages.
///
///     thermopower::SbgcCodec<> codec;
///     codec.send(thermopower::sbgc::Request(thermopower::sbgc::command::realtime_data_4), Serial);
///     ...
///     for (bool got = codec.receive(byte, micros()); got; got = codec.next())
///       if (const auto* telemetry = codec.realtime_data()) use(telemetry->error_deg(0));
///
/// Receiving is sbgc::Receiver, which says what is guaranteed on a damaged line; both ends speak the same
/// messages, so an emulated board is a codec as well. There is one buffer and no other memory; instances are
/// independent.
///
/// @tparam payload_capacity longest payload to be received, 0..255. The default holds whatever a board can send. 124 holds
/// REALTIME_DATA_4 as it is today and saves 147 bytes; a firmware that appends a field to it is then never heard.
/// @tparam Protocol sbgc::ProtocolV1, sbgc::ProtocolV2 or sbgc::ProtocolAuto (a menu: see sbgc::ProtocolV1).
///
/// @snippet sbgc_examples.cpp codec
/// How to: @ref wire_up_sbgc.
/// @ingroup sbgc
template <size_t payload_capacity = 255, class Protocol = sbgc::ProtocolV1>
class SbgcCodec : public sbgc::Receiver<payload_capacity, Protocol> {
  typedef sbgc::Receiver<payload_capacity, Protocol> Base;

public:
  /// @param timeout_us longest pause between two bytes of a frame; see sbgc::Receiver.
  explicit SbgcCodec(uint32_t timeout_us = 20000) noexcept : Base(timeout_us) {}

  /// @brief Reads the frame at hand as a message, any type with `read(frame)`.
  /// @return false, with the message unchanged, when there is no frame or it is not such a message.
  template <class Message>
  bool read(Message& message) const noexcept {
    static_assert(thermopower::detail::SbgcIsReadable<Message, sbgc::Frame>::value,
                  "thermopower: SbgcCodec::read() needs a message with bool read(const sbgc::Frame&)");
    return Base::has_frame() && message.read(Base::frame());
  }

  /// @brief The frame at hand as telemetry; null when there is none or it is something else.
  /// Valid until the next call of receive(), next(), poll() or clear().
  const sbgc::RealtimeData* realtime_data() noexcept { return read(telemetry_) ? &telemetry_ : nullptr; }

  /// @brief Encodes a message as one frame into the caller's buffer.
  /// @return bytes written; 0 when it was refused (see sbgc::encode()), the buffer being as it was.
  template <class Message>
  size_t encode(const Message& message, uint8_t* buffer, size_t capacity) const noexcept {
    return sbgc::encode<Protocol>(message, buffer, capacity, Base::protocol().sending());
  }

  /// @brief Sends a message as one frame.
  /// @param message any message, see sbgc::encode().
  /// @param wire any object with `write(const uint8_t*, size_t)`, such as Arduino's Serial.
  /// @return bytes the wire took; 0 when the message was refused (see sbgc::send()).
  template <class Message, class Wire>
  size_t send(const Message& message, Wire& wire) const {
    return sbgc::send<Protocol>(message, wire, Base::protocol().sending());
  }

private:
  sbgc::RealtimeData telemetry_;
};

}  // namespace thermopower
