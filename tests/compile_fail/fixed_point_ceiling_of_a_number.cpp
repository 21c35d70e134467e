// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the parameter of fixed_point::PerSecond must be its constants

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
tp::fixed_point::PerSecond<int> rule;
#else
tp::fixed_point::PerSecond<> rule;
#endif
