// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "units.hpp"

/// @file fixed_point/coarse_air.hpp
/// An air temperature in whole numbers that cannot be forgotten silently.

namespace thermopower {
namespace fixed_point {

/// An air temperature among other inputs, in 2^-7 K: a plain number, but one that is left out of a list in braces is the
/// warmest there can be, 125 degC, and no silent 0 degC: whole numbers have no NaN.
///
/// @snippet fixed_point_examples.cpp fixed-point air left out
/// How to: @ref units_and_temperatures.
/// @ingroup control
class CoarseAir {
public:
  /// Not said: 125 degC.
  constexpr CoarseAir() noexcept : air_(125 * 128) {}
  /// Said. @param air  -60 .. 125 degC
  constexpr CoarseAir(CoarseTemperature air) noexcept : air_(air) {}
  /// The number.
  constexpr operator CoarseTemperature() const noexcept { return air_; }

private:
  CoarseTemperature air_;
};

}  // namespace fixed_point
}  // namespace thermopower
