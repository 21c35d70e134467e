// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include <stdint.h>

/// @file
/// @brief Angle and speed units of the SimpleBGC protocol (specification 2.5) and their conversion.

namespace thermopower {
namespace sbgc {

/// @brief Degrees in one angle unit: 14 bits per turn, exact in binary floating point.
/// @ingroup sbgc
constexpr float deg_per_angle_unit = 360.0f / 16384.0f;

/// @brief Degrees per second in one speed unit of the protocol.
/// @ingroup sbgc
constexpr float deg_per_s_per_speed_unit = 0.1220740379f;

namespace detail {
/// Nearest int16; saturates; NaN gives 0.
inline int16_t sbgc_to_int16(float value) noexcept {
  if (!(value == value)) return 0;
  if (value >= 32767.0f) return 32767;
  if (value <= -32768.0f) return -32768;
  return static_cast<int16_t>(value < 0.0f ? value - 0.5f : value + 0.5f);
}
}  // namespace detail

/// @brief Angle in degrees of a number of angle units. Angles are continuous: they are not wrapped to one
/// turn.
/// @param units any number of units; a difference of two int16 angles needs 32 bits.
/// @ingroup sbgc
inline constexpr float angle_deg(int32_t units) noexcept {
  return static_cast<float>(units) * deg_per_angle_unit;
}

/// @brief Nearest angle in protocol units, as an int16 field carries it.
/// @param deg within -720..719.98; outside, the end of the range is returned; NaN gives 0.
/// @ingroup sbgc
inline int16_t angle_units(float deg) noexcept {
  return detail::sbgc_to_int16(deg * (1.0f / deg_per_angle_unit));
}

/// @brief Speed in degrees per second of a number of speed units.
/// @ingroup sbgc
inline constexpr float speed_deg_per_s(int16_t units) noexcept {
  return static_cast<float>(units) * deg_per_s_per_speed_unit;
}

/// @brief Nearest speed in protocol units.
/// @param deg_per_s within about -4000..4000; outside, the end of the range is returned; NaN gives 0.
/// @ingroup sbgc
inline int16_t speed_units(float deg_per_s) noexcept {
  return detail::sbgc_to_int16(deg_per_s * (1.0f / deg_per_s_per_speed_unit));
}

}  // namespace sbgc
}  // namespace thermopower
