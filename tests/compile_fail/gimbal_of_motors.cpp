// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: every parameter of GimbalController must be an AxisController

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

typedef tp::AxisController<tp::motors::Bgm2606_90t> Axis;
#if defined(MISUSE)
tp::GimbalController<tp::motors::Bgm2606_90t, tp::motors::Bgm5208_200_12> gimbal;
#else
tp::GimbalController<Axis, Axis> gimbal;
#endif
