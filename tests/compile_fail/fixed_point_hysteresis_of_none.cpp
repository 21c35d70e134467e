// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the parameter of fixed_point::HysteresisLevels must be its constants

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

struct Levels {
  static constexpr double full_power_error_deg() { return 2.0; }
  static constexpr uint8_t power_step() { return 25; }
};

#if defined(MISUSE)
tp::fixed_point::HysteresisLevels<Levels> law;
#else
tp::fixed_point::ProgrammedLevels<Levels> law;
#endif
