// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include <stdint.h>

#include "protocol.hpp"

/// @file
/// @brief A received frame, and how numbers lie in its payload (little-endian).

namespace thermopower {
namespace sbgc {

/// @brief A valid frame: a view of the receiver's buffer, not a copy.
///
/// It stays valid until the receiver that gave it is called again (receive(), next(), poll(), clear()).
/// This is also the raw access to commands the library has no type for.
/// @ingroup sbgc
struct Frame {
  uint8_t id;              ///< command, 1..255; 0 means there is no frame
  uint8_t size;            ///< bytes in the payload, 0..255
  const uint8_t* payload;  ///< the payload; null when there is no frame
  Version version;         ///< protocol version it came in
};

/// @brief A run of bytes somewhere else: part of a payload that has no fixed layout.
/// @ingroup sbgc
struct Bytes {
  const uint8_t* data;  ///< first byte; may be null when `size` is 0
  uint8_t size;         ///< number of bytes
};

/// @brief Unsigned 16 bits at `at`; no alignment needed.
/// @ingroup sbgc
inline uint16_t read_u16(const uint8_t* at) noexcept {
  return static_cast<uint16_t>(at[0] | (static_cast<uint16_t>(at[1]) << 8));
}

/// @brief Signed 16 bits (two's complement) at `at`.
/// @ingroup sbgc
inline int16_t read_i16(const uint8_t* at) noexcept { return static_cast<int16_t>(read_u16(at)); }

/// @brief Unsigned 32 bits at `at`.
/// @ingroup sbgc
inline uint32_t read_u32(const uint8_t* at) noexcept {
  return static_cast<uint32_t>(read_u16(at)) | (static_cast<uint32_t>(read_u16(at + 2)) << 16);
}

/// @brief Signed 32 bits (two's complement) at `at`.
/// @ingroup sbgc
inline int32_t read_i32(const uint8_t* at) noexcept { return static_cast<int32_t>(read_u32(at)); }

}  // namespace sbgc
}  // namespace thermopower
