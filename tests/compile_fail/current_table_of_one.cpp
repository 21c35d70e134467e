// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: a current table has 2 to 255 nodes

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

typedef tp::ThesisCurrentSource<tp::motors::Bgm2606_90t> Source;
#if defined(MISUSE)
tp::TabulatedCurrent<Source, 1> table;
#else
tp::TabulatedCurrent<Source, 2> table;
#endif
float current_A = table.current_A(8.0f, 40.0f);
