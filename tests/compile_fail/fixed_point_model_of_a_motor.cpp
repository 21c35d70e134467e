// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the parameter of fixed_point::ThermalModel must be a motor of constants

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;
namespace fixed = thermopower::fixed_point;

#if defined(MISUSE)
fixed::ThermalModel<tp::motors::Bgm2606_90t> model;
#else
fixed::ThermalModel<fixed::ThesisMotor<tp::motors::Bgm2606_90t> > model;
#endif
