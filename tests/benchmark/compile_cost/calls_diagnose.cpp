// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The least that a program with a diagnosis consists of.
#include <thermopower/gap.hpp>

int main() { return thermopower::gap::diagnose({}, {}).cause.empty() ? 0 : 1; }
