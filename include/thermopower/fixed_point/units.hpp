// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <stdint.h>

#include "detail/product.hpp"

/// @file fixed_point/units.hpp
/// Units and products of the fixed-point controllers. Each unit is chosen so that the shifts between them are
/// whole bytes, which an 8-bit chip gets for nothing.

namespace thermopower {
namespace fixed_point {

/// A temperature or a difference of temperatures in 2^-23 K: -256 .. 256 degC.
typedef int32_t Temperature;
/// A temperature in 2^-7 K: the upper half of a Temperature.
typedef int16_t CoarseTemperature;
/// A rate of temperature change in 2^-39 K per tick (7.1e-9 K/s): -15 .. 15 K/s.
typedef int32_t Rate;
/// A time in ticks of 256 us, 0 .. 16.8 s. Longer is taken for that.
typedef uint16_t Ticks;

namespace detail {

/// Ticks in a second.
constexpr double ticks_per_s() { return 3906.25; }
/// Units of a Rate in 1 K/s.
constexpr double rate_per_K_per_s() { return 549755813888.0 / ticks_per_s(); }
/// No Temperature leaves -50 .. 180 degC: what is hotter or colder counts as that. With these ends no
/// sum of a temperature and a step overflows.
constexpr double coldest_C() { return -50.0; }
/// @copydoc coldest_C
constexpr double hottest_C() { return 180.0; }
/// No heating rate is above this: 3.8 K/s.
constexpr int32_t most_heating() { return 0x20000000; }

/// The nearest whole number, at compile time.
constexpr int32_t nearest(double value) {
  return static_cast<int32_t>(value < 0.0 ? value - 0.5 : value + 0.5);
}
/// A temperature in its fixed-point unit, at compile time.
constexpr Temperature temperature_of(double temperature_C) { return nearest(temperature_C * 8388608.0); }
/// The lesser of two numbers, at compile time.
constexpr double lesser(double left, double right) { return left < right ? left : right; }
/// The greater of two numbers, at compile time.
constexpr double greater(double left, double right) { return left > right ? left : right; }
/// Absolute value, at compile time.
constexpr double absolute(double value) { return value < 0.0 ? -value : value; }

/// A temperature to 2^-7 K, to the nearest.
inline CoarseTemperature rounded_celsius(Temperature temperature) noexcept {
  return static_cast<CoarseTemperature>((temperature + 0x8000) >> 16);
}

}  // namespace detail

/// Degrees of a fixed-point temperature, for a log.
inline float celsius_of(Temperature temperature) noexcept {
  return static_cast<float>(temperature) * (1.0f / 8388608.0f);
}
/// A rate in K/s, for a log.
inline float K_per_s_of(Rate rate) noexcept {
  return static_cast<float>(rate) * static_cast<float>(3906.25 / 549755813888.0);
}

/// Turns a clock in microseconds that wraps at 2^32 into elapsed ticks; what is less than a tick is kept for
/// the next time, so that no time is lost in the long run.
///
/// @snippet fixed_point_examples.cpp fixed-point gimbal
/// How to: @ref wire_up_sbgc.
class Clock {
public:
  /// Ticks since the last call (since `start()` or 0 at the first).
  /// @param now_us  at most 71 minutes after the last call
  Ticks elapsed(uint32_t now_us) noexcept {
    const uint32_t ticks = (now_us - last_us_) >> 8;
    last_us_ += ticks << 8;
    return ticks > 0xFFFFu ? static_cast<Ticks>(0xFFFFu) : static_cast<Ticks>(ticks);
  }
  /// Time since the last call of `elapsed()`, within 256 us, in microseconds.
  uint32_t waiting_us(uint32_t now_us) const noexcept { return now_us - last_us_; }
  /// Starts here.
  void start(uint32_t now_us) noexcept { last_us_ = now_us; }

private:
  uint32_t last_us_ = 0;
};

}  // namespace fixed_point
}  // namespace thermopower
