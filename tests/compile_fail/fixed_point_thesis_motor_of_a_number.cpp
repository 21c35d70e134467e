// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the first parameter of fixed_point::ThesisMotor must be a motor with the thesis's laws

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
double cooling = tp::fixed_point::ThesisMotor<int>::cooling_per_s();
#else
double cooling = tp::fixed_point::ThesisMotor<tp::motors::Bgm2606_90t>::cooling_per_s();
#endif
