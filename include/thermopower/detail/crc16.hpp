// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <stdint.h>

/// @file crc16.hpp
/// The check sum of everything that is kept in a memory.

namespace thermopower {
namespace detail {

/// CRC-16/CCITT-FALSE: polynomial 0x1021, most significant bit first. It finds every change of up to three bits and
/// every change within 16 neighbouring bits of a record below 4 KB. @param sum  of what came before
inline uint16_t crc16(const uint8_t* bytes, uint16_t count, uint16_t sum = 0xffffu) noexcept {
  for (uint16_t i = 0; i < count; ++i) {
    sum = static_cast<uint16_t>(sum ^ static_cast<uint16_t>(static_cast<uint16_t>(bytes[i]) << 8));
    for (uint8_t step = 0; step < 8; ++step)
      sum = static_cast<uint16_t>((sum & 0x8000u) != 0 ? static_cast<uint16_t>(sum << 1) ^ 0x1021u
                                                       : static_cast<uint16_t>(sum << 1));
  }
  return sum;
}

}  // namespace detail
}  // namespace thermopower
