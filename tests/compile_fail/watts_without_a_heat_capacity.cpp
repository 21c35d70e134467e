// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: this heating law has no heat capacity to turn a loss in watts into a rate; take RateCooling with it

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
typedef tp::ThermalModel<tp::ThesisHeating<>, tp::NewtonCooling<>, tp::EulerStep> Model;
#else
typedef tp::ThermalModel<tp::ThesisHeating<>, tp::RateCooling<>, tp::EulerStep> Model;
#endif
Model model(Model::Config(), 25.0f);
