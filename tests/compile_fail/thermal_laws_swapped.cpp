// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the first parameter of ThermalModel must be a heating law

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
typedef tp::ThermalModel<tp::NewtonCooling<>, tp::HeatCapacityHeating<> > Model;
Model model(Model::Config(), 25.0f);
#else
typedef tp::ThermalModel<tp::HeatCapacityHeating<>, tp::NewtonCooling<> > Model;
Model model(Model::Config(), 25.0f);
#endif
