// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <stdint.h>
#include <string.h>

// Program memory as a PC does not have it: the address of a table in "flash" is no address that a program may
// read. Whoever reads through `read_flash` gets the value; whoever reads it as if it were RAM gets a
// segmentation fault, on the desk instead of nonsense on the chip. Put in place by THERMOPOWER_FLASH_HEADER.
#define thermopower_flash

namespace thermopower {
namespace detail {

// Bit 62 set: no address of any PC's user space.
const uintptr_t flash_shift = uintptr_t(1) << 62;

template <class Value>
inline const Value* flash_pointer(const Value* table) noexcept {
  return reinterpret_cast<const Value*>(reinterpret_cast<uintptr_t>(table) + flash_shift);
}

template <class Value>
inline Value read_flash(const Value* address) noexcept {
  Value value;
  memcpy(&value, reinterpret_cast<const void*>(reinterpret_cast<uintptr_t>(address) - flash_shift),
         sizeof value);
  return value;
}

}  // namespace detail
}  // namespace thermopower
