// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// One operation and nothing else, to see what it adds to a program: the linker is told which.
#include "../../on_target/report.hpp"
#include "cost.hpp"

extern "C" void operation();

int main() {
  platform::start();
  cost::give(1);
  cost::sink = cost::small_sink = 0;
  cost::real_sink = 0.0f;
  operation();
  platform::stop(0);
}
