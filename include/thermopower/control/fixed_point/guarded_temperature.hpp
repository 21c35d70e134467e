// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../../fixed_point/units.hpp"

/// @file guarded_temperature.hpp
/// A temperature in whole numbers that a limiter may believe: thermopower::GuardedCelsius for chips without a floating-point unit.

namespace thermopower {
namespace fixed_point {

/// A temperature that somebody vouches for. No limiter takes a bare number: a torn thermistor would be a cold motor to it. Whole numbers
/// have no NaN, so where there is no temperature call `cut()` with the reason.
///
/// | made by | the temperature is |
/// |---|---|
/// | `of(model)` | estimated by a thermal model |
/// | `unchecked(temperature)` | whatever the caller says: nobody has looked at it |
///
/// @snippet fixed_point_examples.cpp fixed-point parts
/// How to: @ref choose_a_limiter.
/// @ingroup control
class GuardedTemperature {
public:
  /// A bare number is refused, in a sentence.
  template <class Number>
  GuardedTemperature(Number) noexcept {
    static_assert(sizeof(Number) == 0,
                  "thermopower: a limiter in whole numbers does not take a bare number for a temperature: "
                  "name the model with GuardedTemperature::of(model), or write "
                  "GuardedTemperature::unchecked(temperature)");
  }
  /// The motor of a thermal model in whole numbers.
  template <class Thermal>
  static constexpr GuardedTemperature of(const Thermal& model) noexcept {
    return GuardedTemperature(model.state().motor, 0);
  }
  /// A temperature that nobody has checked.
  static constexpr GuardedTemperature unchecked(Temperature temperature) noexcept {
    return GuardedTemperature(temperature, 0);
  }
  /// The number.
  constexpr operator Temperature() const noexcept { return value_; }

private:
  constexpr GuardedTemperature(Temperature value, int) noexcept : value_(value) {}
  Temperature value_;
};

}  // namespace fixed_point
}  // namespace thermopower
