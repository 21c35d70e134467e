// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the third parameter of AxisController must be a limiter

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
tp::AxisController<tp::motors::Bgm2606_90t, tp::StepPowerLaw<>, tp::PerSecond, tp::NoGain>
    axis;  // the rule, not the limiter
#else
tp::AxisController<tp::motors::Bgm2606_90t, tp::StepPowerLaw<>, tp::SafetyLimiter<tp::PerSecond>, tp::NoGain>
    axis;
#endif
