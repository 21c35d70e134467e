// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the second parameter of fixed_point::ThesisMotor must be a supply

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
typedef tp::fixed_point::ThesisMotor<tp::motors::Bgm2606_90t, tp::motors::Bgm2606_90t> Motor;
double cooling = Motor::cooling_per_s();
#else
typedef tp::fixed_point::ThesisMotor<tp::motors::Bgm2606_90t, tp::fixed_point::ThirteenVolts> Motor;
double cooling = Motor::cooling_per_s();
#endif
