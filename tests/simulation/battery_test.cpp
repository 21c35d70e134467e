// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/simulation/battery.hpp>

#include "../catch.hpp"

using thermopower::simulation::Battery;

TEST_CASE("A loaded battery loses voltage in its resistance, and voltage and charge as it empties") {
  Battery<double> battery({12.6, 9.6, 1800.0, 0.5}, 1.0);
  const double load_S = 0.25;
  battery.step(load_S, 1.0);
  const double first_V = battery.state().supply_V, current_A = first_V * load_S;
  CHECK(first_V == Approx(12.6 - 0.5 * current_A));
  CHECK(battery.state().used_C == Approx(current_A));
  CHECK(battery.state().energy_J == Approx(first_V * current_A));
  for (int i = 0; i < 300; ++i) battery.step(load_S, 1.0);
  CHECK(battery.state().supply_V < first_V);
  CHECK(battery.open_circuit_V() == Approx(12.6 - 3.0 * battery.state().used_C / 1800.0));
}

TEST_CASE("An empty battery stays at its lowest voltage") {
  Battery<double> battery({12.6, 9.6, 10.0, 0.0}, 0.1);
  for (int i = 0; i < 100; ++i) battery.step(1.0, 1.0);
  CHECK(battery.state().supply_V == Approx(9.6));
}
