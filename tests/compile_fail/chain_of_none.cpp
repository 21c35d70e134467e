// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: a LimiterChain needs at least one limiter

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
tp::LimiterChain<> chain;
#else
tp::LimiterChain<tp::SafetyLimiter<> > chain;
#endif
