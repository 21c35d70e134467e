// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "detail/index.hpp"
#include "frame.hpp"
#include "protocol.hpp"

/// @file
/// @brief Finds frames in a stream of bytes.

namespace thermopower {
namespace sbgc {

/// @brief What a receiver took and what it lost. Counts wrap at 2^32.
///
/// Bytes are conserved: bytes received = bytes of valid frames + `skipped_bytes` + Receiver::pending().
/// @ingroup sbgc
struct ReceiverCounters {
  uint32_t frames;            ///< valid frames
  uint32_t skipped_bytes;     ///< bytes that belong to no valid frame
  uint32_t header_checksum;   ///< start bytes given up because id + size did not match the third header byte
  uint32_t invalid_id;        ///< headers given up because their id is 0
  uint32_t too_long;          ///< headers given up because the payload would not fit the buffer
  uint32_t payload_checksum;  ///< complete frames given up because of their checksum
  uint32_t timeouts;          ///< incomplete frames given up because the next byte did not come in time
  uint32_t
      overruns;  ///< times that bytes were dropped unread: false headers came faster than they are read again
};

/// @brief Finds the frames in a stream of bytes, a byte at a time, whatever the damage.
///
/// The result is the leftmost reading of the stream: at each position either a valid frame starts, which is
/// reported and whose bytes are done with, or one byte is skipped. When a frame proves wrong, its bytes after
/// the first are kept and read again, so that a stray start byte or a lost byte costs the damaged frame and
/// nothing else. False starts delay the frames behind them (until enough bytes have come, or until the
/// time-out), but do not lose them. What cannot be had: damaged bytes whose checksums are right by chance
/// (v1: about one false start in 65536, v2: one in 16 million) are a frame like any other, and hide what they
/// overlap.
///
/// A header that announces more than the buffer holds is given up at once and what follows it is read on as
/// if it were noise, because the header may be false; a whole valid frame inside such a payload is therefore
/// reported. With `payload_capacity` 255 this cannot happen.
///
/// Work per call is bounded: each call reads at most 16 bytes, new or again, and moves the buffer at most once. Bytes that are
/// read again wait in the buffer meanwhile, and has_unread() says so. The buffer has room for one false header in front of a
/// longest frame. A stream that is built of false headers needs more. Then the oldest bytes are dropped unread, and `overruns` counts it;
/// the same holds for bytes before the earlier of two pauses. Only there is the result not the leftmost reading.
///
///     for (bool got = receiver.receive(byte, now_us); got; got = receiver.next()) use(receiver.frame());
///
/// @tparam payload_capacity longest payload to be received, 0..255; RAM is this, an eighth more, and about 70 bytes.
/// @tparam Protocol ProtocolV1, ProtocolV2 or ProtocolAuto.
///
/// @snippet sbgc_examples.cpp receiver
/// How to: @ref wire_up_sbgc.
/// @ingroup sbgc
template <size_t payload_capacity, class Protocol>
class Receiver {
  static_assert(
      thermopower::detail::SbgcIsProtocol<Protocol>::value,
      "thermopower: the second parameter of SbgcCodec and Receiver must be a protocol: sbgc::ProtocolV1, sbgc::ProtocolV2, sbgc::ProtocolAuto or a type with the same members");

  static_assert(payload_capacity <= 255, "thermopower: an SBGC payload has at most 255 bytes");

public:
  /// @param timeout_us longest pause between two bytes of a frame, at most 8 000 000 (longer is taken for
  /// that); 0 waits for ever. A pause is noticed up to 512 us late and never early, and however long it is but for the
  /// last 16 s before the clock comes round. The default is long for
  /// the wire (a byte takes 87 us at 115200 baud), because bytes are often read late and in groups.
  explicit Receiver(uint32_t timeout_us = 20000) noexcept { set_timeout_us(timeout_us); }

  /// @brief Takes one byte. The frame reported before, if any, is released.
  /// @param byte the next byte of the stream.
  /// @param now_us a clock that may wrap around at 2^32 (such as Arduino's micros()).
  /// @return true when a valid frame is there: see frame(). Call next() for more of them before the next
  /// byte; it is allowed not to, frames then come with later bytes, and none is lost.
  bool receive(uint8_t byte, uint32_t now_us) noexcept {
    const bool late = is_late(now_us);
    last_us_ = now_us;
    if (stage_ == Stage::payload && cursor_ == end_ && !late) {
      // By far the most frequent case: all bytes before this one are read, and check_header() has made room.
      bytes_[end_] = byte;
      cursor_ = ++end_;
      take_payload(byte);
      return false;
    }
    release();
    if (late) mark_pause();
    if (end_ == buffer_size) make_room();
    bytes_[end_++] = byte;
    return parse();
  }

  /// @brief Releases the frame reported and looks for another one in the bytes already there.
  /// @return true when there is one. More than one can wait after damage only.
  bool next() noexcept {
    release();
    return parse();
  }

  /// @brief Like next(), and gives up an incomplete frame whose next byte is overdue.
  /// Call it in every round of the loop in which no byte comes: it brings out frames that a false start is holding back.
  bool poll(uint32_t now_us) noexcept {
    release();
    if (is_late(now_us)) mark_pause();
    return parse();
  }

  /// @brief Are there bytes that a later call has still to read? Only after damage: see the bound of the work per call.
  bool has_unread() const noexcept {
    return cursor_ != end_ || (cursor_ == stale_ && stage_ != Stage::hunting);
  }

  /// @brief Is there a frame at hand?
  bool has_frame() const noexcept { return stage_ == Stage::complete; }

  /// @brief The frame at hand, valid until the next call of receive(), next(), poll() or clear();
  /// id 0 and no payload when there is none.
  Frame frame() const noexcept {
    if (!has_frame()) return Frame{0, 0, nullptr, protocol_.sending()};
    const uint8_t* start = bytes_ + head_;
    return Frame{start[1], start[2], start + header_size, static_cast<Version>(start[0])};
  }

  /// @brief Number of bytes received and not yet decided upon, without the frame at hand.
  size_t pending() const noexcept { return static_cast<size_t>(end_ - (has_frame() ? cursor_ : head_)); }

  /// @brief What was received and lost since the start or clear_counters().
  const ReceiverCounters& counters() const noexcept { return counters_; }
  /// @brief Sets all counters to 0.
  void clear_counters() noexcept { counters_ = ReceiverCounters(); }

  /// @brief Forgets the frame at hand and all pending bytes, uncounted; for use after the port was reopened.
  void clear() noexcept {
    head_ = cursor_ = end_ = stale_ = 0;
    stage_ = Stage::hunting;
  }

  /// @brief Longest pause between two bytes of a frame; 0 waits for ever.
  uint32_t timeout_us() const noexcept { return static_cast<uint32_t>(timeout_) << tick_shift; }
  /// @brief Changes the longest pause; see the constructor. Rounded up to a multiple of 256 us.
  void set_timeout_us(uint32_t timeout_us) noexcept {
    const uint32_t longest_us = 8000000;
    timeout_ =
        static_cast<uint16_t>(((timeout_us < longest_us ? timeout_us : longest_us) + 255) >> tick_shift);
  }

  /// @brief The policy's state: which version to send in, for ProtocolAuto.
  const Protocol& protocol() const noexcept { return protocol_; }
  /// @brief The policy's state, to change it; for ProtocolAuto.
  Protocol& protocol() noexcept { return protocol_; }

private:
  // Of protocol v1 as many bytes as are read again in the time of one on the wire (115200 baud: 87 us, 1389 cycles at 16 MHz).
  enum : uint8_t { steps_a_call = 16 };
  // A longest frame behind a false header is read again in an eighth of its bytes' calls at most; and while it comes, the buffer moves only
  // when its front has as many free bytes as a call has steps.
  enum : uint16_t {
    header_size = 4,
    spare_size = steps_a_call + payload_capacity / 8,
    buffer_size = payload_capacity + Protocol::overhead + spare_size,
    tick_shift = 8
  };
  typedef typename thermopower::detail::SbgcIndex<(buffer_size > 255)>::Type Index;
  enum class Stage : uint8_t { hunting, header, payload, trailer, complete };

  bool parse() noexcept {
    for (uint8_t steps = steps_a_call; steps != 0; --steps) {
      if (cursor_ == stale_ && stage_ != Stage::hunting) {
        give_up(counters_.timeouts);
        continue;
      }
      if (cursor_ == end_) {
        if (stage_ == Stage::hunting) head_ = cursor_ = end_ = stale_ = 0;
        return false;
      }
      const uint8_t byte = bytes_[cursor_++];
      if (stage_ == Stage::payload) {
        take_payload(byte);
      } else if (stage_ == Stage::hunting) {
        hunt(byte);
      } else if (stage_ == Stage::header) {
        protocol_.add_header(byte);
        if (--left_ == 0) check_header(byte);
      } else if (byte != protocol_.trailer(trailer_at_)) {
        give_up(counters_.payload_checksum);
      } else if (++trailer_at_ == protocol_.trailer_size()) {
        protocol_.accepted();
        ++counters_.frames;
        stage_ = Stage::complete;
        return true;
      }
    }
    return false;
  }

  void hunt(uint8_t byte) noexcept {
    if (!Protocol::is_start(byte)) {
      ++counters_.skipped_bytes;
      head_ = cursor_;
      return;
    }
    head_ = static_cast<Index>(cursor_ - 1);
    left_ = header_size - 1;
    protocol_.begin(byte);
    stage_ = Stage::header;
  }

  void check_header(uint8_t sum) noexcept {
    const uint8_t id = bytes_[head_ + 1];
    const uint8_t size = bytes_[head_ + 2];
    if (static_cast<uint8_t>(id + size) != sum) return give_up(counters_.header_checksum);
    if (id == 0) return give_up(counters_.invalid_id);
    if (size > payload_capacity) return give_up(counters_.too_long);
    if (head_ > static_cast<Index>(payload_capacity + spare_size - size)) move_to_front();
    left_ = size;
    stage_ = Stage::payload;
    if (size == 0) expect_trailer();
  }

  void take_payload(uint8_t byte) noexcept {
    protocol_.add_payload(byte);
    if (--left_ == 0) expect_trailer();
  }

  void expect_trailer() noexcept {
    protocol_.finish();
    trailer_at_ = 0;
    stage_ = Stage::trailer;
  }

  /// The first byte was no start of a frame; those behind it are read again.
  void give_up(uint32_t& reason) noexcept {
    ++reason;
    ++counters_.skipped_bytes;
    ++head_;
    cursor_ = head_;
    stage_ = Stage::hunting;
  }

  void release() noexcept {
    if (stage_ != Stage::complete) return;
    head_ = cursor_;
    stage_ = Stage::hunting;
    if (head_ == end_) head_ = cursor_ = end_ = stale_ = 0;
  }

  /// No frame may continue across a long pause. The bytes before it may still hold whole frames: parse()
  /// gives up at the mark `stale_` whatever is incomplete there. A clock reading taken a little earlier than
  /// the last one (up to 16 s) is no pause; every other difference is.
  bool is_late(uint32_t now_us) const noexcept {
    const uint32_t passed_us = now_us - last_us_;
    // In units of 256 us: an 8-bit chip shifts by whole bytes for nothing, and compares half as many.
    return timeout_ != 0 && (passed_us >> tick_shift) > timeout_ && (passed_us >> 24) != 0xFFu;
  }

  /// Of two pauses only the later one is remembered. Bytes before the earlier one were left unread for as long as a time-out.
  void mark_pause() noexcept {
    if (stale_ > head_ && stale_ != end_) drop(static_cast<Index>(stale_ - head_));
    stale_ = end_;
  }

  /// A frame that begins in the first `steps_a_call` bytes ends within the buffer. If it is full all the same, reading has fallen behind.
  void make_room() noexcept {
    if (head_ < steps_a_call) drop(static_cast<Index>(steps_a_call - head_));
    move_to_front();
  }

  void drop(Index count) noexcept {
    ++counters_.overruns;
    counters_.skipped_bytes += count;
    head_ = static_cast<Index>(head_ + count);
    cursor_ = head_;
    stage_ = Stage::hunting;
  }

  void move_to_front() noexcept {
    memmove(bytes_, bytes_ + head_, static_cast<size_t>(end_ - head_));
    cursor_ = static_cast<Index>(cursor_ - head_);
    end_ = static_cast<Index>(end_ - head_);
    stale_ = static_cast<Index>(stale_ > head_ ? stale_ - head_ : 0);
    head_ = 0;
  }

  Index head_ = 0;    // first byte of the frame being read
  Index cursor_ = 0;  // next byte to read; head_ <= cursor_ <= end_
  Index end_ = 0;     // where the next byte goes; 0 when nothing is pending
  Index stale_ = 0;   // a long pause came before this position; 0 for none
  Stage stage_ = Stage::hunting;
  uint8_t left_ = 0;
  uint8_t trailer_at_ = 0;
  Protocol protocol_;
  uint16_t timeout_ = 0;  // in units of 256 us; 0 waits for ever
  uint32_t last_us_ = 0;  // when the last byte came
  ReceiverCounters counters_ = ReceiverCounters();
  uint8_t bytes_[buffer_size];
};

}  // namespace sbgc
}  // namespace thermopower
