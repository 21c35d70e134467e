// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the second parameter of SbgcCodec and Receiver must be a protocol

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

#if defined(MISUSE)
tp::SbgcCodec<124, int> codec;
#else
tp::SbgcCodec<124, tp::sbgc::ProtocolV2> codec;
#endif
