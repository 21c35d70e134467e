// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../../detail/check.hpp"

/// @file control/certified/arithmetic.hpp
/// Whole-number arithmetic of the certified limiter: every rounding goes to the safe side, and a PC and an
/// 8-bit chip agree to the bit. A float's own rounding would decide the result: at 60 degC it is coarser than
/// what a body warms in 10 ms.
///
/// For AVR the products are written out: its compiler calls a 32-bit multiplication for what a few 8-bit ones do
/// in a third of the time. The results are the same to the bit, which a test on the chip confirms
/// (tests/control/on_avr).

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

/// A temperature or temperature difference in 2^-18 K, +-8191 K.
typedef int32_t KelvinUnits;
/// A fraction 0 .. 1 in 2^-16: coarse, and a multiplication by it is cheap.
typedef uint16_t UnitFraction;
/// A fraction 0 .. 1 in 2^-32: fine enough for the part of an hour that ten milliseconds are.
typedef uint32_t FineFraction;

/// Units in a kelvin.
constexpr float units_per_K() { return 262144.0f; }
/// 1 - 2^-16: the largest coarse fraction. What stands for a whole is multiplied by `whole_margin()` to make
/// up for it.
constexpr UnitFraction whole_fraction() { return 0xffffu; }
/// 1 + 2^-15.
constexpr float whole_margin() { return 1.0f + 1.0f / 32768.0f; }
/// Covers the rounding of the float arithmetic that made a constant: 2^-18, sixty-four float roundings.
constexpr float float_margin() { return 1.0f / 262144.0f; }
/// The most that full power may warm a node in the end: sums of two such rises and a temperature stay in
/// range.
constexpr float highest_rise_K() { return 3000.0f; }

/// A positive number not below `value`; saturates.
inline int32_t rounded_up(float value) noexcept {
  const float wide = value * (1.0f + float_margin()) + 1.0f;
  if (!(wide > 0.0f)) return 0;
  return wide < 2147483000.0f ? static_cast<int32_t>(wide) : 0x7fffffffL;
}
/// A number not above `value` >= 0.
inline int32_t rounded_down(float value) noexcept {
  const float narrow = value * (1.0f - float_margin()) - 1.0f;
  if (!(narrow > 0.0f)) return 0;
  return narrow < 2147483000.0f ? static_cast<int32_t>(narrow) : 0x7fffffffL;
}
/// A difference of temperature, towards hot. @param difference_K  >= 0
inline KelvinUnits kelvin_up(float difference_K) noexcept { return rounded_up(difference_K * units_per_K()); }
/// A difference of temperature per count, towards hot. Ends at 15 K: more is refused by validate(), and its
/// sums must stay in range until then. @param difference_K  >= 0
inline KelvinUnits kelvin_per_count_up(float difference_K) noexcept {
  const KelvinUnits units = kelvin_up(difference_K);
  return units < 4000000L ? units : 4000000L;
}
/// A fraction, towards one. @param fraction  >= 0
inline UnitFraction fraction_up(float fraction) noexcept {
  // Written out, because it is needed whenever the supply moves: a power of two multiplies without rounding.
  const float wide = fraction * (65536.0f * (1.0f + float_margin())) + 1.0f;
  return is_from_zero_to(wide, 65535.0f) ? static_cast<UnitFraction>(wide) : whole_fraction();
}
/// A fraction, towards zero.
inline UnitFraction fraction_down(float fraction) noexcept {
  const int32_t whole = rounded_down(fraction * 65536.0f);
  return whole < 0xffffL ? static_cast<UnitFraction>(whole) : whole_fraction();
}
/// A fine fraction, towards one.
inline FineFraction fine_up(float fraction) noexcept {
  const float wide = fraction * (1.0f + float_margin()) * 4294967296.0f + 1.0f;
  return wide < 4294967000.0f ? static_cast<FineFraction>(wide) : 0xffffffffUL;
}
/// A fine fraction, towards zero. @param fraction  0 .. 0.99
inline FineFraction fine_down(float fraction) noexcept {
  const float narrow = fraction * (1.0f - float_margin()) * 4294967296.0f - 1.0f;
  return narrow > 0.0f ? static_cast<FineFraction>(narrow) : 0u;
}
/// An absolute temperature, towards 0 degC by less than a unit. NaN and what is beyond 4000 degC count as
/// 4000 degC.
inline KelvinUnits celsius_units(float temperature_C) noexcept {
  if (is_from_zero_to(temperature_C, 4000.0f)) return static_cast<KelvinUnits>(temperature_C * units_per_K());
  if (!(temperature_C < 4000.0f)) return static_cast<KelvinUnits>(4000.0f * units_per_K());
  return static_cast<KelvinUnits>((temperature_C > -300.0f ? temperature_C : -300.0f) * units_per_K());
}
/// Back to a float.
inline float celsius_from(KelvinUnits units) noexcept {
  return static_cast<float>(units) * (1.0f / units_per_K());
}

/// Not below value * fraction.
inline int32_t part_up(int32_t value, UnitFraction fraction) noexcept {
  return part_down(value, fraction) + 1;
}

/// How often `size` goes into `room`: the largest count 0 .. `most` with count * size <= room.
/// @param size  >= 0, and `most` times it must fit
inline uint8_t count_within(int32_t room, int32_t size, uint8_t most) noexcept {
  if (room < 0) return 0;
  if (times(size, most) <= room) return most;  // the usual case
  // Below 255 the quotient has eight bits: eight steps of a long division cost a quarter of a general one.
  uint32_t left = static_cast<uint32_t>(room), part = static_cast<uint32_t>(size) << 7;
  uint8_t count = 0;
  for (uint8_t step = 0; step < 8; ++step) {
    count = static_cast<uint8_t>(count << 1);
    if (left >= part) {
      left -= part;
      ++count;
    }
    part >>= 1;
  }
  return count;
}

/// An upper bound of a temperature, kept to 2^-50 K so that its changes are added without any rounding.
class UpperBound {
public:
  /// Not above the bound, by less than a unit.
  KelvinUnits below() const noexcept { return high_; }
  /// Not below the bound.
  KelvinUnits above() const noexcept { return high_ + 1; }
  /// Sets the bound.
  void set(KelvinUnits value) noexcept {
    high_ = value;
    low_ = 0;
  }
  /// Raises the bound; never lowers it.
  void raise(KelvinUnits floor) noexcept {
    if (high_ < floor) set(floor);
  }
  /// Raises the bound to another, kept as finely; never lowers it.
  void raise(const UpperBound& other) noexcept {
    if (high_ < other.high_ || (high_ == other.high_ && low_ < other.low_)) *this = other;
  }
  /// Adds a fraction of a distance, of either sign, exactly.
  void advance(KelvinUnits distance, FineFraction fraction) noexcept {
    // Four products of 16 bits without a sign, which an 8-bit chip has in hardware; what a negative distance adds
    // too much is a whole `fraction` in the upper half.
    const uint16_t distance_high = static_cast<uint16_t>(static_cast<uint32_t>(distance) >> 16);
    const uint16_t distance_low = static_cast<uint16_t>(distance);
    const uint16_t fraction_low = static_cast<uint16_t>(fraction);
    const uint16_t fraction_high = static_cast<uint16_t>(fraction >> 16);
    const uint32_t lowest = product(distance_low, fraction_low), other = product(distance_high, fraction_low);
    uint32_t middle = (lowest >> 16) + static_cast<uint16_t>(other);
    uint32_t upper = other >> 16;
    if (fraction_high != 0) {
      const uint32_t another = product(distance_low, fraction_high);
      middle += static_cast<uint16_t>(another);
      upper += product(distance_high, fraction_high) + (another >> 16);
    }
    upper += middle >> 16;
    if (distance < 0) upper -= fraction;
    const uint32_t added = (middle << 16) | static_cast<uint16_t>(lowest);
    low_ += added;
    if (low_ < added) ++upper;
    high_ = static_cast<KelvinUnits>(static_cast<uint32_t>(high_) + upper);
  }

private:
  KelvinUnits high_ = 0;
  uint32_t low_ = 0;
};

}  // namespace detail
}  // namespace thermopower
