// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: a saving compares like with like: two meters AtWinding or two AtSupply

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

tp::EnergyMeter<tp::AtWinding> fixed;
#if defined(MISUSE)
tp::EnergyMeter<tp::AtSupply> dynamic;
#else
tp::EnergyMeter<tp::AtWinding> dynamic;
#endif
float saving = tp::saving_percent(fixed, dynamic);
