// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <stdint.h>

/// @file config_error.hpp
/// The answer of every `validate()`: which field of a configuration is wrong, by name.

namespace thermopower {

/// The first field that a `validate()` refused. The enumerator is the field's own name, so a debugger or a
/// log of the number tells what to mend (docs/reference/config-errors.md). Numbers are stable: never reused, new ones
/// at the end.
/// @ingroup control
enum class ConfigError : uint8_t {
  none = 0,                            ///< Every field is in its range.
  supply_V = 1,                        ///< Must be finite and above 0.
  resistance_ohm = 2,                  ///< Must be finite and above 0.
  tempco_per_K = 3,                    ///< Must be within 0 .. 0.02 per kelvin (copper: 0.00393).
  reference_C = 4,                     ///< Must be within -50 .. 200 degC.
  base_A = 5,                          ///< Must be finite and above 0.
  exponent = 6,                        ///< Must be finite and within the range its law states.
  slope_A_per_K = 7,                   ///< The current's slope against temperature must be finite.
  minimum_V_rms = 8,                   ///< Must be finite and not negative.
  heat_capacity_J_per_K = 9,           ///< Must be finite and above 0.
  conductance_W_per_K = 10,            ///< Must be finite and above 0.
  cooling_per_s = 11,                  ///< Must be finite and above 0.
  radiating_area_m2 = 12,              ///< Must be finite and above 0.
  emissivity = 13,                     ///< Must be within 0 .. 1.
  airflow_gain = 14,                   ///< Must be finite and not negative.
  reference_K = 15,                    ///< A temperature difference; must be finite and above 0.
  winding_heat_capacity_J_per_K = 16,  ///< Must be finite and above 0.
  body_heat_capacity_J_per_K = 17,     ///< Must be finite and above 0.
  coupling_W_per_K = 18,               ///< Must be finite and above 0.
  full_power_error_deg = 19,           ///< Must be finite and above 0.
  power_step = 20,                     ///< Must be within 1 .. 25: ten levels of it fit into a byte.
  hysteresis_deg = 21,                 ///< Must be finite and not negative.
  maximum_C = 22,                      ///< The limit temperature must be within 0 .. 200 degC.
  safety_time_s = 23,                  ///< Must be finite and above 0.
  rate_per_s = 24,                     ///< Must be finite and above 0.
  gain_low_power = 25,                 ///< The P gain at the lowest power must be finite and within 0 .. 255.
  gain_high_power = 26,       ///< The P gain at the highest power must be finite and within 0 .. 255.
  minimum_plausible_C = 27,   ///< Must be finite.
  maximum_plausible_C = 28,   ///< Must be finite and above minimum_plausible_C.
  maximum_difference_K = 29,  ///< Must be finite and above 0.
  heating_J_per_K = 30,       ///< A constant of the thesis's heating coefficient must be finite.
  minimum_supply_V = 31,      ///< Must be finite, not negative and below supply_V.
  timeout_s = 32,             ///< Must be finite and above 0.
  least_power = 33,           ///< Must not exceed the highest power.
  maximum_winding_C = 34,     ///< The winding's limit must be within 0 .. 250 degC.
  maximum_body_C = 35,        ///< The body's limit must be within 0 .. 250 degC.
  highest_supply_V = 36,      ///< Must be finite and above 0.
  supply_error = 37,          ///< A fraction; must be finite and not negative.
  coldest_C = 38,             ///< Must be within -60 .. 100 degC and below the limit.
  heat_when_cold_W = 39,  ///< Must be finite, above 0, and full power must not warm the actuator by 3000 K.
  heat_when_hot_W = 40,   ///< Must be finite, above 0 and not above heat_when_cold_W.
  highest_air_C = 41,     ///< Must not be below coldest_C, and the least power must be bearable in that air.
  air_error_K = 42,       ///< Must be finite and not negative.
  hold_s = 43,            ///< Must be finite, above 0 and at most 10 s.
  horizon_s = 44,         ///< Must be finite and not below hold_s.
  current_std_A = 45,     ///< Must be finite and above 0.
  current_step_A = 46,    ///< Must be finite and not negative.
  voltage_std_fraction = 47,  ///< Must be finite and not negative.
  heat_error = 48,            ///< A fraction; must be above 0 and at most 1.
  gate_sigma = 49,            ///< Must be finite and above 0.
  variance_s = 50,            ///< Must be finite and above 0.
  slots = 51,                 ///< Must be at least 2.
  interval_s = 52,            ///< Must be above 0, and long enough for the memory to last a year.
  change_K = 53,              ///< Must be finite and not negative.
  offset_fraction = 54,       ///< A node's place between two others; must be within its kind's range.
  derating_K = 55,            ///< Must be finite and above 0.
  tolerance_deg = 56,         ///< Must be finite and above 0.
  learning_per_s = 57,        ///< Must be finite and above 0.
  forgetting_per_s = 58,      ///< Must be finite and not negative.
  highest_power = 59,         ///< Must not be below the least power.
  nominal_supply_V = 60,      ///< Must be finite and above 0.
  magnet_tempco_per_K = 61,   ///< Must be within 0 .. 0.01 per kelvin.
  pose_deg = 62,              ///< The last pose must be above the first, both finite.
  every = 63,                 ///< Must be at least 1, and the phase below it.
  reserve_power = 64,         ///< Must be at least 1.
  moving_error_deg = 65,      ///< Must be finite and above 0.
  calm_s = 66,                ///< Must be finite and not negative.
  rise_per_s = 67,            ///< Must be finite and above 0.
  fall_per_s = 68,            ///< Must be finite and above 0.
  ease_from_deg = 69,         ///< Must be finite and above 0.
  longest_s = 70,             ///< Must be finite and not below interval_s.
  maximum_supply_V = 71,      ///< Must be finite and above supply_V.
  current_offset_A = 72,      ///< Must be finite and not negative.
  warning_percent = 73,       ///< Must be finite and above 0.
  error_percent = 74,         ///< Must be finite and above warning_percent.
  hysteresis_percent = 75,    ///< Must be finite and not negative.
  is_waived = 76,             ///< Must be 0 or 1.
  stuck_K = 77,               ///< Must be finite and above change_K.
  lowest_supply_V = 78,       ///< Must be above 0 and below the highest supply.
  declared_C = 79,            ///< Must not be above maximum_plausible_C; -INFINITY believes the readings.
  user_defined = 128          ///< Codes from here up are free for policies of your own.
};

/// True when a `validate()` found something.
/// @ingroup control
constexpr bool is_error(ConfigError error) { return error != ConfigError::none; }

/// The first of two results that is an error: lets a component report its parts in order.
/// @ingroup control
constexpr ConfigError first_error(ConfigError first, ConfigError second) {
  return is_error(first) ? first : second;
}

/// The same of any number of results.
/// @ingroup control
template <class... Rest>
constexpr ConfigError first_error(ConfigError first, ConfigError second, Rest... rest) {
  return first_error(first_error(first, second), rest...);
}

}  // namespace thermopower
