// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the first parameter of fixed_point::BasicGimbalController must be its constants

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;
namespace fixed = thermopower::fixed_point;

#if defined(MISUSE)
typedef fixed::AxisController<fixed::ThermalModel<fixed::ThesisMotor<tp::motors::Bgm2606_90t> > > Axis;
fixed::BasicGimbalController<Axis, Axis> gimbal;
#else
typedef fixed::AxisController<fixed::ThermalModel<fixed::ThesisMotor<tp::motors::Bgm2606_90t> > > Axis;
fixed::BasicGimbalController<fixed::StandardGimbal, Axis> gimbal;
#endif
