// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Measures the operations it is linked with.
#include "../../on_target/report.hpp"
#include "cost.hpp"

int main() {
  platform::start();
  counter::start();
  cost::row("", cost::cost_nothing, cost::cost_nothing);
  measure_all();
  platform::stop(0);
}
