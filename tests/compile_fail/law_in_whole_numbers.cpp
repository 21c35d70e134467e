// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the Number of a law or model must be float, double or a class

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
tp::NewtonCooling<int> cooling = {1};
#else
tp::NewtonCooling<double> cooling = {0.1};
#endif
