// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// What a researcher writes after `#include <thermopower/desktop.hpp>`.
#include <thermopower/desktop.hpp>

#include <cstdio>

int main() {
  namespace tp = thermopower;
  const tp::NewtonCooling<double> cooling{0.11};
  const tp::ThermalModel<tp::HeatCapacityHeating<double>, tp::NewtonCooling<double>>::Config config{{60.0},
                                                                                                    cooling};
  tp::ThermalModel<tp::HeatCapacityHeating<double>, tp::NewtonCooling<double>> motor(config, 25.0);
  motor.step({2.2, 0.0, {25.0, 0.0}}, 1e6);
  std::printf("settled at %.3f degC\n", motor.state().motor_C);
  return motor.state().motor_C > 44.99 && motor.state().motor_C < 45.01 ? 0 : 1;  // 25 + 2.2 / 0.11
}
