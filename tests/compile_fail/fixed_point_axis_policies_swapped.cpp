// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the second parameter of fixed_point::AxisController must be a power law

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;
namespace fixed = thermopower::fixed_point;

#if defined(MISUSE)
typedef fixed::ThermalModel<fixed::ThesisMotor<tp::motors::Bgm2606_90t> > Thermal;
fixed::AxisController<Thermal, fixed::SafetyLimiter<>, fixed::ProgrammedLevels<> > axis;
#else
typedef fixed::ThermalModel<fixed::ThesisMotor<tp::motors::Bgm2606_90t> > Thermal;
fixed::AxisController<Thermal, fixed::ProgrammedLevels<>, fixed::SafetyLimiter<> > axis;
#endif
