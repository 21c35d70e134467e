// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

/// @file unit_factors.hpp
/// What an angle or a rate in radians is multiplied with to be in another unit.

namespace thermopower::robot {

constexpr double degrees = 57.29577951308232;          ///< of an angle in rad, or a rate in rad/s
constexpr double turns_per_rad = 0.15915494309189535;  ///< of an angle in rad
constexpr double rpm = 9.549296585513721;              ///< of a rate in rad/s: turns a minute

}  // namespace thermopower::robot
