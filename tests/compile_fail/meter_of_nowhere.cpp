// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the first parameter of EnergyMeter must be where

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
tp::EnergyMeter<int> meter;
#else
tp::EnergyMeter<tp::AtSupply> meter;
#endif
