// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

/// @file measured_temperature.hpp
/// A measured temperature that somebody has checked, and how far it may be off.

namespace thermopower {

class SensorGuard;
class WindingResistance;

/// A temperature with how far it may be off, for a `TemperatureObserver`. A bare reading is not one: `SensorGuard::measured()` makes it of a
/// reading that was checked, and `WindingResistance::measure()` of voltage and current.
///
/// @snippet control_examples.cpp sensor guard
/// How to: @ref explain_observer, @ref choose_a_limiter.
struct MeasuredTemperature {
  float value_C;         ///< NaN when there is none.
  float std_K;           ///< Standard deviation of what is another in each reading, above 0.
  float standing_std_K;  ///< Standard deviation of what is the same in all readings of this sensor, >= 0.
  bool is_valid;         ///< False: nothing was measured, or nothing that can be.

  /// A reading that nobody has checked. @param reading_C, noise_K, standing_K  as the fields
  static MeasuredTemperature unchecked(float reading_C, float noise_K, float standing_K) noexcept {
    return MeasuredTemperature(reading_C, noise_K, standing_K, true);
  }

private:
  friend class SensorGuard;
  friend class WindingResistance;
  MeasuredTemperature(float value, float noise, float standing, bool valid) noexcept
      : value_C(value), std_K(noise), standing_std_K(standing), is_valid(valid) {}
};

}  // namespace thermopower
