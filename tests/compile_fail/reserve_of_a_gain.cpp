// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the parameter of ReserveLaw must be a power law

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
tp::ReserveLaw<tp::GainScheduler<> > law;
#else
tp::ReserveLaw<tp::SagAwareLaw<> > law;
#endif
