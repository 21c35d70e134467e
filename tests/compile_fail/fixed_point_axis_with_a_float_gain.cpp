// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the fourth parameter of fixed_point::AxisController must be a gain

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;
namespace fixed = thermopower::fixed_point;

#if defined(MISUSE)
typedef fixed::ThermalModel<fixed::ThesisMotor<tp::motors::Bgm2606_90t> > Thermal;
fixed::AxisController<Thermal, fixed::ProgrammedLevels<>, fixed::SafetyLimiter<>, tp::RoundedGain> axis;
#else
typedef fixed::ThermalModel<fixed::ThesisMotor<tp::motors::Bgm2606_90t> > Thermal;
fixed::AxisController<Thermal, fixed::ProgrammedLevels<>, fixed::SafetyLimiter<>, fixed::RoundedGain<24, 4> >
    axis;
#endif
