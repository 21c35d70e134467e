// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: must be a current law

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
tp::CachedCurrent<tp::SafetyLimiter<> > model(tp::SafetyLimiter<>::Config::standard());
#else
tp::CachedCurrent<tp::OhmicCurrent<> > model(tp::OhmicCurrent<>{8.0f, 0.0039f, 20.0f});
#endif
