// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the parameter of AirTemperature must be constants

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
tp::fixed_point::AirTemperature<int> air;
#else
tp::fixed_point::AirTemperature<tp::fixed_point::StandardAir> air;
#endif
