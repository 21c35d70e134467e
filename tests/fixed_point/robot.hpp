// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

/// An ohmic motor of made-up constants, in the form that fixed_point::OhmicMotor takes.
struct Robot {
  static constexpr double supply_V() { return 24.0; }
  static constexpr double resistance_ohm() { return 1.2; }
  static constexpr double reference_C() { return 25.0; }
  static constexpr double tempco_per_K() { return 0.00393; }
  static constexpr double heat_capacity_J_per_K() { return 180.0; }
  static constexpr double conductance_W_per_K() { return 0.9; }
};
