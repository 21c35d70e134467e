// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the parameter of ModelMonitor must have heat_balance(), winding_balance() or motion_balance()

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

struct Plant {
  static constexpr tp::MonitorConfig monitor() { return {10.0, 1000.0, true}; }
#if !defined(MISUSE)
  static constexpr tp::WindingBalanceConfig winding_balance() {
    return {24.0, 2.0, 0.1, 0.0039, 25.0, 10.0, 0.1, 0.1};
  }
#endif
};
tp::ModelMonitor<Plant> monitor;
