// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the parameter of BasicVoltageGain must be a drive

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
tp::BasicVoltageGain<int> gain;
#else
tp::BasicVoltageGain<tp::SineDrive> gain;
#endif
