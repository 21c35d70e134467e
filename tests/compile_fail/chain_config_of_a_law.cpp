// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: every parameter of LimiterChain must be a limiter

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
tp::LimiterChainConfig<tp::StepPowerLaw<> > config;
#else
tp::LimiterChainConfig<tp::SafetyLimiter<> > config;
#endif
