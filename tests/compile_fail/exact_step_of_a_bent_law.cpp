// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: ExactStep needs linear heating and cooling laws; take LinearizedStep or EulerStep for these

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
typedef tp::ThermalModel<tp::HeatCapacityHeating<>, tp::RadiationCooling<>, tp::ExactStep> Model;
#else
typedef tp::ThermalModel<tp::HeatCapacityHeating<>, tp::RadiationCooling<>, tp::LinearizedStep> Model;
#endif
Model model(Model::Config(), 25.0f);
