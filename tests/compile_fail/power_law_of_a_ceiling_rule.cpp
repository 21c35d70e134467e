// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the parameter of StepPowerLaw must be a rule

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
tp::StepPowerLaw<tp::PerSecond> law;
#else
tp::StepPowerLaw<tp::ContinuousPower> law;
#endif
