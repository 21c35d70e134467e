// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <stdint.h>
#include <string.h>

#include "../../fixed_point/detail/product.hpp"

/// @file monitor/detail/binary_scale.hpp
/// Constants as whole numbers that the compiler computes, and numbers at the door of the monitor.

namespace thermopower {
namespace detail {

/// factor / 65536 * 2^shift. The shift is whole bytes, which an AVR moves and does not shift; 8 to 16 bits of the
/// factor are left, so a constant is right to two tenths of a percent.
struct BinaryScale {
  uint16_t factor;
  int8_t shift;
};

constexpr int8_t binary_shift(double x) {
  return x >= 1.0
             ? static_cast<int8_t>(binary_shift(x * (1.0 / 256.0)) + 8)
             : (x < 1.0 / 256.0 && x > 1e-9 ? static_cast<int8_t>(binary_shift(x * 256.0) - 8) : int8_t(0));
}
constexpr double power_of_two(int exponent) {
  return exponent > 0 ? 2.0 * power_of_two(exponent - 1)
                      : (exponent < 0 ? 0.5 * power_of_two(exponent + 1) : 1.0);
}
constexpr uint16_t binary_factor(double mantissa) {
  return mantissa * 65536.0 + 0.5 >= 65535.0 ? uint16_t(65535)
                                             : static_cast<uint16_t>(mantissa * 65536.0 + 0.5);
}
/// @param x  0, or 1e-9 and more
constexpr BinaryScale binary_scale(double x) {
  return BinaryScale{binary_factor(x * power_of_two(-binary_shift(x))), binary_shift(x)};
}

/// Exponent of two by which a quantity up to `full` becomes a count: full * 2^exponent is within 4096 .. 8192.
constexpr uint8_t count_exponent(double full, int exponent = 0) {
  return full * power_of_two(exponent) > 8192.0
             ? count_exponent(full, exponent - 1)
             : (full * power_of_two(exponent + 1) <= 8192.0 ? count_exponent(full, exponent + 1)
                                                            : static_cast<uint8_t>(exponent));
}
/// What 8192 counts are: `full`, or up to twice as much.
constexpr double counted_full(double full) {
  return 8192.0 * power_of_two(-static_cast<int8_t>(count_exponent(full)));
}

/// The products, each once in a program: they are many, and inlined ones would run out of an AVR's registers.
[[gnu::noinline]] inline int32_t scaled(int32_t value, uint16_t factor) noexcept {
  return fixed_point::detail::scaled(value, factor);
}
[[gnu::noinline]] inline int32_t product(int16_t value, uint16_t factor) noexcept {
  return fixed_point::detail::product(value, factor);
}

/// value times the scale, rounded down. The result must fit.
[[gnu::always_inline]] inline int32_t times(int32_t value, BinaryScale scale) noexcept {
  return scale.shift > 0 ? scaled(static_cast<int32_t>(static_cast<uint32_t>(value)
                                                       << (scale.shift > 0 ? scale.shift : 0)),
                                  scale.factor)
                         : scaled(value, scale.factor) >> (scale.shift < 0 ? -scale.shift : 0);
}

/// Within -32000 .. 32000.
inline int16_t saturated(int32_t value) noexcept {
  return value > 32000 ? int16_t(32000) : (value < -32000 ? int16_t(-32000) : static_cast<int16_t>(value));
}

/// The upper 17 bits, as a number: value / 32768.
inline int16_t upper(int32_t value) noexcept {
  return static_cast<int16_t>(static_cast<int32_t>(static_cast<uint32_t>(value) << 1) >> 16);
}
/// A fraction of a term's size, in 256ths, and one more.
inline uint16_t part(int16_t term, uint8_t share) noexcept {
  return static_cast<uint16_t>(
      fixed_point::detail::part_of(term < 0 ? static_cast<int16_t>(-term) : term, share) + 1);
}

inline uint16_t size_of(int16_t value) noexcept { return static_cast<uint16_t>(value < 0 ? -value : value); }

/// What `to_count` gives for a number that is none, or too large.
constexpr int16_t no_count() { return -32767 - 1; }

/// The upper half of a float's bits at compile time; x >= 2^-20.
constexpr uint16_t upper_bits(double x, int power = 127) {
  return x >= 2.0  ? upper_bits(x * 0.5, power + 1)
         : x < 1.0 ? upper_bits(x * 2.0, power - 1)
                   : static_cast<uint16_t>(power * 128 + static_cast<int>((x - 1.0) * 128.0));
}

/// x * 2^exponent, cut to a whole number; `no_count()` where |x| is above the limit, or x is not a number.
/// @param limit  upper bits of the largest |x|; with the exponent it must stay below 32768
[[gnu::noinline]] inline int16_t to_count(float x, uint16_t limit, uint8_t exponent) noexcept {
  uint32_t bits;
  memcpy(&bits, &x, sizeof bits);
  const uint16_t high = static_cast<uint16_t>(bits >> 16);
  const uint16_t size = high & 0x7fffu;
  if (size >= limit) return no_count();
  // 1.m * 2^(power - 127 + exponent), of which 16 bits of 1.m are enough.
  const uint8_t power = static_cast<uint8_t>(static_cast<uint16_t>(size << 1) >> 8);
  const uint8_t most = static_cast<uint8_t>(142u - exponent);
  if (most > power + 15u) return 0;
  uint16_t whole = static_cast<uint16_t>(static_cast<uint16_t>(bits >> 8) | 0x8000u);
  uint8_t shift = static_cast<uint8_t>(most - power);
  if (shift >= 8) {
    whole = static_cast<uint16_t>(whole >> 8);
    shift = static_cast<uint8_t>(shift - 8u);
  }
  whole = static_cast<uint16_t>(whole >> shift);
  return (high & 0x8000u) != 0 ? static_cast<int16_t>(-static_cast<int16_t>(whole))
                               : static_cast<int16_t>(whole);
}

}  // namespace detail
}  // namespace thermopower
