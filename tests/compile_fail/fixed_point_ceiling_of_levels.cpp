// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the parameter of fixed_point::PerCycle must be the constants of its limiter

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
tp::fixed_point::PerCycle<tp::fixed_point::ThesisLevels> rule;
#else
tp::fixed_point::PerCycle<tp::fixed_point::ThesisLimit> rule;
#endif
