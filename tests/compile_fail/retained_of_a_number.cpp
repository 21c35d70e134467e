// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the parameter of Retained must be a record

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
tp::Retained<int> retained;
#else
tp::Retained<tp::StoredState> retained;
#endif
