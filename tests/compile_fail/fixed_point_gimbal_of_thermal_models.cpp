// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: every parameter of fixed_point::GimbalController must be a fixed_point::AxisController

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;
namespace fixed = thermopower::fixed_point;

#if defined(MISUSE)
typedef fixed::ThermalModel<fixed::ThesisMotor<tp::motors::Bgm2606_90t> > Thermal;
fixed::GimbalController<Thermal> gimbal;
#else
typedef fixed::ThermalModel<fixed::ThesisMotor<tp::motors::Bgm2606_90t> > Thermal;
fixed::GimbalController<fixed::AxisController<Thermal> > gimbal;
#endif
