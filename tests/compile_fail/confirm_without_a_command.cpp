// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: confirmed() needs the board's answer, with is_of_power()

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

typedef tp::AxisController<tp::motors::Bgm2606_90t> Axis;

void hear(tp::GimbalController<Axis>& gimbal, const tp::sbgc::Frame& frame) {
#if defined(MISUSE)
  gimbal.confirmed(frame);
#else
  tp::sbgc::hear_answer(frame, gimbal);
#endif
}
