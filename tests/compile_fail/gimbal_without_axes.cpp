// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: a GimbalController needs at least one AxisController

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

typedef tp::AxisController<tp::motors::Bgm2606_90t> Axis;
#if defined(MISUSE)
tp::GimbalController<> gimbal;
#else
tp::GimbalController<Axis> gimbal;
#endif
