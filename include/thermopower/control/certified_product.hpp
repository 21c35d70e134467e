// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <stdint.h>

/// @file certified_product.hpp
/// The products that the certified limiter is made of. For AVR they are written out: its compiler calls a
/// 32-bit multiplication for what a few 8-bit ones do in a third of the time. The results are the same to the
/// bit, which a test on the chip confirms (tests/unit/beyond/avr_cost).

namespace thermopower {
namespace detail {

/// The same products in the language itself: what runs everywhere but on AVR, and what AVR is compared with.
namespace portable {

/// floor(value * fraction / 65536), for both signs.
inline int32_t part_down(int32_t value, uint16_t fraction) noexcept {
  const int16_t high = static_cast<int16_t>(value >> 16);
  const uint16_t low = static_cast<uint16_t>(value);
  return static_cast<int32_t>(high) * fraction +
         static_cast<int32_t>((static_cast<uint32_t>(low) * fraction) >> 16);
}
/// left * right, whole.
inline uint32_t product(uint16_t left, uint16_t right) noexcept {
  return static_cast<uint32_t>(left) * right;
}
/// value * count; must fit.
inline int32_t times(int32_t value, uint8_t count) noexcept { return value * static_cast<int32_t>(count); }

}  // namespace portable

#if defined(__AVR__)

/// floor(value * fraction / 65536), for both signs.
[[gnu::noinline]] inline int32_t part_down(int32_t value, uint16_t fraction) noexcept {
  int32_t result;
  uint8_t rest, zero;
  asm("clr %[zero]\n\t"
      "mul %B[value], %B[fraction]\n\t"
      "movw %A[result], r0\n\t"
      "mulsu %D[value], %B[fraction]\n\t"
      "movw %C[result], r0\n\t"
      "mul %A[value], %A[fraction]\n\t"
      "mov %[rest], r1\n\t"
      "mul %A[value], %B[fraction]\n\t"
      "add %[rest], r0\n\t"
      "adc %A[result], r1\n\t"
      "adc %B[result], %[zero]\n\t"
      "adc %C[result], %[zero]\n\t"
      "adc %D[result], %[zero]\n\t"
      "mul %B[value], %A[fraction]\n\t"
      "add %[rest], r0\n\t"
      "adc %A[result], r1\n\t"
      "adc %B[result], %[zero]\n\t"
      "adc %C[result], %[zero]\n\t"
      "adc %D[result], %[zero]\n\t"
      "mul %C[value], %A[fraction]\n\t"
      "add %A[result], r0\n\t"
      "adc %B[result], r1\n\t"
      "adc %C[result], %[zero]\n\t"
      "adc %D[result], %[zero]\n\t"
      "mul %C[value], %B[fraction]\n\t"
      "add %B[result], r0\n\t"
      "adc %C[result], r1\n\t"
      "adc %D[result], %[zero]\n\t"
      "mulsu %D[value], %A[fraction]\n\t"
      "sbc %D[result], %[zero]\n\t"
      "add %B[result], r0\n\t"
      "adc %C[result], r1\n\t"
      "adc %D[result], %[zero]\n\t"
      "clr r1"
      : [result] "=&r"(result), [rest] "=&r"(rest), [zero] "=&r"(zero)
      : [value] "a"(value), [fraction] "a"(fraction)
      : "r0");
  return result;
}

/// left * right, whole.
[[gnu::always_inline]] inline uint32_t product(uint16_t left, uint16_t right) noexcept {
  uint32_t result;
  uint8_t zero;
  asm("clr %[zero]\n\t"
      "mul %A[left], %A[right]\n\t"
      "movw %A[result], r0\n\t"
      "mul %B[left], %B[right]\n\t"
      "movw %C[result], r0\n\t"
      "mul %A[left], %B[right]\n\t"
      "add %B[result], r0\n\t"
      "adc %C[result], r1\n\t"
      "adc %D[result], %[zero]\n\t"
      "mul %B[left], %A[right]\n\t"
      "add %B[result], r0\n\t"
      "adc %C[result], r1\n\t"
      "adc %D[result], %[zero]\n\t"
      "clr r1"
      : [result] "=&r"(result), [zero] "=&r"(zero)
      : [left] "r"(left), [right] "r"(right)
      : "r0");
  return result;
}

/// value * count; must fit.
[[gnu::always_inline]] inline int32_t times(int32_t value, uint8_t count) noexcept {
  int32_t result;
  asm("mul %A[value], %[count]\n\t"
      "movw %A[result], r0\n\t"
      "mul %C[value], %[count]\n\t"
      "movw %C[result], r0\n\t"
      "mul %B[value], %[count]\n\t"
      "add %B[result], r0\n\t"
      "adc %C[result], r1\n\t"
      "brcc .+2\n\t"
      "inc %D[result]\n\t"
      "mul %D[value], %[count]\n\t"
      "add %D[result], r0\n\t"
      "clr r1"
      : [result] "=&r"(result)
      : [value] "r"(value), [count] "r"(count)
      : "r0");
  return result;
}

#else

using portable::part_down;
using portable::product;
using portable::times;

#endif

}  // namespace detail
}  // namespace thermopower
