// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the Number of AirCelsius must be float or double

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
tp::AirCelsius<int> air;
#else
tp::AirCelsius<float> air;
#endif
