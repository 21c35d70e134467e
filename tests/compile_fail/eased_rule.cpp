// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the parameter of EasedGain must be a gain

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
tp::EasedGain<tp::RoundedGain> gain;
#else
tp::EasedGain<tp::GainScheduler<tp::RoundedGain> > gain;
#endif
