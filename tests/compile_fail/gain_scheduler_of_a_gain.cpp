// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the parameter of GainScheduler must be a rule

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
tp::GainScheduler<tp::NoGain> gain;
#else
tp::GainScheduler<tp::RoundedGain> gain;
#endif
