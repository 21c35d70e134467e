// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <stdint.h>

#include "../detail/numeric.hpp"

/// @file monitor_inputs.hpp
/// What a `ModelMonitor` is told in each step, and what it may suspect.

namespace thermopower {

/// What is measured and commanded. A balance reads its own fields; those of balances that a monitor lacks stay NaN.
///
/// @snippet monitor_examples.cpp watch a heater
/// How to: @ref heater_with_monitor. Math: @ref explain_monitor.
/// @ingroup monitor
struct MonitorInputs {
  float heat_W;          ///< Mean heat that the model says was put in since the last step, >= 0.
  float measured_C;      ///< The thermometer's reading.
  float air_C;           ///< Air temperature, as the model takes it.
  uint8_t fan;           ///< Share of the fan's airflow that is commanded, 0 .. 255.
  float voltage_V;       ///< At the winding; the sign that of the current.
  float current_A;       ///< In the winding.
  float winding_C;       ///< The winding's temperature, measured or modelled.
  float rate_rad_per_s;  ///< Speed of the shaft, positive where a positive current drives.

  /// A heater: what a printer's bed or hotend has.
  static MonitorInputs heater(float heat_W, float measured_C, float air_C, uint8_t fan = 0) noexcept {
    const float none = detail::not_a_number();
    const MonitorInputs inputs = {heat_W, measured_C, air_C, fan, none, none, none, none};
    return inputs;
  }
  /// A motor with a thermometer, known voltage and current, and a speed.
  static MonitorInputs motor(float heat_W, float measured_C, float air_C, float voltage_V, float current_A,
                             float winding_C, float rate_rad_per_s) noexcept {
    const MonitorInputs inputs = {heat_W,    measured_C, air_C,     0,
                                  voltage_V, current_A,  winding_C, rate_rad_per_s};
    return inputs;
  }
};

/// Which balance disagrees, and which way. Numbers are stable, for logs.
/// @ingroup monitor
enum class Disagreement : uint8_t {
  none = 0,              ///< All balances close within their bounds.
  heat_missing = 1,      ///< Less heat shows than was put in.
  heat_unexplained = 2,  ///< More heat shows than was put in.
  resistance_high = 3,   ///< The winding needs more voltage than its resistance allows: a contact is loose.
  resistance_low = 4,    ///< It needs less: turns are shorted.
  drag_high = 5,         ///< Moving needs more torque than friction allows: friction has grown.
  drag_low = 6           ///< Moving needs less: the load is gone, or the current reads high.
};

/// Causes that a constant change of one term explains; a set of them is a sum of these bits.
/// @ingroup monitor
enum class Suspect : uint8_t {
  none = 0,  ///< Nothing disagrees.
  /// Heat differs by a constant factor, or stays on: weak heater, shorted winding, wrong supply.
  heater = 1,
  loss = 2,  ///< The loss differs by a constant factor: covered, or in a draught.
  fan = 4,   ///< The fan's part of the loss differs by a constant factor: it has stopped.
  air = 8,   ///< The air is warmer or colder than told by a constant.
  /// The reading stands still, or is off by a constant share; alone: no constant change explains it.
  thermometer = 16,
  winding = 32,  ///< Turns or a contact.
  friction = 64  ///< Bearings, gear or load.
};

/// Whether a cause is in a set.
/// @ingroup monitor
constexpr bool is_suspect(uint8_t suspects, Suspect cause) {
  return (suspects & static_cast<uint8_t>(cause)) != 0;
}

}  // namespace thermopower
