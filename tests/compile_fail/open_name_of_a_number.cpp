// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the parameter of OpenName must be an enum
// standard: 17

#include <thermopower/plant/quantity.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
tp::plant::OpenName<int> name;
#else
tp::plant::OpenName<tp::plant::Quantity> name;
#endif
