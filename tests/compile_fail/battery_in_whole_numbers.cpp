// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the Number of a simulated part must be float, double or a class that stands for one
// standard: 17

#include <thermopower/simulation/battery.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
typedef tp::simulation::Battery<int> Battery;
unsigned size = sizeof(Battery);
#else
typedef tp::simulation::Battery<double> Battery;
unsigned size = sizeof(Battery);
#endif
