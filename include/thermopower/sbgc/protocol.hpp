// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include <stdint.h>

#include "../detail/probe.hpp"
#include "checksum.hpp"

/// @file
/// @brief Protocol versions, and the policies that choose which of them a codec speaks.

namespace thermopower {
namespace detail {

/// The running checksum of one frame, as sbgc::ProtocolV1 has it.
template <class Candidate, class = int>
struct SbgcIsProtocol {
  static constexpr bool value = false;
};
template <class Candidate>
struct SbgcIsProtocol<
    Candidate,
    typename Exists<decltype(Candidate::is_start(uint8_t(0))), decltype(probe<Candidate>().begin(uint8_t(0))),
                    decltype(probe<Candidate>().add_header(uint8_t(0))),
                    decltype(probe<Candidate>().add_payload(uint8_t(0))),
                    decltype(probe<Candidate>().finish()), decltype(probe<const Candidate>().trailer_size()),
                    decltype(probe<const Candidate>().sending())>::Type> {
  static constexpr bool value = true;
};

}  // namespace detail

namespace sbgc {

/// @brief Version of a frame; the value is its first byte.
///
/// v1: `3E id size id+size payload sum`. v2: `24 id size id+size payload crc_low crc_high`, the CRC being
/// over everything but the first byte.
/// @ingroup sbgc
enum class Version : uint8_t {
  v1 = 0x3E,  ///< checksum of one byte, understood by every firmware
  v2 = 0x24   ///< CRC-16, newer firmware only
};

/// @brief Policy: protocol v1 only. Smallest and fastest; the default, as every board understands it.
///
/// A policy is the running checksum of one frame. To add one, offer the same members:
/// - ProtocolV1: when the board's firmware is old or unknown, or flash is short.
/// - ProtocolV2: when the board is known to speak v2; rejects every change of a single byte.
/// - ProtocolAuto: takes both, answers in the version it heard last: for an emulated board, a sniffer, a
/// desktop
///   program. A v2 frame whose first byte is damaged into the one of v1 has one chance in 256 to pass.
///
/// @snippet sbgc_examples.cpp receiver
/// How to: @ref wire_up_sbgc.
/// @ingroup sbgc
class ProtocolV1 {
public:
  /// @brief Constants of its frames.
  enum : uint8_t { overhead = 5 /**< bytes of a frame besides its payload */ };

  /// @brief Can a frame start with this byte?
  static constexpr bool is_start(uint8_t byte) noexcept { return byte == static_cast<uint8_t>(Version::v1); }
  /// @brief A frame with this first byte begins.
  void begin(uint8_t /*start*/) noexcept { sum_ = Sum8(); }
  /// @brief One of the three header bytes after the first.
  void add_header(uint8_t) noexcept {}
  /// @brief One byte of the payload.
  void add_payload(uint8_t byte) noexcept { sum_.add(byte); }
  /// @brief The payload is complete; trailer() is asked next.
  void finish() noexcept {}
  /// @brief Number of checksum bytes of the frame begun last.
  static constexpr uint8_t trailer_size() noexcept { return 1; }
  /// @brief Checksum byte at `index`, 0 first.
  uint8_t trailer(uint8_t /*index*/) const noexcept { return sum_.value(); }
  /// @brief The frame was received and is valid.
  void accepted() noexcept {}
  /// @brief Version to send in.
  static constexpr Version sending() noexcept { return Version::v1; }

private:
  Sum8 sum_;
};

/// @brief Policy: protocol v2 only. Members as in ProtocolV1, which also says when to take which.
///
/// @snippet sbgc_examples.cpp receiver
/// How to: @ref wire_up_sbgc.
/// @ingroup sbgc
class ProtocolV2 {
public:
  /// @brief Constants of its frames.
  enum : uint8_t { overhead = 6 /**< bytes of a frame besides its payload */ };

  /// @copydoc ProtocolV1::is_start
  static constexpr bool is_start(uint8_t byte) noexcept { return byte == static_cast<uint8_t>(Version::v2); }
  /// @copydoc ProtocolV1::begin
  void begin(uint8_t /*start*/) noexcept { crc_ = Crc16(); }
  /// @copydoc ProtocolV1::add_header
  void add_header(uint8_t byte) noexcept { crc_.add(byte); }
  /// @copydoc ProtocolV1::add_payload
  void add_payload(uint8_t byte) noexcept { crc_.add(byte); }
  /// @copydoc ProtocolV1::finish
  void finish() noexcept { sent_ = crc_.value(); }
  /// @copydoc ProtocolV1::trailer_size
  static constexpr uint8_t trailer_size() noexcept { return 2; }
  /// @copydoc ProtocolV1::trailer
  uint8_t trailer(uint8_t index) const noexcept {
    return static_cast<uint8_t>(index == 0 ? sent_ : sent_ >> 8);
  }
  /// @copydoc ProtocolV1::accepted
  void accepted() noexcept {}
  /// @copydoc ProtocolV1::sending
  static constexpr Version sending() noexcept { return Version::v2; }

private:
  Crc16 crc_;
  uint16_t sent_ = 0;
};

/// @brief Policy: receives v1 and v2 mixed and sends in the version of the last valid frame (v1 before the
/// first). Members as in ProtocolV1, which also says when to take which.
///
/// @snippet sbgc_examples.cpp receiver
/// How to: @ref wire_up_sbgc.
/// @ingroup sbgc
class ProtocolAuto {
public:
  /// @brief Constants of its frames.
  enum : uint8_t { overhead = 6 /**< bytes of a frame besides its payload, at most */ };

  /// @copydoc ProtocolV1::is_start
  static constexpr bool is_start(uint8_t byte) noexcept {
    return ProtocolV1::is_start(byte) || ProtocolV2::is_start(byte);
  }
  /// @copydoc ProtocolV1::begin
  void begin(uint8_t start) noexcept {
    is_v2_ = ProtocolV2::is_start(start);
    v1_.begin(start);
    v2_.begin(start);
  }
  /// @copydoc ProtocolV1::add_header
  void add_header(uint8_t byte) noexcept {
    if (is_v2_) v2_.add_header(byte);
  }
  /// @copydoc ProtocolV1::add_payload
  void add_payload(uint8_t byte) noexcept { is_v2_ ? v2_.add_payload(byte) : v1_.add_payload(byte); }
  /// @copydoc ProtocolV1::finish
  void finish() noexcept {
    if (is_v2_) v2_.finish();
  }
  /// @copydoc ProtocolV1::trailer_size
  uint8_t trailer_size() const noexcept { return is_v2_ ? v2_.trailer_size() : v1_.trailer_size(); }
  /// @copydoc ProtocolV1::trailer
  uint8_t trailer(uint8_t index) const noexcept { return is_v2_ ? v2_.trailer(index) : v1_.trailer(index); }
  /// @copydoc ProtocolV1::accepted
  void accepted() noexcept { sending_ = is_v2_ ? Version::v2 : Version::v1; }
  /// @copydoc ProtocolV1::sending
  Version sending() const noexcept { return sending_; }
  /// @brief Sends in this version until a frame of the other one arrives.
  void send_in(Version version) noexcept { sending_ = version; }
  /// @brief Sends in the other version until a frame arrives: call it while a board does not answer, to find the version
  /// that it speaks.
  void try_other() noexcept { sending_ = sending_ == Version::v1 ? Version::v2 : Version::v1; }

private:
  ProtocolV1 v1_;
  ProtocolV2 v2_;
  bool is_v2_ = false;
  Version sending_ = Version::v1;
};

}  // namespace sbgc
}  // namespace thermopower
