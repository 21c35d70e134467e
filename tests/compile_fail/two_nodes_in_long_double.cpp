// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the Number of a law or model must be float, double or a class

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
tp::TwoNodeThermalModel<long double>::Config config;
#else
tp::TwoNodeThermalModel<double>::Config config;
#endif
