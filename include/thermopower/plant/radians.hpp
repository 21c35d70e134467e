// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

namespace thermopower::plant {

/// Radians per degree.
inline constexpr double rad_per_deg = 0.017453292519943295;

/// Degrees per radian.
inline constexpr double deg_per_rad = 57.29577951308232;

/// Radians per turn.
inline constexpr double rad_per_turn = 6.283185307179586;

}  // namespace thermopower::plant
