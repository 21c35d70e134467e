// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../air_celsius.hpp"
#include "../detail/numeric.hpp"

/// @file surroundings.hpp
/// What an actuator loses its heat to.

namespace thermopower {

/// The air around an actuator during one step; constant over the step.
/// @ingroup actuator
template <class Number = float>
struct Surroundings {
  static_assert(
      detail::IsModelNumber<Number>::value,
      "thermopower: the Number of Surroundings must be float, double or a class that stands for one");

  typename detail::AirOf<Number>::Type air_C;  ///< Air temperature, degC; left out: NaN.
  Number airspeed_mps;  ///< Speed of forced airflow, m/s, >= 0; only `ForcedAirflow` reads it.
};

}  // namespace thermopower
