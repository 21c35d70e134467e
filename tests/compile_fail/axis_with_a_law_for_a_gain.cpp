// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the fourth parameter of AxisController must be a gain

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
tp::AxisController<tp::motors::Bgm2606_90t, tp::StepPowerLaw<>, tp::SafetyLimiter<>, tp::StepPowerLaw<> >
    axis;
#else
tp::AxisController<tp::motors::Bgm2606_90t, tp::StepPowerLaw<>, tp::SafetyLimiter<>, tp::NoGain> axis;
#endif
