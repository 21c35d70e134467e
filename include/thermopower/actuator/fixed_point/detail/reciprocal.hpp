// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../../../detail/constexpr_math.hpp"
#include "../../../fixed_point/units.hpp"
#include "../../../detail/flash.hpp"

/// @file actuator/fixed_point/detail/reciprocal.hpp
/// Division by a number that may be small, without a division: normalise, look up, multiply.

namespace thermopower {
namespace fixed_point {
namespace detail {

template <class Nodes>
struct ReciprocalTable;

// 2^31 / x at x = 2^15 .. 2^16 in 32 pieces, less half of what a chord is above the curve. The two lowest
// bits of x are not used, so x counts as the middle of its four.
template <int... node>
struct ReciprocalTable<thermopower::detail::Indices<node...> > {
  static constexpr double divisor(int index) { return 32769.5 + 1024.0 * index; }
  static constexpr uint16_t value(double x) {
    return static_cast<uint16_t>(2147483648.0 / x - 281474976710656.0 / x / x / x + 0.5);
  }
  static constexpr uint16_t values[33] thermopower_flash = {value(divisor(node))...};
};
template <int... node>
constexpr uint16_t ReciprocalTable<thermopower::detail::Indices<node...> >::values[33];

/// 2^31 / divisor within 0.018 % + 1. @param divisor  2^15 .. 2^16 - 1
[[gnu::always_inline]] inline uint16_t reciprocal(uint16_t divisor) noexcept {
  typedef ReciprocalTable<thermopower::detail::MakeIndices<33>::Type> Table;
  const uint8_t high = static_cast<uint8_t>(divisor >> 8);
  uint8_t share = static_cast<uint8_t>(static_cast<uint8_t>(divisor) >> 2);
  // The divisor's bits 8 and 9: an 8-bit chip tests bits faster than it shifts.
  if ((high & 1u) != 0) share = static_cast<uint8_t>(share | 0x40u);
  if ((high & 2u) != 0) share = static_cast<uint8_t>(share | 0x80u);
  const uint16_t* node =
      thermopower::detail::flash_pointer(&Table::values[0]) + static_cast<uint8_t>((high >> 2) & 31u);
  const uint16_t below = thermopower::detail::read_flash(node),
                 above = thermopower::detail::read_flash(node + 1);
  const int16_t fall = static_cast<int16_t>(below - above);  // at most 1985
  return static_cast<uint16_t>(below - static_cast<uint16_t>(part_of(fall, share)));
}

/// 2^(15 + exponent) dividend factor / divisor, saturated at `most_heating()`; 0 where the divisor is
/// not positive. No loop takes more than eight rounds.
/// @param dividend  0 .. 32767  @param exponent  -8 .. 8
[[gnu::always_inline]] inline int32_t quotient(uint16_t dividend, uint8_t factor, int8_t exponent,
                                               int16_t divisor) noexcept {
  if (divisor <= 0) return 0;
  uint16_t normal = static_cast<uint16_t>(divisor);
  int8_t excess = static_cast<int8_t>(8 - exponent);
  // Whole bytes first: what takes longest is what is near to a pole.
  if (normal < 0x100u) {
    normal = static_cast<uint16_t>(normal << 8);
    excess = static_cast<int8_t>(excess - 8);
  }
  while ((normal & 0x8000u) == 0) {
    normal = static_cast<uint16_t>(normal << 1);
    --excess;
  }
  uint32_t result = product_of_three(dividend, reciprocal(normal), factor);
  if (excess >= 8) {
    result >>= 8;
    excess = static_cast<int8_t>(excess - 8);
  } else if (excess <= -8) {
    if (static_cast<uint16_t>(result >> 16) >= most_heating() >> 24) return most_heating();
    result <<= 8;
    excess = static_cast<int8_t>(excess + 8);
  }
  for (; excess > 0; --excess) result >>= 1;
  // Every bit that has passed through the highest byte tells whether it has grown too large.
  uint8_t passed = static_cast<uint8_t>(result >> 24);
  for (uint8_t left = static_cast<uint8_t>(-excess); left != 0; --left) {
    result <<= 1;
    passed = static_cast<uint8_t>(passed | static_cast<uint8_t>(result >> 24));
  }
  constexpr uint8_t too_large = static_cast<uint8_t>(0x100u - (most_heating() >> 24));
  return (passed & too_large) != 0 ? most_heating() : static_cast<int32_t>(result);
}

}  // namespace detail
}  // namespace fixed_point
}  // namespace thermopower
