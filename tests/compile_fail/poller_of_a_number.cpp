// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the parameter of BasicPoller must be its constants

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
tp::sbgc::BasicPoller<int> poller;
#else
tp::sbgc::BasicPoller<tp::sbgc::StandardPolling> poller;
#endif
