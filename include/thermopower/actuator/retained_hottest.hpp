// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <stdint.h>

#include "../detail/crc16.hpp"

/// @file retained_hottest.hpp
/// The hottest of several actuators through a reset that was no loss of power, in six bytes of memory that a reset leaves
/// as it was. For a small chip; Retained keeps a whole record.

namespace thermopower {

/// What a controller in whole numbers knows of its actuators, kept in every cycle: it wears nothing, and a reset costs no
/// power. After a loss of power the memory holds noise, which is taken for a record with a probability of 2^-16.
///
///     RetainedHottest retained __attribute__((section(".noinit")));
///
/// It has no constructor on purpose: one would wipe what it is there to keep.
///
/// @snippet actuator_examples.cpp retained hottest
/// How to: @ref explain_observer.
struct RetainedHottest {
  int16_t hottest;  ///< No actuator is hotter, in 1/128 degC.
  uint8_t power;    ///< No larger POWER was told.
  uint8_t resets;   ///< Since the last `keep()`; stops at 255. Right only after `recall()`.
  uint16_t check;   ///< Of the others.

  /// Whether this was a reset and not a loss of power. Call once, at the start. @return false also when the reset cut off
  /// `keep()`; nothing here is to be believed then
  bool recall() noexcept {
    const bool is_whole = check == sum();
    resets = is_whole ? static_cast<uint8_t>(resets < 255 ? resets + 1 : 255) : static_cast<uint8_t>(0);
    if (is_whole) check = sum();
    return is_whole;
  }
  /// Keeps what is known. Call it in every cycle. @param hottest_now  in 1/128 degC, rounded up  @param largest_power  of
  /// all actuators that may be in force
  void keep(int16_t hottest_now, uint8_t largest_power) noexcept {
    hottest = hottest_now;
    power = largest_power;
    resets = 0;
    check = sum();
  }
  /// The hottest in whole degC, rounded up.
  int16_t hottest_C() const noexcept { return static_cast<int16_t>((hottest >> 7) + 1); }

private:
  uint16_t sum() const noexcept {
    const uint8_t bytes[4] = {static_cast<uint8_t>(hottest & 0xff), static_cast<uint8_t>(hottest >> 8 & 0xff),
                              power, resets};
    return detail::crc16(bytes, 4, 0x5265u);
  }
};

}  // namespace thermopower
