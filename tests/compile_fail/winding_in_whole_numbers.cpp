// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the Number of a law or model must be float, double or a class

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
tp::CurrentModel<tp::OhmicCurrent<long> > model({12, 0, 20});
#else
tp::CurrentModel<tp::OhmicCurrent<float> > model({12.0f, 0.00393f, 20.0f});
#endif
