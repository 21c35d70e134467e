// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the third parameter of ThermalModel must be EulerStep, ExactStep or LinearizedStep

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
typedef tp::ThermalModel<tp::HeatCapacityHeating<>, tp::NewtonCooling<>, tp::PerCycle> Model;
Model model(Model::Config(), 25.0f);
#else
typedef tp::ThermalModel<tp::HeatCapacityHeating<>, tp::NewtonCooling<>, tp::EulerStep> Model;
Model model(Model::Config(), 25.0f);
#endif
