// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the parameter of TableGain must be a table

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
struct Use {
  tp::TableGain<int> gain;
};
#else
tp::GainScheduler<tp::RoundedGain> gain;
#endif
