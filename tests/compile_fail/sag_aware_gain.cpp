// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the parameter of SagAwareLaw must be a power law

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
tp::SagAwareLaw<tp::NoGain> law;
#else
tp::SagAwareLaw<tp::StepPowerLaw<> > law;
#endif
