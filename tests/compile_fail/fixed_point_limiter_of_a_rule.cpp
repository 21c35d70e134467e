// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the first parameter of fixed_point::SafetyLimiter must be its constants

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;
namespace fixed = thermopower::fixed_point;

#if defined(MISUSE)
struct Ruled {};
fixed::SafetyLimiter<Ruled> limiter;
#else
fixed::SafetyLimiter<fixed::ThesisLimit, fixed::PerCycle> limiter;
#endif
