// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the Number of EnergyMeter must be float, double or a class that stands for one

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
tp::EnergyMeter<tp::AtWinding, int> meter;
#else
tp::EnergyMeter<tp::AtWinding, double> meter;
#endif
