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

namespace detail {

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
