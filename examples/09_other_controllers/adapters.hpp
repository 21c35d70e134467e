// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/thermopower.hpp>

#include <stdio.h>

/// @file adapters.hpp
/// How an axis's state drives the limits of other people's motor controllers. Each adapter is a template: it includes none of their
/// headers and names only members that their published interface has.

namespace adapters {

namespace tp = thermopower;

/// SimpleFOC (BLDCMotor / FOCMotor: members `voltage_limit`, `current_limit`, `phase_resistance`).
/// The granted power becomes the voltage limit; the resistance follows the estimated temperature, because SimpleFOC turns current
/// into voltage with it, and a hot winding with the cold value gets too little torque.
template <class FocMotor, class AxisState>
void drive_simple_foc(FocMotor& motor, const AxisState& axis, const tp::OhmicCurrent<>& winding,
                      float supply_V) {
  // A faulty temperature must not reach the controller as a resistance; the limiter has already granted the least power for it.
  const float motor_C = tp::detail::is_finite(axis.motor_C) ? axis.motor_C : winding.reference_C;
  motor.phase_resistance = winding.resistance_at(motor_C);
  motor.voltage_limit = tp::v_rms_from_power<float>(supply_V, static_cast<float>(axis.power));
  motor.current_limit = motor.voltage_limit / motor.phase_resistance;
}

/// VESC (`mc_interface_override_temp_motor(float)`): the estimate stands in for the motor's thermistor, and the VESC's own derating
/// between `l_temp_motor_start` and `l_temp_motor_end` does the rest. A temperature that is not a number is reported as very hot: a
/// comparison with NaN is false, so the VESC would take it for cool.
template <class OverrideTemperature, class AxisState>
void drive_vesc(OverrideTemperature override_temp_motor, const AxisState& axis) {
  const float very_hot_C = 300.0f;
  override_temp_motor(tp::detail::is_finite(axis.motor_C) ? axis.motor_C : very_hot_C);
}

/// ODrive, ASCII protocol, firmware 0.5: `w axis0.motor.config.current_lim <ampere>`. The share of the full power that was granted,
/// as a share of voltage (eq 3.11), scales the current limit.
/// @param full_current_A  limit when nothing is derated
/// @return characters written, 0 when they do not fit (nothing is sent then)
template <class AxisState>
size_t command_odrive(char* line, size_t capacity, int axis_number, const AxisState& axis,
                      float full_current_A) {
  const float share = tp::v_rms_from_power<float>(1.0f, static_cast<float>(axis.power));
  const long milliampere = static_cast<long>(full_current_A * share * 1000.0f + 0.5f);
  // Whole numbers: printf of small targets is often built without floating point.
  const int length = snprintf(line, capacity, "w axis%d.motor.config.current_lim %ld.%03ld\n", axis_number,
                              milliampere / 1000, milliampere % 1000);
  return length > 0 && static_cast<size_t>(length) < capacity ? static_cast<size_t>(length) : 0;
}

}  // namespace adapters
