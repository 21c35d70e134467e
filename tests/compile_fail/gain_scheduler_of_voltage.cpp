// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: NoGain and VoltageGain are gains, not rules

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
tp::GainScheduler<tp::VoltageGain> gain;
#else
tp::VoltageGain gain;
#endif
