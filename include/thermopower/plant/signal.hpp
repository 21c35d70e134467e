// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

namespace thermopower::plant {

/// The signals that a diagnosis can judge.
enum class Signal { current_A = 0, motor_C = 1, angle_deg = 2, rate_dps = 3 };

/// Number of signals.
inline constexpr int signal_count = 4;

/// Column name of a signal.
inline const char* name_of(Signal signal) {
  constexpr const char* names[] = {"current_A", "motor_C", "angle_deg", "rate_dps"};
  return names[static_cast<int>(signal)];
}

/// Unit of a signal as reports spell it.
inline const char* unit_of(Signal signal) {
  constexpr const char* units[] = {"A", "degC", "deg", "deg/s"};
  return units[static_cast<int>(signal)];
}

}  // namespace thermopower::plant
