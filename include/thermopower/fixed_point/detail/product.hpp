// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <stdint.h>

/// @file fixed_point/detail/product.hpp
/// The products that fixed-point controllers are made of. For AVR they are written out: its compiler calls a
/// 32-bit multiplication for what a few 8-bit ones do in a third of the time. The results are the same to the
/// bit, which a test on the chip confirms.

namespace thermopower {
namespace fixed_point {
namespace detail {

#if defined(__AVR__)

/// value * factor / 65536 to the nearest whole number, halves up.
[[gnu::always_inline]] inline int32_t scaled(int32_t value, uint16_t factor) noexcept {
  int32_t result;
  uint8_t rest, zero;
  asm("clr %[zero]\n\t"
      "ldi %[rest], 0x80\n\t"
      "mul %B[value], %B[factor]\n\t"
      "movw %A[result], r0\n\t"
      "mulsu %D[value], %B[factor]\n\t"
      "movw %C[result], r0\n\t"
      "mul %A[value], %A[factor]\n\t"
      "add %[rest], r1\n\t"
      "adc %A[result], %[zero]\n\t"
      "adc %B[result], %[zero]\n\t"
      "adc %C[result], %[zero]\n\t"
      "adc %D[result], %[zero]\n\t"
      "mul %A[value], %B[factor]\n\t"
      "add %[rest], r0\n\t"
      "adc %A[result], r1\n\t"
      "adc %B[result], %[zero]\n\t"
      "adc %C[result], %[zero]\n\t"
      "adc %D[result], %[zero]\n\t"
      "mul %B[value], %A[factor]\n\t"
      "add %[rest], r0\n\t"
      "adc %A[result], r1\n\t"
      "adc %B[result], %[zero]\n\t"
      "adc %C[result], %[zero]\n\t"
      "adc %D[result], %[zero]\n\t"
      "mul %C[value], %A[factor]\n\t"
      "add %A[result], r0\n\t"
      "adc %B[result], r1\n\t"
      "adc %C[result], %[zero]\n\t"
      "adc %D[result], %[zero]\n\t"
      "mul %C[value], %B[factor]\n\t"
      "add %B[result], r0\n\t"
      "adc %C[result], r1\n\t"
      "adc %D[result], %[zero]\n\t"
      "mulsu %D[value], %A[factor]\n\t"
      "sbc %D[result], %[zero]\n\t"
      "add %B[result], r0\n\t"
      "adc %C[result], r1\n\t"
      "adc %D[result], %[zero]\n\t"
      "clr r1"
      : [result] "=&r"(result), [rest] "=&d"(rest), [zero] "=&r"(zero)
      : [value] "a"(value), [factor] "a"(factor)
      : "r0");
  return result;
}

/// value * factor. @param factor  below 32768
[[gnu::always_inline]] inline int32_t product(int16_t value, uint16_t factor) noexcept {
  int32_t result;
  uint8_t zero;
  asm("clr %[zero]\n\t"
      "mul %A[value], %A[factor]\n\t"
      "movw %A[result], r0\n\t"
      "mulsu %B[value], %B[factor]\n\t"
      "movw %C[result], r0\n\t"
      "mul %A[value], %B[factor]\n\t"
      "add %B[result], r0\n\t"
      "adc %C[result], r1\n\t"
      "adc %D[result], %[zero]\n\t"
      "mulsu %B[value], %A[factor]\n\t"
      "sbc %D[result], %[zero]\n\t"
      "add %B[result], r0\n\t"
      "adc %C[result], r1\n\t"
      "adc %D[result], %[zero]\n\t"
      "clr r1"
      : [result] "=&r"(result), [zero] "=&r"(zero)
      : [value] "a"(value), [factor] "a"(factor)
      : "r0");
  return result;
}

/// (left * right / 256, rounded down) * factor; the first product must be below 2^31.
[[gnu::always_inline]] inline uint32_t product_of_three(uint16_t left, uint16_t right,
                                                        uint8_t factor) noexcept {
  uint32_t result;
  uint8_t rest, zero;
  asm("clr %[zero]\n\t"
      "mul %A[left], %A[right]\n\t"
      "mov %[rest], r1\n\t"
      "mul %B[left], %B[right]\n\t"
      "movw %C[result], r0\n\t"
      "mul %A[left], %B[right]\n\t"
      "add %[rest], r0\n\t"
      "adc %C[result], r1\n\t"
      "adc %D[result], %[zero]\n\t"
      "mul %B[left], %A[right]\n\t"
      "add %[rest], r0\n\t"
      "adc %C[result], r1\n\t"
      "adc %D[result], %[zero]\n\t"
      "mul %[rest], %[factor]\n\t"
      "movw %A[result], r0\n\t"
      "mul %C[result], %[factor]\n\t"
      "mov %C[result], r1\n\t"
      "mov %[rest], r0\n\t"
      "mul %D[result], %[factor]\n\t"
      "mov %D[result], r1\n\t"
      "add %B[result], %[rest]\n\t"
      "adc %C[result], r0\n\t"
      "adc %D[result], %[zero]\n\t"
      "clr r1"
      : [result] "=&r"(result), [rest] "=&r"(rest), [zero] "=&r"(zero)
      : [left] "r"(left), [right] "r"(right), [factor] "r"(factor)
      : "r0");
  return result;
}

/// left * right / 32768, rounded down; the quotient must fit.
[[gnu::always_inline]] inline int16_t product_q15(int16_t left, int16_t right) noexcept {
  int16_t result;
  uint8_t rest, zero;
  asm("clr %[zero]\n\t"
      "muls %B[left], %B[right]\n\t"
      "movw %A[result], r0\n\t"
      "mul %A[left], %A[right]\n\t"
      "mov %[rest], r1\n\t"
      "mulsu %B[left], %A[right]\n\t"
      "sbc %B[result], %[zero]\n\t"
      "add %[rest], r0\n\t"
      "adc %A[result], r1\n\t"
      "adc %B[result], %[zero]\n\t"
      "mulsu %B[right], %A[left]\n\t"
      "sbc %B[result], %[zero]\n\t"
      "add %[rest], r0\n\t"
      "adc %A[result], r1\n\t"
      "adc %B[result], %[zero]\n\t"
      "lsl %[rest]\n\t"
      "rol %A[result]\n\t"
      "rol %B[result]\n\t"
      "clr r1"
      : [result] "=&r"(result), [rest] "=&r"(rest), [zero] "=&r"(zero)
      : [left] "a"(left), [right] "a"(right)
      : "r0");
  return result;
}

/// change * share / 256, rounded down.
inline int16_t part_of(int16_t change, uint8_t share) noexcept {
  int16_t result;
  asm("mul %A[change], %[share]\n\t"
      "mov %A[result], r1\n\t"
      "clr %B[result]\n\t"
      "mulsu %B[change], %[share]\n\t"
      "add %A[result], r0\n\t"
      "adc %B[result], r1\n\t"
      "clr r1"
      : [result] "=&r"(result)
      : [change] "a"(change), [share] "a"(share)
      : "r0");
  return result;
}

#else

/// value * factor / 65536 to the nearest whole number, halves up.
inline int32_t scaled(int32_t value, uint16_t factor) noexcept {
  const int32_t high = value >> 16;  // not above 2^15, so that the product fits
  const uint32_t low = static_cast<uint32_t>(value) & 0xFFFFu;
  const uint32_t rest = low * factor + 0x8000u;
  return high * static_cast<int32_t>(factor) + static_cast<int32_t>(rest >> 16);
}

/// value * factor. @param factor  below 32768
inline int32_t product(int16_t value, uint16_t factor) noexcept {
  return static_cast<int32_t>(value) * static_cast<int32_t>(factor);
}

/// (left * right / 256, rounded down) * factor; the first product must be below 2^31.
inline uint32_t product_of_three(uint16_t left, uint16_t right, uint8_t factor) noexcept {
  return (static_cast<uint32_t>(left) * right >> 8) * factor;
}

/// left * right / 32768, rounded down; the quotient must fit.
inline int16_t product_q15(int16_t left, int16_t right) noexcept {
  return static_cast<int16_t>((static_cast<int32_t>(left) * right) >> 15);
}

/// change * share / 256, rounded down.
inline int16_t part_of(int16_t change, uint8_t share) noexcept {
  return static_cast<int16_t>((static_cast<int32_t>(change) * share) >> 8);
}

#endif

}  // namespace detail
}  // namespace fixed_point
}  // namespace thermopower
