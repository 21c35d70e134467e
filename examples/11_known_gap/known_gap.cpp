// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Problem:  does the diagnosis find a cause that is known? Here is a motor to try it on.
// Model:    the simulation under test takes the winding's resistance as fixed. The motor's is copper:
//           I = V_rms / R(T), R(T) = R (1 + a (T - 25)); C dT/dt = V_rms I - G (T - T_air).
// Notation: a in 1/K, R in ohm, C in J/K, G in W/K, T in degC; P power parameter 0 .. 255.
//
//     known_gap DIR                                       writes model.json, train.csv and heldout.csv
//     thermopower-gap diagnose --model DIR/model.json --recording DIR/train.csv --heldout DIR/heldout.csv
#include <thermopower/thermopower.hpp>

#include <cstdio>
#include <fstream>
#include <random>
#include <string>

namespace tp = thermopower;

namespace {

constexpr double tempco_per_K = 0.00393;  // what the simulation does not know

// A motor on the bench, logged every five seconds by a thermometer and an ammeter with noise.
bool record(const std::string& path, int minutes, unsigned seed) {
  std::ofstream csv(path);
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> level(0, 12), rows(4, 24);
  std::normal_distribution<double> thermometer_K(0.0, 0.1), ammeter_A(0.0, 0.004);

  const tp::CurrentModel<tp::OhmicCurrent<double>> winding({12.0, tempco_per_K, 25.0});
  tp::ThermalModel<tp::HeatCapacityHeating<double>, tp::NewtonCooling<double>, tp::ExactStep> motor(
      {{60.0}, {0.11}}, 24.0);

  csv << "t_s,power_param,supply_V,ambient_C,current_A,motor_C\n";
  int power_param = 0, left = 2;
  for (int second = 0; second < 60 * minutes; second += 5) {
    if (left-- == 0) {
      power_param = 20 * level(random);
      left = rows(random);
    }
    const auto drawn = winding.at_power(power_param, 12.0, motor.hottest_C());
    char line[96];
    std::snprintf(line, sizeof line, "%d,%d,12,24,%.4f,%.2f\n", second, power_param,
                  drawn.current_A + ammeter_A(random), motor.hottest_C() + thermometer_K(random));
    csv << line;
    motor.step({drawn.winding_power_W, drawn.v_rms_V, {24.0, 0.0}}, 5.0);
  }
  return csv.good();
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::fputs("usage: known_gap DIR\n", stderr);
    return 2;
  }
  const std::string directory = arguments[1];
  std::ofstream model(directory + "/model.json");
  // Resistance and heat capacity are 2 % off, as constants are.
  model << R"({
  "format": "thermopower-model/1",
  "name": "motor with a winding that never warms",
  "current": {"law": "ohmic", "resistance_ohm": 12.24, "tempco_per_K": 0},
  "thermal": {"law": "lumped", "heat_capacity_J_per_K": 58.8, "conductance_W_per_K": 0.11}
}
)";
  if (!model.good() || !record(directory + "/train.csv", 30, 1) ||
      !record(directory + "/heldout.csv", 40, 2)) {
    std::fprintf(stderr, "known_gap: %s: cannot be written to\n", directory.c_str());
    return 3;
  }
  std::printf("%s: model.json, train.csv, heldout.csv; what is missing: a = %g 1/K\n", directory.c_str(),
              tempco_per_K);
  return 0;
}
