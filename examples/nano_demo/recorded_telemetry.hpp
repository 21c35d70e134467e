// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/sbgc/realtime_fields.hpp>

#include <cstdint>

namespace nano {

/// Recorded values of a telemetry frame, read as the gimbal reads the frame itself.
struct RecordedTelemetry {
  const thermopower::sbgc::RealtimeFields& fields;  ///< not owned

  std::int16_t target_angle(std::uint8_t axis) const { return fields.target_angle[axis]; }
  std::int16_t imu_angle(std::uint8_t axis) const { return fields.imu_angle[axis]; }
  std::int8_t imu_C() const { return fields.imu_C; }
  std::int8_t frame_imu_C() const { return fields.frame_imu_C; }
  std::uint16_t battery_cV() const { return fields.battery_cV; }
};

}  // namespace nano
