// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the parameter of fixed_point::OhmicMotor must be its constants

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

struct Winding : tp::fixed_point::ThirteenVolts {
  static constexpr double resistance_ohm() { return 8.0; }
  static constexpr double reference_C() { return 25.0; }
  static constexpr double tempco_per_K() { return 0.00393; }
  static constexpr double heat_capacity_J_per_K() { return 60.0; }
  static constexpr double conductance_W_per_K() { return 0.15; }
};

#if defined(MISUSE)
double cooling = tp::fixed_point::OhmicMotor<tp::fixed_point::ThirteenVolts>::cooling_per_s();
#else
double cooling = tp::fixed_point::OhmicMotor<Winding>::cooling_per_s();
#endif
