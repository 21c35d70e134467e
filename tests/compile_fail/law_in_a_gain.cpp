// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the Number of a law or model must be float, double or a class that stands for one

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
tp::NewtonCooling<tp::NoGain> cooling;
#else
tp::NewtonCooling<double> cooling = {0.1};
#endif
