// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/open_name.hpp>

namespace thermopower::plant {

/// A quantity that a balance may lack: one per conservation law or pair of instruments.
enum class Quantity {
  missing_current,         ///< A, of the circuit, as the ammeter sees it
  missing_voltage,         ///< V, the same as what would have to drive the circuit besides
  missing_heat,            ///< W, into the body
  missing_torque,          ///< N m, on the driven inertia
  angle_slope_minus_rate,  ///< deg/s, of the two instruments of an axis against each other
};

/// Number of quantities in the closed set.
inline constexpr int count_of(Quantity) { return 5; }

/// `missing heat`, `missing torque`, ...: as reports spell it.
inline const char* to_string(Quantity quantity) {
  switch (quantity) {
    case Quantity::missing_current:
      return "missing current";
    case Quantity::missing_voltage:
      return "missing voltage";
    case Quantity::missing_heat:
      return "missing heat";
    case Quantity::missing_torque:
      return "missing torque";
    case Quantity::angle_slope_minus_rate:
      return "slope of the angle minus rate";
  }
  return "";
}

/// A quantity of our plants' balances, or one of a user's own plant.
using QuantityName = OpenName<Quantity>;

}  // namespace thermopower::plant
