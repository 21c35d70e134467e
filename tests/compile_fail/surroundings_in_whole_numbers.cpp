// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the Number of Surroundings must be float, double or a class that stands for one

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
tp::Surroundings<int> around;
#else
tp::Surroundings<double> around;
#endif
