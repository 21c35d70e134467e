// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the parameter of ThesisCurrentSource must be a motor with the thesis's current law

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
double current_A = tp::ThesisCurrentSource<tp::ThesisCurrent<> >::intercept_A(5.0);
#else
double current_A = tp::ThesisCurrentSource<tp::motors::Bgm2606_90t>::intercept_A(5.0);
#endif
