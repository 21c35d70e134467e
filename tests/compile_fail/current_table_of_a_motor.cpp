// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the first parameter of TabulatedCurrent must be a source

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
tp::TabulatedCurrent<tp::motors::Bgm2606_90t> law;
#else
tp::TabulatedCurrent<tp::ThesisCurrentSource<tp::motors::Bgm2606_90t> > law;
#endif
