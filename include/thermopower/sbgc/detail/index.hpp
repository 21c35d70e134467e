// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include <stdint.h>

namespace thermopower {
namespace detail {

/// Smallest unsigned type for positions in a buffer: 8-bit positions halve the work per byte on 8-bit chips.
template <bool wide>
struct SbgcIndex {
  typedef uint8_t Type;
};

template <>
struct SbgcIndex<true> {
  typedef uint16_t Type;
};

}  // namespace detail
}  // namespace thermopower
