// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/simulation/thesis_gimbal.hpp>

#include <cmath>

#include "../catch.hpp"
#include "table.hpp"

using namespace thermopower::simulation;

namespace {

// Largest relative difference from the measured currents, the winding being as much above the body as the
// plant has it settled.
double worst_current(const AxisPlant<double>::Config& axis, const std::string& table) {
  double worst = 0.0;
  for (const auto& row : thesis_table(table)) {
    const double power = std::stod(row.at("power_param")), body_C = std::stod(row.at("T_motor_C"));
    const bool is_settled = std::stod(row.at("t_min")) > 0.0;
    double winding_C = body_C;
    if (is_settled)
      for (int i = 0; i < 50; ++i)
        winding_C =
            body_C + axis.drive.at(power, 13.0, winding_C, body_C).heat_W / axis.body.coupling_W_per_K;
    const double measured_A = std::stod(row.at("I_mA")) * 1e-3;
    const double supply_A = axis.drive.at(power, 13.0, winding_C, body_C).heat_W / 13.0;
    // Printed to a milliampere.
    worst = std::fmax(worst, (std::fabs(supply_A - measured_A) - 5e-4) / measured_A);
  }
  return worst;
}

}  // namespace

TEST_CASE("The drives draw the currents of Tables 4.1 and 4.2") {
  CHECK(worst_current(thesis_roll<double>(), "table4_1.csv") < 0.14);
  CHECK(worst_current(thesis_yaw<double>(), "table4_2.csv") < 0.03);
}

TEST_CASE("What the supply delivers becomes heat") {
  const auto drive = thesis_roll<double>().drive;
  for (const double power : {1.0, 25.0, 100.0, 255.0}) {
    const auto state = drive.at(power, 12.0, 50.0, 40.0);
    CHECK(state.heat_W == Approx(12.0 * 12.0 * state.load_S));
    CHECK(drive.load_at(power, 50.0) == Approx(state.load_S));
  }
}

TEST_CASE("Torque rises with POWER and falls as winding and magnets get warm") {
  const auto drive = thesis_roll<double>().drive;
  CHECK(drive.at(0.0, 13.0, 25.0, 25.0).available_Nm == 0.0);
  CHECK(drive.at(255.0, 13.0, 25.0, 25.0).available_Nm == Approx(0.045).epsilon(0.01));
  CHECK(drive.at(100.0, 13.0, 25.0, 25.0).available_Nm < drive.at(101.0, 13.0, 25.0, 25.0).available_Nm);
  const double warm =
      drive.at(255.0, 13.0, 125.0, 25.0).available_Nm / drive.at(255.0, 13.0, 25.0, 25.0).available_Nm;
  CHECK(warm == Approx(1.0 / 1.393));
  const double magnets =
      drive.at(255.0, 13.0, 25.0, 75.0).available_Nm / drive.at(255.0, 13.0, 25.0, 25.0).available_Nm;
  CHECK(magnets == Approx(0.94));
}
