// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: a gimbal has at least one axis

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
tp::PowerInForce<0> power;
#else
tp::PowerInForce<3> power;
#endif
