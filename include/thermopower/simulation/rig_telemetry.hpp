// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include <thermopower/sbgc/units.hpp>

/// @file rig_telemetry.hpp
/// What the board of the rig measures, at the resolution it sends it.

namespace thermopower::simulation {

/// One telemetry sample. It answers like `sbgc::RealtimeData`, so that a controller takes either.
///
/// @snippet simulation_examples.cpp rig by hand
/// How to: @ref rig.
struct RigTelemetry {
  std::array<std::int16_t, 3> imu_units{};     ///< Camera angles, 360/16384 degree.
  std::array<std::int16_t, 3> target_units{};  ///< Angles to be held.
  std::array<std::int16_t, 3> frame_units{};   ///< Angles of the base.
  std::array<std::uint8_t, 3> power{};         ///< POWER now.
  std::uint16_t battery_cV = 0;                ///< 0.01 V
  std::uint16_t current_mA = 0;                ///< Drawn from the supply by the motors.
  std::int8_t camera_C = 0;                    ///< Thermometer of the camera's IMU.
  std::int8_t frame_C = 0;                     ///< Thermometer of the frame's IMU.

  /// Target less camera angle. @return degrees, not wrapped
  float error_deg(std::uint8_t axis) const noexcept {
    return sbgc::angle_deg(static_cast<std::int32_t>(target_units[axis]) - imu_units[axis]);
  }
  /// Camera angle. @return degrees
  float imu_angle_deg(std::uint8_t axis) const noexcept { return sbgc::angle_deg(imu_units[axis]); }
  /// Angle to be held. @return degrees
  float target_deg(std::uint8_t axis) const noexcept { return sbgc::angle_deg(target_units[axis]); }
  std::int8_t imu_C() const noexcept { return camera_C; }                               ///< degC
  std::int8_t frame_imu_C() const noexcept { return frame_C; }                          ///< degC
  float battery_V() const noexcept { return static_cast<float>(battery_cV) * 0.01f; }   ///< V
  float current_A() const noexcept { return static_cast<float>(current_mA) * 0.001f; }  ///< A
  std::uint8_t motor_power(std::uint8_t axis) const noexcept { return power[axis]; }    ///< 0 .. 255
};

/// An angle as the board's int16 carries it: more than two turns fold, as they would on the wire.
inline std::int16_t folded_angle_units(double angle_deg) noexcept {
  const double turns = std::nearbyint(angle_deg / 360.0);
  return sbgc::angle_units(
      static_cast<float>(std::fabs(turns) > 1.0 ? angle_deg - 360.0 * turns : angle_deg));
}

}  // namespace thermopower::simulation
