// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the second parameter of CertifiedLimiter must be LinearHeat or SquareHeat

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
tp::CertifiedLimiter<tp::CertifiedOneNode, tp::PerCycle> limiter;
#else
tp::CertifiedLimiter<tp::CertifiedOneNode, tp::SquareHeat> limiter;
#endif
