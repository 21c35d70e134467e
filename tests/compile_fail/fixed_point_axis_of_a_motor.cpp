// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the first parameter of fixed_point::AxisController must be a fixed_point::ThermalModel

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;
namespace fixed = thermopower::fixed_point;

#if defined(MISUSE)
fixed::AxisController<tp::motors::Bgm2606_90t> axis;
#else
fixed::AxisController<fixed::ThermalModel<fixed::ThesisMotor<tp::motors::Bgm2606_90t> > > axis;
#endif
