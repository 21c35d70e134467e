// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include <stddef.h>
#include <stdint.h>

#include "../protocol.hpp"
#include "requirements.hpp"

namespace thermopower {
namespace detail {

/// Payload of a message on its way into memory; lets no more through than was announced.
class SbgcMemorySink {
public:
  SbgcMemorySink(uint8_t* at, uint8_t announced) noexcept : at_(at), end_(at + announced) {}

  // Inlined by force: avr-gcc -Os would make calls that cost twice the cycles and more flash than the bodies.
  [[gnu::always_inline]] void put(uint8_t byte) noexcept {
    if (at_ == end_) {
      exceeded_ = true;
      return;
    }
    *at_++ = byte;
  }

  bool as_announced() const noexcept { return at_ == end_ && !exceeded_; }

private:
  uint8_t* at_;
  uint8_t* end_;
  bool exceeded_ = false;
};

/// Payload of a message on its way onto a wire, in portions, until the wire refuses some.
template <class Wire, class Protocol, uint8_t portion>
class SbgcWireSink {
public:
  SbgcWireSink(Wire& wire, Protocol& check, uint8_t announced) noexcept
      : wire_(wire), check_(check), left_(announced) {}

  void put(uint8_t byte) {
    if (left_ == 0) {
      exceeded_ = true;
      return;
    }
    --left_;
    check_.add_payload(byte);
    put_unchecked(byte);
  }

  void put_unchecked(uint8_t byte) {
    if (used_ == portion) flush();
    chunk_[used_++] = byte;
  }

  void flush() {
    if (!refused_) {
      const size_t took = sbgc_write(wire_, chunk_, used_, 0);
      refused_ = took < used_;
      taken_ += refused_ ? took : used_;
    }
    used_ = 0;
  }

  size_t taken() const noexcept { return taken_; }
  bool as_announced() const noexcept { return left_ == 0 && !exceeded_; }

private:
  Wire& wire_;
  Protocol& check_;
  size_t taken_ = 0;
  uint8_t left_;
  uint8_t used_ = 0;
  bool refused_ = false;
  bool exceeded_ = false;
  uint8_t chunk_[portion];
};

template <class Protocol, class Message>
bool sbgc_may_send(const Message& message, sbgc::Version version) noexcept {
  return Protocol::is_start(static_cast<uint8_t>(version)) && static_cast<uint8_t>(message.id()) != 0 &&
         static_cast<size_t>(message.payload_size()) <= 255;
}

template <class Protocol, class Message>
void sbgc_begin(const Message& message, sbgc::Version version, Protocol& check, uint8_t* header) noexcept {
  header[0] = static_cast<uint8_t>(version);
  header[1] = static_cast<uint8_t>(message.id());
  header[2] = static_cast<uint8_t>(message.payload_size());
  header[3] = static_cast<uint8_t>(header[1] + header[2]);
  check.begin(header[0]);
  for (uint8_t i = 1; i < 4; ++i) check.add_header(header[i]);
}

/// Into memory that holds at least frame_size() bytes.
template <class Protocol, class Message>
size_t sbgc_encode(const Message& message, sbgc::Version version, uint8_t* frame) {
  Protocol check;
  sbgc_begin(message, version, check, frame);
  const uint8_t size = static_cast<uint8_t>(message.payload_size());
  SbgcMemorySink sink(frame + 4, size);
  message.write_payload(sink);
  if (!sink.as_announced()) return 0;
  // The checksum is a loop of its own, so that put() stays a store.
  uint8_t* at = frame + 4;
  for (uint8_t left = size; left != 0; --left) check.add_payload(*at++);
  check.finish();
  for (uint8_t i = 0; i < check.trailer_size(); ++i) *at++ = check.trailer(i);
  return static_cast<size_t>(at - frame);
}

/// Onto a wire, with no more memory than a portion.
template <class Protocol, uint8_t portion, class Message, class Wire>
size_t sbgc_stream(const Message& message, sbgc::Version version, Wire& wire) {
  Protocol check;
  uint8_t header[4];
  sbgc_begin(message, version, check, header);
  SbgcWireSink<Wire, Protocol, portion> sink(wire, check, header[2]);
  for (uint8_t i = 0; i < 4; ++i) sink.put_unchecked(header[i]);
  message.write_payload(sink);
  if (!sink.as_announced()) return 0;
  check.finish();
  for (uint8_t i = 0; i < check.trailer_size(); ++i) sink.put_unchecked(check.trailer(i));
  sink.flush();
  return sink.taken();
}

}  // namespace detail
}  // namespace thermopower
