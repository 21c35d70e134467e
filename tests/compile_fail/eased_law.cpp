// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the parameter of EasedGain must be a gain

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
tp::EasedGain<tp::StepPowerLaw<> > gain;
#else
tp::EasedGain<tp::GainScheduler<> > gain;
#endif
