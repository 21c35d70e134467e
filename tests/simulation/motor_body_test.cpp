// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/simulation/thesis_gimbal.hpp>

#include <cmath>
#include <tuple>

#include "../catch.hpp"
#include "table.hpp"

using namespace thermopower::simulation;

namespace {

using Axis = AxisPlant<double>::Config;

struct Run {
  double power, air_C;
  std::vector<double> t_min, measured_C;
};

// The rows of a table cut into runs wherever the time starts again.
std::vector<Run> runs(const std::string& table, const std::string& motor, const std::string& measured,
                      double air_C) {
  std::vector<Run> all;
  for (const auto& row : thesis_table(table)) {
    if (row.at("motor") != motor) continue;
    const double t_min = std::stod(row.at("t_min"));
    if (t_min == 0.0) {
      all.emplace_back();
      all.back().power = row.count("power_param") ? std::stod(row.at("power_param")) : 0.0;
      all.back().air_C = row.count("T_air_C") ? std::stod(row.at("T_air_C")) : air_C;
    }
    all.back().t_min.push_back(t_min);
    all.back().measured_C.push_back(std::stod(row.at(measured)));
  }
  return all;
}

// Largest difference between the simulated body and the measured motor.
double worst_K(const Axis& axis, const std::vector<Run>& all) {
  double worst = 0.0;
  for (const Run& run : all) {
    MotorBody<double> body(axis.body, {run.measured_C[0], run.measured_C[0]});
    double t_s = 0.0;
    for (std::size_t i = 0; i < run.t_min.size(); ++i) {
      for (; t_s < 60.0 * run.t_min[i] - 0.05; t_s += 0.1) {
        const auto& now = body.state();
        body.step(axis.drive.at(run.power, 13.0, now.winding_C, now.body_C).heat_W, {run.air_C, 0.0}, 0.1);
      }
      worst = std::fmax(worst, std::fabs(body.state().body_C - run.measured_C[i]));
    }
  }
  return worst;
}

}  // namespace

TEST_CASE("The simulated motors heat and cool as those that the constants were fitted to") {
  CHECK(worst_K(thesis_roll<double>(), runs("table4_1.csv", "BGM2606-90T", "T_motor_C", 26.0)) < 2.6);
  CHECK(worst_K(thesis_roll<double>(), runs("table4_3.csv", "BGM2606-90T", "T_motor_C", 25.0)) < 2.0);
  CHECK(worst_K(thesis_yaw<double>(), runs("table4_2.csv", "BGM5208-200-12", "T_motor_C", 26.0)) < 0.5);
  CHECK(worst_K(thesis_yaw<double>(), runs("table4_6.csv", "BGM5208-200-12", "T_motor_C", 26.0)) < 0.5);
}

// Largest difference between the thesis's own calculation and what it measured.
double calculated_K(const std::string& table, const std::string& motor) {
  double worst = 0.0;
  for (const auto& row : thesis_table(table))
    if (row.at("motor") == motor)
      worst = std::fmax(worst,
                        std::fabs(std::stod(row.at("T_calculated_C")) - std::stod(row.at("T_measured_C"))));
  return worst;
}

TEST_CASE(
    "They are as near to chapter 5, which they were not fitted to, as the thesis's own calculation is") {
  // The runs of chapter 5 differ from those of chapter 4 by more than either differs from its model.
  for (const auto& [table, motor, axis] :
       {std::make_tuple("table5_1.csv", "BGM2606-90T", thesis_roll<double>()),
        std::make_tuple("table5_1.csv", "BGM5208-200-12", thesis_yaw<double>()),
        std::make_tuple("table5_2.csv", "BGM5208-200-12", thesis_yaw<double>()),
        std::make_tuple("table5_3.csv", "BGM2606-90T", thesis_roll<double>())}) {
    INFO(table << " " << motor);
    CHECK(worst_K(axis, runs(table, motor, "T_measured_C", 26.0)) < calculated_K(table, motor) + 0.5);
  }
}

TEST_CASE("At constant heat the loss becomes the heat") {
  const auto config = thesis_roll<double>().body;
  MotorBody<double> body(config, {25.0, 25.0});
  const thermopower::Surroundings<double> around = {25.0, 0.0};
  for (int i = 0; i < 200000; ++i) body.step(1.8, around, 0.1);
  CHECK(body.loss_W(body.state().body_C, around) == Approx(1.8).epsilon(1e-6));
  CHECK(body.state().winding_C - body.state().body_C == Approx(1.8 / config.coupling_W_per_K).epsilon(1e-6));
}

TEST_CASE("A stream of air cools, and still air adds none") {
  MotorBody<double> body(thesis_roll<double>().body, {60.0, 60.0});
  const double in_still = body.loss_W(60.0, {25.0, 0.0});
  CHECK(body.loss_W(60.0, {25.0, 1.0}) == Approx(in_still + 0.02 * 35.0));
  CHECK(body.loss_W(60.0, {25.0, 4.0}) > body.loss_W(60.0, {25.0, 1.0}));
}

TEST_CASE("The step does not matter below a second") {
  MotorBody<double> fine(thesis_roll<double>().body, {25.0, 25.0}), coarse = fine;
  for (int i = 0; i < 37500; ++i) fine.step(8.0, {25.0, 0.0}, 0.008);
  for (int i = 0; i < 300; ++i) coarse.step(8.0, {25.0, 0.0}, 1.0);
  CHECK(std::fabs(fine.state().body_C - coarse.state().body_C) < 0.02);
  CHECK(std::fabs(fine.state().winding_C - coarse.state().winding_C) < 0.02);
}
