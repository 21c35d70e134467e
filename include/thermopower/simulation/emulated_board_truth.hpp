// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <thermopower/sbgc/realtime_fields.hpp>

/// @file emulated_board_truth.hpp
/// What an emulated board measures, how coarsely it reports it, and what can be wrong with it.

namespace thermopower::simulation {

/// The world as the board's sensors would see it if they were perfect. A plant writes it, the board reads it
/// when it answers.
struct BoardTruth {
  double angle_deg[3] = {0, 0, 0};   ///< Camera angle: roll, pitch, yaw; continuous, not wrapped.
  double target_deg[3] = {0, 0, 0};  ///< Angle to be held.
  double camera_air_C = 25;          ///< At the camera's IMU.
  double frame_air_C = 25;           ///< At the frame's IMU.
  double battery_V = 13;             ///< Supply.
  double current_A = 0;              ///< Drawn from the supply by all motors.
};

/// What is wrong with the board or its line. Everything off: a healthy one.
struct BoardFaults {
  bool is_silent = false;             ///< It hears and obeys, but nothing it sends arrives.
  bool is_deaf = false;               ///< Nothing arrives at the board, so it answers nothing.
  bool is_frame_imu_missing = false;  ///< No frame IMU: its temperature and angles read 0, as on the real
                                      ///< board.
  bool refuses_power = false;         ///< It answers CONFIRM to SET_ADJ_VARS_VAL and leaves POWER as it is.
  bool refuses_with_error = false;  ///< It answers ERROR to SET_ADJ_VARS_VAL and leaves everything as it is.
  bool ignores_commands = false;  ///< It answers nothing to SET_ADJ_VARS_VAL and leaves everything as it is.
  bool hides_power = false;       ///< Its telemetry reads 0 where POWER would be.
  double lost_byte_rate = 0;      ///< Probability that a sent byte vanishes, 0 .. 1.
  double changed_byte_rate = 0;   ///< Probability that a sent byte arrives with one bit flipped, 0 .. 1.
  double noise_byte_rate = 0;     ///< Probability that a random byte follows a sent one, 0 .. 1.
  double angle_scale = 1;    ///< Reported angles are the true ones times this (a wrong setting on the board).
  double battery_scale = 1;  ///< Reported battery voltage is the true one times this.
  double temperature_offset_K = 0;  ///< Added to both reported temperatures.
  double answer_delay_us = 0;  ///< Extra time between parsing a request and the first byte of its answer.
};

namespace detail {
/// Nearest whole number of units that the field can hold; NaN gives 0.
template <class Field>
Field quantised(double value, double lowest, double highest) noexcept {
  return std::isnan(value) ? Field(0) : static_cast<Field>(std::lround(std::clamp(value, lowest, highest)));
}
inline std::int16_t quantised_angle(double deg) noexcept {
  return quantised<std::int16_t>(deg * (16384.0 / 360.0), -32768, 32767);
}
}  // namespace detail

/// The telemetry a board makes of the truth: angles in 360/16384 degree, whole degC, 0.01 V, mA; each to the
/// nearest unit, and the end of the field's range beyond it.
inline sbgc::RealtimeFields measured(const BoardTruth& truth, const BoardFaults& faults) {
  sbgc::RealtimeFields fields;
  for (int axis = 0; axis < 3; ++axis) {
    fields.imu_angle[axis] = detail::quantised_angle(truth.angle_deg[axis] * faults.angle_scale);
    fields.target_angle[axis] = detail::quantised_angle(truth.target_deg[axis] * faults.angle_scale);
  }
  fields.battery_cV =
      detail::quantised<std::uint16_t>(truth.battery_V * faults.battery_scale * 100, 0, 65535);
  fields.current_mA = detail::quantised<std::uint16_t>(truth.current_A * 1000, 0, 65535);
  fields.imu_C = detail::quantised<std::int8_t>(truth.camera_air_C + faults.temperature_offset_K, -128, 127);
  fields.frame_imu_C =
      faults.is_frame_imu_missing
          ? std::int8_t(0)
          : detail::quantised<std::int8_t>(truth.frame_air_C + faults.temperature_offset_K, -128, 127);
  return fields;
}

}  // namespace thermopower::simulation
