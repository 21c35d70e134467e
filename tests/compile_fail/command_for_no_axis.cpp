// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: a gimbal has at least one axis

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
tp::GimbalCommand<0> command;
#else
tp::GimbalCommand<1> command;
#endif
