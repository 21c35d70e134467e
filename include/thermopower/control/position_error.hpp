// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../detail/numeric.hpp"

/// @file position_error.hpp
/// Position error, eq 4.19, the short way round.

namespace thermopower {

/// Folds an angle into -180 to 180 degrees. Angles beyond a million degrees, NaN and Inf give NaN.
/// @ingroup control
inline float wrap_deg(float angle_deg) noexcept {
  // The usual case by its bits, which costs a small chip a tenth of two comparisons: -180 .. 180, and no NaN.
  if (detail::magnitude_bits(angle_deg) <= 0x43340000u) return angle_deg;
  if (!(detail::magnitude(angle_deg) < 1.0e6f)) return detail::not_a_number();
  const float turns = angle_deg * (1.0f / 360.0f);
  const int16_t whole = static_cast<int16_t>(turns < 0.0f ? turns - 0.5f : turns + 0.5f);
  const float folded = angle_deg - 360.0f * static_cast<float>(whole);
  // After thousands of turns a float's rounding can choose the turn next to the right one.
  if (folded > 180.0f) return folded - 360.0f;
  return folded < -180.0f ? folded + 360.0f : folded;
}

/// Error of an axis, eq 4.19, folded. @return -180 .. 180 degrees
/// @ingroup control
inline float position_error_deg(float target_deg, float measured_deg) noexcept {
  return wrap_deg(target_deg - measured_deg);
}

/// The same in the controller's integer units of 360/16384 degree. @return -8192 .. 8191
/// @ingroup control
inline int16_t position_error_units(int16_t target, int16_t measured) noexcept {
  const uint16_t turn = 16384u;
  const uint16_t difference =
      static_cast<uint16_t>(static_cast<uint16_t>(target) - static_cast<uint16_t>(measured));
  // 16384 divides 65536, so wrapping costs nothing
  const uint16_t within = static_cast<uint16_t>(difference & (turn - 1u));
  return static_cast<int16_t>(within >= turn / 2u ? static_cast<int32_t>(within) - turn : within);
}

/// Degrees of an angle in units of 360/16384 degree.
/// @ingroup control
inline float deg_from_units(int16_t units) noexcept {
  return static_cast<float>(units) * (360.0f / 16384.0f);
}

}  // namespace thermopower
