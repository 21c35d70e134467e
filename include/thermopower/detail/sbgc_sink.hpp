// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include <stddef.h>
#include <stdint.h>

#include "../sbgc/protocol.hpp"
#include "sbgc_requirements.hpp"

namespace thermopower {
namespace detail {

/// Bytes go into memory that is known to be large enough.
class SbgcBufferOutput {
 public:
  explicit SbgcBufferOutput(uint8_t* buffer) noexcept : begin_(buffer), at_(buffer) {}
  void put(uint8_t byte) noexcept { *at_++ = byte; }
  size_t finish() noexcept { return static_cast<size_t>(at_ - begin_); }

 private:
  uint8_t* begin_;
  uint8_t* at_;
};

/// Bytes go onto a wire in portions, until it refuses some.
template <class Wire>
class SbgcWireOutput {
 public:
  explicit SbgcWireOutput(Wire& wire) noexcept : wire_(wire) {}

  void put(uint8_t byte) {
    if (used_ == portion) flush();
    chunk_[used_++] = byte;
  }

  size_t finish() {
    flush();
    return taken_;
  }

 private:
  enum : uint8_t { portion = 40 };

  void flush() {
    if (!refused_) {
      const size_t took = sbgc_write(wire_, chunk_, used_, 0);
      taken_ += took < used_ ? took : used_;
      refused_ = took < used_;
    }
    used_ = 0;
  }

  Wire& wire_;
  size_t taken_ = 0;
  uint8_t used_ = 0;
  bool refused_ = false;
  uint8_t chunk_[portion];
};

/// Where a message writes its payload: keeps the checksum, and lets no more through than was announced.
template <class Output, class Protocol>
class SbgcPayloadSink {
 public:
  SbgcPayloadSink(Output& output, Protocol& check, uint8_t announced) noexcept
      : output_(output), check_(check), left_(announced) {}

  void put(uint8_t byte) {
    if (left_ == 0) {
      exceeded_ = true;
      return;
    }
    --left_;
    check_.add_payload(byte);
    output_.put(byte);
  }

  bool as_announced() const noexcept { return left_ == 0 && !exceeded_; }

 private:
  Output& output_;
  Protocol& check_;
  uint8_t left_;
  bool exceeded_ = false;
};

template <class Protocol, class Message, class Output>
size_t sbgc_write_frame(const Message& message, sbgc::Version version, Output& output) {
  const uint8_t start = static_cast<uint8_t>(version);
  const uint8_t id = static_cast<uint8_t>(message.id());
  const size_t announced = static_cast<size_t>(message.payload_size());
  if (!Protocol::is_start(start) || id == 0 || announced > 255) return 0;
  const uint8_t size = static_cast<uint8_t>(announced);
  const uint8_t header[3] = {id, size, static_cast<uint8_t>(id + size)};
  Protocol check;
  check.begin(start);
  output.put(start);
  for (uint8_t i = 0; i < 3; ++i) {
    check.add_header(header[i]);
    output.put(header[i]);
  }
  SbgcPayloadSink<Output, Protocol> sink(output, check, size);
  message.write_payload(sink);
  if (!sink.as_announced()) return 0;
  check.finish();
  for (uint8_t i = 0; i < check.trailer_size(); ++i) output.put(check.trailer(i));
  return output.finish();
}

}  // namespace detail
}  // namespace thermopower
