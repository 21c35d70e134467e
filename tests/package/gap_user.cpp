// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// A program that links the diagnosis: the engine's reason for turning nothing down comes from the library.
#include <thermopower/gap.hpp>

#include <cstdio>

#ifndef THERMOPOWER_GAP_LIBRARY
#error "thermopower::gap must say that the diagnosis is compiled already"
#endif

int main() {
  try {
    thermopower::gap::diagnose({}, {});
  } catch (const thermopower::gap::InvalidInput& error) {
    std::printf("%s\n", error.what());
    return 0;
  }
  return 1;
}
