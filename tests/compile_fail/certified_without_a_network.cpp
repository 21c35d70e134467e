// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the first parameter of CertifiedLimiter must be a network

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
tp::CertifiedLimiter<tp::LinearHeat> limiter;
#else
tp::CertifiedLimiter<tp::CertifiedOneNode> limiter;
#endif
