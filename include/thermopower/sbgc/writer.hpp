// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include <stddef.h>
#include <stdint.h>

#include "detail/requirements.hpp"
#include "detail/sink.hpp"
#include "protocol.hpp"

/// @file
/// @brief Turns messages into frames: into a buffer, or straight onto a wire.

namespace thermopower {
namespace sbgc {

/// @brief Length of the frame a message makes, in bytes: 5..261.
/// @ingroup sbgc
template <class Message>
size_t frame_size(const Message& message, Version version) noexcept {
  const size_t overhead =
      version == Version::v2 ? size_t(ProtocolV2::overhead) : size_t(ProtocolV1::overhead);
  return overhead + static_cast<size_t>(message.payload_size());
}

/// @brief Encodes a message as one frame into the caller's buffer.
///
/// A message is any object with `id()`, `payload_size()` and `template <class Sink> void
/// write_payload(Sink&)`, which calls `sink.put(byte)` payload_size() times (put_u16() and its siblings
/// help).
/// @tparam Protocol one that speaks `version`.
/// @param message what to send.
/// @param buffer where to; `capacity` bytes. Null is refused.
/// @param capacity size of the buffer.
/// @param version a version that the policy speaks.
/// @return bytes written; 0 when the message was refused, and then the buffer is as it was: it does not fit
/// `capacity`, its id is 0, its payload is longer than 255 bytes, or the policy does not speak `version`. 0
/// as well (the buffer is then partly overwritten) when a message of your own writes another number of bytes
/// than it announced.
/// @ingroup sbgc
template <class Protocol, class Message>
size_t encode(const Message& message, uint8_t* buffer, size_t capacity,
              Version version = Protocol().sending()) noexcept {
  static_assert(thermopower::detail::SbgcIsMessage<Message>::value,
                "thermopower: encode() needs a message with id(), payload_size() and write_payload(sink)");
  if (!thermopower::detail::sbgc_may_send<Protocol>(message, version)) return 0;
  if (buffer == nullptr || frame_size(message, version) > capacity) return 0;
  return thermopower::detail::sbgc_encode<Protocol>(message, version, buffer);
}

/// @brief Sends a message as one frame onto a wire.
///
/// Frames up to `portion` bytes (with the default, everything a controller sends) go out in one write, longer
/// ones in several. A small portion lets the first byte leave earlier.
/// @param message any message, see encode().
/// @param version a version that the policy speaks.
/// @param wire any object with `write(const uint8_t*, size_t)`, such as Arduino's Serial. When write()
/// returns a number and that is less than asked, sending stops.
/// @return bytes the wire took: frame_size() when all is well; 0 when the message was refused, see encode().
/// @tparam portion bytes of stack to gather what is written at once, 1..255.
/// @ingroup sbgc
template <class Protocol, uint8_t portion = 40, class Message, class Wire>
size_t send(const Message& message, Wire& wire, Version version = Protocol().sending()) {
  static_assert(thermopower::detail::SbgcIsMessage<Message>::value,
                "thermopower: send() needs a message with id(), payload_size() and write_payload(sink)");
  static_assert(thermopower::detail::SbgcHasWrite<Wire>::value,
                "thermopower: send() needs a wire with write(const uint8_t*, size_t)");
  static_assert(portion >= 1, "thermopower: send() needs a portion of at least one byte");
  if (!thermopower::detail::sbgc_may_send<Protocol>(message, version)) return 0;
  if (frame_size(message, version) > portion) {
    return thermopower::detail::sbgc_stream<Protocol, portion>(message, version, wire);
  }
  uint8_t frame[portion];
  const size_t size = thermopower::detail::sbgc_encode<Protocol>(message, version, frame);
  if (size == 0) return 0;
  const size_t took = thermopower::detail::sbgc_write(wire, frame, size, 0);
  return took < size ? took : size;
}

/// @brief Puts 16 bits into a payload, low byte first.
/// @ingroup sbgc
template <class Sink>
void put_u16(Sink& sink, uint16_t value) {
  sink.put(static_cast<uint8_t>(value));
  sink.put(static_cast<uint8_t>(value >> 8));
}

/// @brief Puts signed 16 bits into a payload, low byte first, two's complement.
/// @ingroup sbgc
template <class Sink>
void put_i16(Sink& sink, int16_t value) {
  put_u16(sink, static_cast<uint16_t>(value));
}

/// @brief Puts 32 bits into a payload, low byte first.
/// @ingroup sbgc
template <class Sink>
void put_u32(Sink& sink, uint32_t value) {
  put_u16(sink, static_cast<uint16_t>(value));
  put_u16(sink, static_cast<uint16_t>(value >> 16));
}

/// @brief Puts signed 32 bits into a payload, low byte first, two's complement.
/// @ingroup sbgc
template <class Sink>
void put_i32(Sink& sink, int32_t value) {
  put_u32(sink, static_cast<uint32_t>(value));
}

/// @brief Puts bytes into a payload as they are.
/// @ingroup sbgc
template <class Sink>
void put_bytes(Sink& sink, const uint8_t* data, size_t size) {
  for (size_t i = 0; i < size; ++i) sink.put(data[i]);
}

}  // namespace sbgc
}  // namespace thermopower
