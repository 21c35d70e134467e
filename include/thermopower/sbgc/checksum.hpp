// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include <stdint.h>

/// @file
/// @brief The two checksums of the SimpleBGC protocol.

namespace thermopower {
namespace sbgc {

/// @brief Protocol v1: sum of the payload bytes modulo 256.
///
/// It misses swapped bytes, and about one random error in 256.
///
/// @snippet sbgc_examples.cpp checksum
/// How to: @ref wire_up_sbgc.
/// @ingroup sbgc
class Sum8 {
public:
  /// @brief Takes one more byte into account.
  void add(uint8_t byte) noexcept { sum_ = static_cast<uint8_t>(sum_ + byte); }
  /// @brief Checksum of the bytes added so far; 0 when there were none.
  uint8_t value() const noexcept { return sum_; }

private:
  uint8_t sum_ = 0;
};

/// @brief Protocol v2: CRC-16, polynomial 0x8005, initial value 0, data bits LSB first, register shifted
/// left, result not reflected, no final xor. Check value of "123456789": 0xBCDD.
///
/// It finds every change within any 16 neighbouring bits, so every change of a single byte.
/// Source: SimpleBGC serial protocol specification 2.5, appendix with the CRC.
///
/// @snippet sbgc_examples.cpp checksum
/// How to: @ref wire_up_sbgc.
/// @ingroup sbgc
class Crc16 {
public:
  /// @brief Takes one more byte into account.
  void add(uint8_t byte) noexcept {
    // The register is kept mirrored. Then a whole byte is one step, since for this polynomial the entry x of
    // the usual 256-word table is (x << 7) ^ (x << 6) ^ (x has odd parity ? 0xC001 : 0): no table, no loop
    // over bits.
    const uint8_t x = static_cast<uint8_t>(mirrored_ ^ byte);
    // Swapping halves is one instruction on AVR, shifting by four is a loop; the parity is the same.
    const uint8_t swapped = static_cast<uint8_t>((x << 4) | (x >> 4));
    uint8_t parity = static_cast<uint8_t>(x ^ swapped);
    parity = static_cast<uint8_t>(parity ^ static_cast<uint8_t>(parity >> 2));
    parity = static_cast<uint8_t>(parity ^ static_cast<uint8_t>(parity >> 1));
    uint16_t shifted = static_cast<uint16_t>(static_cast<uint16_t>(x) << 8);
    uint16_t next = static_cast<uint16_t>(mirrored_ >> 8);
    shifted = static_cast<uint16_t>(shifted >> 1);
    next = static_cast<uint16_t>(next ^ shifted);
    shifted = static_cast<uint16_t>(shifted >> 1);
    next = static_cast<uint16_t>(next ^ shifted);
    if (parity & 1) next = static_cast<uint16_t>(next ^ 0xC001u);
    mirrored_ = next;
  }

  /// @brief Checksum of the bytes added so far; 0 when there were none. Sent low byte first.
  uint16_t value() const noexcept {
    return static_cast<uint16_t>((static_cast<uint16_t>(mirror(static_cast<uint8_t>(mirrored_))) << 8) |
                                 mirror(static_cast<uint8_t>(mirrored_ >> 8)));
  }

private:
  static uint8_t mirror(uint8_t byte) noexcept {
    byte = static_cast<uint8_t>((byte << 4) | (byte >> 4));
    byte = static_cast<uint8_t>(((byte & 0x33) << 2) | ((byte >> 2) & 0x33));
    return static_cast<uint8_t>(((byte & 0x55) << 1) | ((byte >> 1) & 0x55));
  }

  uint16_t mirrored_ = 0;
};

}  // namespace sbgc
}  // namespace thermopower
