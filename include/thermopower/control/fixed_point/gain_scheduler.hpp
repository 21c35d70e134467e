// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <stdint.h>

/// @file control/fixed_point/gain_scheduler.hpp
/// The proportional gain that keeps an axis's response the same when its power changes, eq 4.27, exactly: no
/// rounding error.
///
/// | rule | gain | the same in `thermopower` |
/// |---|---|---|
/// | `RoundedGain<low, high>` | eq 4.27 to the nearest count | `GainScheduler<RoundedGain>` |
/// | `TruncatedGain<low, high>` | cut to a whole count | `GainScheduler<TruncatedGain>`, the original |
/// | `NoGain` | none: always 0, which the caller ignores | `thermopower::NoGain` |
///
/// A rule of your own has `static constexpr uint8_t gain(uint8_t power)`.

namespace thermopower {
namespace fixed_point {
namespace detail {

/// floor(value / 255) for value <= 65279, without a division.
constexpr uint8_t divided_by_255(uint16_t value) noexcept {
  return static_cast<uint8_t>(static_cast<uint16_t>(value + 1u + (value >> 8)) >> 8);
}

/// 255 times eq 4.27: a whole number.
template <uint8_t low_power, uint8_t high_power>
constexpr uint16_t gain_times_255(uint8_t power) noexcept {
  return low_power >= high_power
             ? static_cast<uint16_t>(
                   255u * low_power -
                   static_cast<uint16_t>(power * static_cast<uint8_t>(low_power - high_power)))
             : static_cast<uint16_t>(
                   255u * low_power +
                   static_cast<uint16_t>(power * static_cast<uint8_t>(high_power - low_power)));
}

}  // namespace detail

/// Eq 4.27 to the nearest count.
/// @tparam low_power   P at power 0  @tparam high_power  P at power 255
///
/// @snippet fixed_point_examples.cpp fixed-point axis
/// How to: @ref custom_actuator. Menu: @ref policies.
/// @ingroup control
template <uint8_t low_power, uint8_t high_power>
struct RoundedGain {
  /// @param power  granted power parameter  @return P
  static constexpr uint8_t gain(uint8_t power) noexcept {
    return detail::divided_by_255(
        static_cast<uint16_t>(detail::gain_times_255<low_power, high_power>(power) + 127u));
  }
};

/// Eq 4.27 cut to a whole count as the program does: 22 / 172 / 36 at power 25 for roll / pitch / yaw.
/// @tparam low_power   P at power 0  @tparam high_power  P at power 255
///
/// @snippet fixed_point_examples.cpp fixed-point gains
/// How to: @ref custom_actuator. Menu: @ref policies.
/// @ingroup control
template <uint8_t low_power, uint8_t high_power>
struct TruncatedGain {
  /// @copydoc RoundedGain::gain
  static constexpr uint8_t gain(uint8_t power) noexcept {
    return detail::divided_by_255(detail::gain_times_255<low_power, high_power>(power));
  }
};

/// For actuators without a gain.
///
/// @snippet fixed_point_examples.cpp fixed-point gains
/// How to: @ref custom_actuator. Menu: @ref policies.
/// @ingroup control
struct NoGain {
  /// @return 0
  static constexpr uint8_t gain(uint8_t) noexcept { return 0; }
};

}  // namespace fixed_point
}  // namespace thermopower
