// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <stdint.h>
#include <string.h>

/// @file flash.hpp
/// Constant tables that live in program memory where that is a separate address space (AVR), and in plain
/// memory elsewhere. A test replaces `THERMOPOWER_FLASH_HEADER` by a stand-in with shifted pointers, so that
/// reading flash as RAM fails on a PC too.

#if defined(THERMOPOWER_FLASH_HEADER)
#include THERMOPOWER_FLASH_HEADER
#elif defined(__AVR__)
#include <avr/pgmspace.h>
/// Places a table in program memory.
#define thermopower_flash PROGMEM
#else
#define thermopower_flash
#endif

namespace thermopower {
namespace detail {

#if !defined(THERMOPOWER_FLASH_HEADER)
/// The address of a table declared with `thermopower_flash`, for `read_flash` and nothing else.
template <class Value>
inline const Value* flash_pointer(const Value* table) noexcept {
  return table;
}

/// Copies a value of any plain type out of flash. `address` must point at an object declared with
/// `thermopower_flash`.
template <class Value>
inline Value read_flash(const Value* address) noexcept {
#if defined(__AVR__)
  Value value;
  memcpy_P(&value, address, sizeof value);
  return value;
#else
  return *address;
#endif
}

#if defined(__AVR__)
// One or two load instructions instead of a call: these are read in every control cycle.
template <>
inline uint8_t read_flash(const uint8_t* address) noexcept {
  return pgm_read_byte(address);
}
template <>
inline uint16_t read_flash(const uint16_t* address) noexcept {
  return pgm_read_word(address);
}
template <>
inline int16_t read_flash(const int16_t* address) noexcept {
  return static_cast<int16_t>(pgm_read_word(address));
}
template <>
inline float read_flash(const float* address) noexcept {
  return pgm_read_float(address);
}
#endif
#endif

}  // namespace detail
}  // namespace thermopower
