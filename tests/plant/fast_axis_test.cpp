// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// What turns fast is stepped in proportion to its rate, and what creeps by a rule of its own: both must stay as exact as that
// promises.
#include "../catch.hpp"

#include <thermopower/gap/simulate.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

#include <algorithm>
#include <cmath>

using namespace thermopower::gap;

namespace {

constexpr double inertia_kgm2 = 2e-5, viscous_Nms_per_rad = 1e-5, Nm_per_A = 0.02, unbalanced_Nm = 4e-3,
                 phase_rad = 0.4, row_s = 0.002;

double drive_A(Eigen::Index row) { return 0.25 + 0.1 * std::sin(0.05 * static_cast<double>(row)); }

/// Moves angle and rate by one row: the classical Runge-Kutta rule, in so many steps.
/// @param acceleration  of angle and rate
template <class Acceleration>
void move(double& angle, double& rate, double length_s, int steps, const Acceleration& acceleration) {
  const double h = length_s / steps;
  for (int i = 0; i < steps; ++i) {
    const double a1 = acceleration(angle, rate), w2 = rate + 0.5 * h * a1;
    const double a2 = acceleration(angle + 0.5 * h * rate, w2), w3 = rate + 0.5 * h * a2;
    const double a3 = acceleration(angle + 0.5 * h * w2, w3), w4 = rate + h * a3;
    const double a4 = acceleration(angle + h * w3, w4);
    angle += h / 6.0 * (rate + 2.0 * w2 + 2.0 * w3 + w4);
    rate += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
  }
}

/// The rates that the equation of motion makes.
std::vector<double> rates_dps(double start_rad_per_s, Eigen::Index rows) {
  double angle = 0.0, rate = start_rad_per_s;
  std::vector<double> result;
  for (Eigen::Index row = 0; row < rows; ++row) {
    result.push_back(rate / rad_per_deg);
    const double torque = Nm_per_A * drive_A(row);
    move(angle, rate, row_s, 100, [&](double at, double w) {
      return (torque - viscous_Nms_per_rad * w - unbalanced_Nm * std::sin(at + phase_rad)) / inertia_kgm2;
    });
  }
  return result;
}

}  // namespace

TEST_CASE(
    "a fast axis keeps to fine steps within what its rate allows, a slow one within what it always did") {
  const double start_rad_per_s = GENERATE(0.0, 60.0, 500.0);
  constexpr Eigen::Index rows = 300;
  Model model;
  model.name = "rotor";
  model.axis = RigidAxisModel{inertia_kgm2, viscous_Nms_per_rad, Nm_per_A};
  model.effects["imbalance"] = {{"Nm", unbalanced_Nm}, {"phase_rad", phase_rad}};
  Recording recording;
  recording.name = "rotor";
  recording.t_s = Eigen::VectorXd::LinSpaced(rows, 0.0, row_s * static_cast<double>(rows - 1));
  const std::vector<double> truth = rates_dps(start_rad_per_s, rows);
  Eigen::VectorXd drive(rows), rate(rows), angle = Eigen::VectorXd::Zero(rows);
  for (Eigen::Index row = 0; row < rows; ++row) {
    drive[row] = drive_A(row);
    rate[row] = truth[static_cast<std::size_t>(row)];
  }
  recording.set("drive_A", drive);
  recording.set("rate_dps", rate);
  recording.set("angle_deg", angle);
  double worst = 0.0;
  for (const SimulatedSignal& signal :
       simulate(model, recording, {SimulationMode::free_running, 1e9}, standard_catalogue()))
    if (signal.signal == Signal::rate_dps)
      for (Eigen::Index row = 0; row < rows; ++row)
        worst = std::max(worst, std::abs(signal.values[row] - rate[row]) /
                                    std::max(std::abs(rate[row]), 10.0 / rad_per_deg));
  REQUIRE(worst > 0.0);
  CAPTURE(start_rad_per_s, worst);
  CHECK(worst < 2e-4);
}

TEST_CASE(
    "an axis that creeps through the transition of its friction is followed to a millidegree in twenty seconds") {
  constexpr double heavy_kgm2 = 0.01, drag = 0.5, friction_Nm = 0.5, transition_rad_per_s = 0.05,
                   interval_s = 0.02;
  constexpr Eigen::Index rows = 1000;
  Model model;
  model.name = "creeping";
  model.axis = RigidAxisModel{heavy_kgm2, drag, 1.0};
  model.effects["coulomb_friction"] = {
      {"Nm", friction_Nm}, {"transition_rad_per_s", transition_rad_per_s}, {"tail", 0.0}};
  Recording recording;
  recording.name = "creeping";
  recording.t_s = Eigen::VectorXd::LinSpaced(rows, 0.0, interval_s * static_cast<double>(rows - 1));
  Eigen::VectorXd drive(rows), angle(rows), rate(rows);
  double at = 0.0, speed = 0.0;
  for (Eigen::Index row = 0; row < rows; ++row) {
    const double t = recording.t_s[row];
    drive[row] = 0.6 * std::sin(3.1 * t) + 0.3 * std::sin(11.0 * t + 1.0);
    angle[row] = at / rad_per_deg;
    rate[row] = speed / rad_per_deg;
    move(at, speed, interval_s, 1000, [&](double, double w) {
      return (drive[row] - drag * w - friction_Nm * std::tanh(w / transition_rad_per_s)) / heavy_kgm2;
    });
  }
  recording.set("drive_A", drive);
  recording.set("angle_deg", angle);
  recording.set("rate_dps", rate);
  double worst_deg = 0.0;
  for (const SimulatedSignal& signal :
       simulate(model, recording, {SimulationMode::free_running, 1e9}, standard_catalogue()))
    if (signal.signal == Signal::angle_deg) worst_deg = (signal.values - angle).cwiseAbs().maxCoeff();
  REQUIRE(worst_deg > 0.0);
  CAPTURE(worst_deg);
  CHECK(worst_deg < 1e-3);
}
