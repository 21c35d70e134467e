// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: winding_balance(): resistance_error is a fraction, 0 .. 0.5

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

struct Plant {
  static constexpr tp::MonitorConfig monitor() { return {10.0, 1000.0, true}; }
#if defined(MISUSE)
  static constexpr tp::WindingBalanceConfig winding_balance() {
    return {24.0, 2.0, 10.0, 0.0039, 25.0, 10.0, 0.1, 0.1};
  }
#else
  static constexpr tp::WindingBalanceConfig winding_balance() {
    return {24.0, 2.0, 0.1, 0.0039, 25.0, 10.0, 0.1, 0.1};
  }
#endif
};
tp::ModelMonitor<Plant> monitor;
