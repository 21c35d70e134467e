// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the parameter of SafetyLimiter must be a rule

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
tp::SafetyLimiter<tp::RoundedGain> limiter;
#else
tp::SafetyLimiter<tp::PerCycle> limiter;
#endif
