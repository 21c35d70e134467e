// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the first parameter of AxisController must be a motor

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
tp::AxisController<tp::OhmicCurrent<>, tp::StepPowerLaw<>, tp::SafetyLimiter<>, tp::NoGain> axis;
#else
tp::AxisController<tp::motors::Bgm5208_200_12, tp::StepPowerLaw<>, tp::SafetyLimiter<>, tp::NoGain> axis;
#endif
