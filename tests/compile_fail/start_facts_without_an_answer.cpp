// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: DrivenWhileOff

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
tp::StartFacts facts = {};
#else
tp::StartFacts facts = {false, {}, {}, 0.0f, {}, true};
#endif
