// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#define THERMOPOWER_GAP_LIBRARY
#include "../../../examples/10_own_effect/own_effect.cpp"
