// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the first parameter of BasicGimbalController must be NominalSupply or MeasuredSupply

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
typedef tp::AxisController<tp::motors::Bgm2606_90t> Axis;
tp::BasicGimbalController<Axis, Axis> gimbal;
#else
typedef tp::AxisController<tp::motors::Bgm2606_90t> Axis;
tp::BasicGimbalController<tp::MeasuredSupply, Axis> gimbal;
#endif
