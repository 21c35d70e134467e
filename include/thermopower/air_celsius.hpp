// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <math.h>

#include "detail/numeric.hpp"

/// @file air_celsius.hpp
/// An air temperature that cannot be forgotten silently.

namespace thermopower {

/// An air temperature among other inputs, degC: a plain number, but one that is left out of a list in braces is NaN, which models
/// and limiters take for not known, and no silent 0 degC.
///
/// @snippet actuator_examples.cpp air left out
/// How to: @ref units_and_temperatures.
/// @ingroup actuator
template <class Number>
class AirCelsius {
  static_assert(detail::IsModelNumber<Number>::value,
                "thermopower: the Number of AirCelsius must be float or double: whole numbers have no NaN");

public:
  /// Not said: NaN.
  constexpr AirCelsius() noexcept : air_C_(static_cast<Number>(NAN)) {}
  /// Said. @param air_C  degC; NaN: not known
  constexpr AirCelsius(Number air_C) noexcept : air_C_(air_C) {}
  /// The number.
  constexpr operator Number() const noexcept { return air_C_; }

private:
  Number air_C_;
};

/// The air among an axis's inputs, degC: a reading, or a bound that somebody vouches for. An axis whose motor declares its air takes a
/// reading for no more than a sign that the thermometer is alive: the warmest air of the range counts.
///
/// @snippet control_examples.cpp air bound
/// How to: @ref first_axis, @ref faults_and_reasons.
/// @ingroup control
class AxisAirCelsius : public AirCelsius<float> {
public:
  /// Not said: NaN.
  constexpr AxisAirCelsius() noexcept = default;
  /// A reading. @param air_C  degC; NaN: not known
  constexpr AxisAirCelsius(float air_C) noexcept : AirCelsius<float>(air_C) {}
  /// A bound. @param air_C  the air is no warmer, as AirTemperature::State::air_C
  static constexpr AxisAirCelsius bound(float air_C) noexcept { return AxisAirCelsius(air_C, true); }
  /// Whether it is a bound and no mere reading.
  constexpr bool is_bound() const noexcept { return is_bound_; }

private:
  constexpr AxisAirCelsius(float air_C, bool is_bound) noexcept
      : AirCelsius<float>(air_C), is_bound_(is_bound) {}
  bool is_bound_ = false;
};

/// The declared range of the air around an actuator. A reading outside of it is no air: a thermometer that is torn, asleep, or has drifted
/// away, and a fault. Inside of it the warmest air counts all the same: one thermometer that drifts or sticks looks like a room that cools.
/// `AxisAirCelsius::bound()` tells an axis better.
///
/// @snippet control_examples.cpp air range
/// How to: @ref first_axis, @ref faults_and_reasons.
struct AirRange {
  float lowest_C;   ///< The air is never colder. Not below -100.
  float highest_C;  ///< The air is never warmer. Above `lowest_C`, at most 200.

  /// Whether a reading may be this air; NaN is not.
  bool holds(float reading_C) const noexcept { return reading_C >= lowest_C && reading_C <= highest_C; }
};

namespace detail {

/// Whether a motor declares the range of its air.
template <class Motor, class = int>
struct DeclaresAir {
  static constexpr bool value = false;
};
template <class Motor>
struct DeclaresAir<Motor, typename Exists<decltype(Motor::air().highest_C)>::Type> {
  static constexpr bool value = true;
};
template <class Motor>
auto declared_air(int) noexcept -> decltype(Motor::air()) {
  return Motor::air();
}
template <class Motor>
AirRange declared_air(long) noexcept {
  const AirRange range = {-100.0f, 200.0f};
  return range;
}

/// Numbers of several lanes, and those with derivatives, are said by whoever makes them.
template <class Number>
struct AirOf {
  typedef Number Type;
};
template <>
struct AirOf<float> {
  typedef AirCelsius<float> Type;
};
template <>
struct AirOf<double> {
  typedef AirCelsius<double> Type;
};

}  // namespace detail
}  // namespace thermopower
