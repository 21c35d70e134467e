// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: both parameters of SumOfCooling must be cooling laws

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
tp::SumOfCooling<tp::NewtonCooling<>, tp::HeatCapacityHeating<> > law;
#else
tp::SumOfCooling<tp::NewtonCooling<>, tp::RadiationCooling<> > law;
#endif
