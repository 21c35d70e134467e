// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the second parameter of fixed_point::SafetyLimiter must be a rule for the ceiling

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

// A power law, and no rule.
template <class Constants>
struct Levels {
  uint8_t step(uint16_t error_units) { return error_units > 45 ? 250 : 25; }
};

#if defined(MISUSE)
tp::fixed_point::SafetyLimiter<tp::fixed_point::ThesisLimit, Levels> limiter;
#else
tp::fixed_point::SafetyLimiter<tp::fixed_point::ThesisLimit, tp::fixed_point::PerCycle> limiter;
#endif
