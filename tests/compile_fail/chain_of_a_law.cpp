// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: every parameter of LimiterChain must be a limiter

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
tp::LimiterChain<tp::NodeLimiter, tp::StepPowerLaw<> > chain;
#else
tp::LimiterChain<tp::NodeLimiter, tp::SafetyLimiter<> > chain;
#endif
