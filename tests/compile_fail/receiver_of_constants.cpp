// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the second parameter of SbgcCodec and Receiver must be a protocol

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
tp::sbgc::Receiver<124, tp::sbgc::StandardPolling> receiver;
#else
tp::sbgc::Receiver<124, tp::sbgc::ProtocolAuto> receiver;
#endif
