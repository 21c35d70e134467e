// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/radians.hpp>

/// @file unit_factors.hpp
/// What an angle or a rate in radians is multiplied with to be in another unit, besides plant::deg_per_rad.

namespace thermopower::robot {

constexpr double turns_per_rad = 1.0 / plant::rad_per_turn;  ///< of an angle in rad
constexpr double rpm = 60.0 / plant::rad_per_turn;           ///< of a rate in rad/s: turns a minute

}  // namespace thermopower::robot
