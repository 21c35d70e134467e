// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Effects against their equations, written here a second time and stepped in twentieths of a millisecond, or as the textbook
// solves them.
#include "../catch.hpp"

#include <thermopower/plant/axis_rollout.hpp>
#include <thermopower/plant/bench_rollout.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

#include <cmath>
#include <functional>
#include <vector>

using namespace thermopower::plant;

namespace {

constexpr double inertia = 1e-3, viscous = 1e-3, torque_constant = 0.2, degrees = 57.29577951308232;

/// Rate in rad/s at rows 10 ms apart, from rest, as the library simulates it.
std::vector<double> simulated(const std::string& effect, const EffectParameters& parameters,
                              const std::vector<double>& drive_A, const std::vector<double>& outside_Nm) {
  Model model;
  model.axis = RigidAxisModel{inertia, viscous, torque_constant};
  model.effects[effect] = parameters;
  const auto rows = static_cast<Eigen::Index>(drive_A.size());
  Inputs inputs;
  inputs.name = effect;
  inputs.t_s = Eigen::VectorXd::LinSpaced(rows, 0.0, 0.01 * static_cast<double>(rows - 1));
  inputs.runs = {{0, rows, ""}};
  inputs.drive_A = Eigen::Map<const Eigen::VectorXd>(drive_A.data(), rows);
  inputs.torque_Nm = Eigen::Map<const Eigen::VectorXd>(outside_Nm.data(), rows);
  const Instance<double> instance(model, {}, {}, standard_catalogue());
  const AxisRollout<double> rollout(instance, inputs);
  AxisState<double> state = rollout.start(0, 0.0, 0.0, 0.0);
  std::vector<double> rate;
  rollout.window(inputs.runs[0], 0, rows, state, [&](Eigen::Index, const AxisReadings<double>& read) {
    rate.push_back(read.rate_dps / degrees);
  });
  return rate;
}

/// The same for a torque that a law gives of motor torque, outside torque, angle and rate; at rest it turns the way in
/// which the law pushes it.
std::vector<double> stepped(const std::function<double(double, double, double, double)>& law,
                            const std::vector<double>& drive_A, const std::vector<double>& outside_Nm) {
  std::vector<double> result;
  double angle = 0.0, rate = 0.0;
  for (std::size_t i = 0; i < drive_A.size(); ++i) {
    result.push_back(rate);
    constexpr int steps = 200;
    for (int k = 0; k < steps; ++k) {
      const double h = 0.01 / steps, motor = torque_constant * drive_A[i], tiny = 1e-12;
      double way = rate;
      if (rate == 0.0) {
        if (law(motor, outside_Nm[i], angle, tiny) > 0.0) way = tiny;
        else if (law(motor, outside_Nm[i], angle, -tiny) < 0.0) way = -tiny;
        else continue;
      }
      const double middle = rate + 0.5 * h * law(motor, outside_Nm[i], angle, way) / inertia;
      const double next =
          rate +
          h * law(motor, outside_Nm[i], angle + 0.5 * h * rate, middle * way > 0.0 ? middle : way) / inertia;
      angle += 0.5 * h * (rate + next);
      rate = next * way < 0.0 ? 0.0 : next;
    }
  }
  return result;
}

double furthest(const std::vector<double>& a, const std::vector<double>& b) {
  double worst = a.size() == b.size() ? 0.0 : 1e300;
  for (std::size_t i = 0; i < a.size() && i < b.size(); ++i) worst = std::fmax(worst, std::fabs(a[i] - b[i]));
  return worst;
}

double largest(const std::vector<double>& a) { return furthest(a, std::vector<double>(a.size(), 0.0)); }

}  // namespace

TEST_CASE(
    "a gear hands on one part of the motor's torque, and the load's over another, and holds what neither moves") {
  std::vector<double> drive_A, outside_Nm;
  for (int i = 0; i < 600; ++i) {
    const bool held = i >= 300 && i < 450;  // 0.8 of 4 mN m do not lift 5 mN m, and these do not turn 4 / 0.5
    drive_A.push_back(held ? 0.02 : 0.1 * std::sin(0.021 * i) + 0.08 * std::sin(0.053 * i + 1.0));
    outside_Nm.push_back(held ? -0.005 : 0.006 * std::sin(0.017 * i + 2.0));
  }
  const auto gear = [](double motor, double outside, double, double rate) {
    const double arrives = motor * rate > 0.0 ? 0.8 * motor : motor / 0.5;
    return arrives + outside - viscous * rate;
  };
  const std::vector<double> reference = stepped(gear, drive_A, outside_Nm);
  const EffectParameters found = {{"efficiency", 0.8},
                                  {"back_efficiency", 0.5},
                                  {"transition_rad_per_s", friction_sticks_below_rad_per_s}};
  const std::vector<double> rate = simulated("drive_efficiency", found, drive_A, outside_Nm);
  CHECK(largest(reference) > 5.0);
  CHECK(furthest(rate, reference) < 0.01);
  int at_rest = 0;
  for (std::size_t i = 1; i < rate.size(); ++i) at_rest += rate[i] == 0.0 && reference[i] == 0.0;
  CHECK(at_rest > 20);

  // Without losses it is no gear; and one way only it is a smaller torque constant, to the last digit of the textbook.
  const auto none = [](double motor, double outside, double, double rate_) {
    return motor + outside - viscous * rate_;
  };
  CHECK(furthest(simulated("drive_efficiency", {{"efficiency", 1.0}, {"back_efficiency", 1.0}}, drive_A,
                           outside_Nm),
                 stepped(none, drive_A, outside_Nm)) < 0.01);
  const std::vector<double> steady(100, 0.05), nothing(100, 0.0);
  const std::vector<double> forward = simulated("drive_efficiency", found, steady, nothing);
  CHECK(forward.back() ==
        Approx(0.8 * 0.05 * torque_constant / viscous * (1.0 - std::exp(-0.99))).epsilon(1e-5));
}

TEST_CASE("without a load a gear's two efficiencies are friction in the teeth and another torque constant") {
  std::vector<double> drive_A, nothing(400, 0.0), scaled;
  for (int i = 0; i < 400; ++i)
    drive_A.push_back(0.1 * std::sin(0.021 * i) + 0.08 * std::sin(0.053 * i + 1.0));
  const double factor = 0.5 * (0.8 + 1.0 / 0.5);
  for (const double one : drive_A) scaled.push_back(factor * one);
  const double share = (1.0 / 0.5 - 0.8) / (1.0 / 0.5 + 0.8);
  const EffectParameters gear = {{"efficiency", 0.8}, {"back_efficiency", 0.5}}, teeth = {{"share", share}};
  const std::vector<double> rate = simulated("drive_efficiency", gear, drive_A, nothing);
  CHECK(furthest(rate, simulated("load_friction", teeth, scaled, nothing)) < 0.01);
  CHECK(furthest(rate, simulated("load_friction", teeth, drive_A, nothing)) > 1.0);
}

TEST_CASE("cogging adds the second harmonic of its first one") {
  std::vector<double> drive_A, nothing(300, 0.0);
  for (int i = 0; i < 300; ++i)
    drive_A.push_back(0.1 * std::sin(0.021 * i) + 0.03 * std::sin(0.053 * i + 1.0));
  // 0.005 sin(7 theta + 0.9), and 0.4 of it at 14 theta, 0.6 rad ahead.
  const auto magnets = [](double motor, double, double angle, double rate) {
    return motor - 0.005 * std::sin(7.0 * angle + 0.9) - 0.002 * std::sin(14.0 * angle + 0.9 + 0.6) -
           viscous * rate;
  };
  const EffectParameters found = {{"sin_Nm", 0.005 * std::cos(0.9)},
                                  {"cos_Nm", 0.005 * std::sin(0.9)},
                                  {"cycles_per_turn", 7.0},
                                  {"second_sin", 0.4 * std::cos(0.6)},
                                  {"second_cos", 0.4 * std::sin(0.6)}};
  CHECK(furthest(simulated("cogging", found, drive_A, nothing), stepped(magnets, drive_A, nothing)) < 0.01);
  EffectParameters first = found;
  first.erase("second_sin");
  first.erase("second_cos");
  CHECK(furthest(simulated("cogging", first, drive_A, nothing), stepped(magnets, drive_A, nothing)) > 0.5);
}

TEST_CASE("the iron's heat goes with rate and rate squared, into the surface behind the winding") {
  Model model;
  model.supply = SupplyModel{12.0};
  model.current = OhmicCurrentModel{8.0, 0.0, 25.0};
  model.thermal = LumpedThermalModel{60.0, 0.15};
  model.effects["second_thermal_mass"] = {{"winding_share", 0.25}, {"coupling", 0.6}};
  model.effects["iron_loss"] = {{"hysteresis_W_s_per_rad", 0.1}, {"eddy_W_s2_per_rad2", 0.003}};
  Inputs inputs;
  const Eigen::Index rows = 2000;
  inputs.name = "iron";
  inputs.t_s = Eigen::VectorXd::LinSpaced(rows, 0.0, 4.0 * static_cast<double>(rows - 1));
  inputs.runs = {{0, rows, ""}};
  inputs.power_param = Eigen::VectorXd::Constant(rows, 0.0);
  inputs.supply_V = Eigen::VectorXd::Constant(rows, 12.0);
  inputs.ambient_C = Eigen::VectorXd::Constant(rows, 20.0);
  inputs.covariate_rate_dps = Eigen::VectorXd::Constant(rows, -20.0 * degrees);
  inputs.heat = HeatSource::law;
  const Instance<double> instance(model, {}, {}, standard_catalogue());
  const BenchRollout<double> rollout(instance, inputs);
  BenchState<double> state = rollout.start(0, 20.0);
  double after_a_row = 0.0;
  rollout.run(0, rows, 0.0, state, [&](Eigen::Index row, const BenchReadings<double>& read) {
    if (row == 1) after_a_row = read.motor_C;
  });
  const double watts = 0.1 * 20.0 + 0.003 * 20.0 * 20.0;
  // No heat enters the winding: in the end it is as warm as the surface, which loses all of it.
  CHECK(state.surface_C == Approx(20.0 + watts / 0.15).epsilon(1e-6));
  CHECK(state.winding_C == Approx(state.surface_C).epsilon(1e-6));
  // After 4 s the surface has warmed by watts t / C_surface, and the winding by k / C_winding of the integral of that.
  const double surface_K_per_s = watts / 45.0;
  CHECK(after_a_row - 20.0 == Approx(0.6 / 15.0 * surface_K_per_s * 8.0).epsilon(0.15));
}

TEST_CASE("a propeller turns as fast as its drag, with the square of the rate, holds its drive") {
  const double c = 4e-4, drive_A = 0.5;
  const std::size_t rows = 800;
  for (const double way : {1.0, -1.0}) {
    const std::vector<double> rate =
        simulated("quadratic_drag", {{"Nm_s2_per_rad2", c}}, std::vector<double>(rows, way * drive_A),
                  std::vector<double>(rows, 0.0));
    // Kt i = b w + c w^2
    const double expected =
        (std::sqrt(viscous * viscous + 4.0 * c * torque_constant * drive_A) - viscous) / (2.0 * c);
    CHECK(rate.back() == Approx(way * expected).epsilon(1e-4));
  }
}

TEST_CASE("electronics warm a resting body by their heat over its conductance") {
  Model model;
  model.current = OhmicCurrentModel{6.0, 0.00393, 25.0};
  model.thermal = LumpedThermalModel{60.0, 0.2};
  model.effects["idle_heat"] = {{"W", 3.0}};
  const Eigen::Index rows = 400;
  Inputs inputs;
  inputs.t_s = Eigen::VectorXd::LinSpaced(rows, 0.0, 10.0 * static_cast<double>(rows - 1));
  inputs.runs = {{0, rows, ""}};
  inputs.power_param = Eigen::VectorXd::Zero(rows);
  inputs.ambient_C = Eigen::VectorXd::Constant(rows, 20.0);
  inputs.heat = HeatSource::law;
  const Instance<double> instance(model, {}, {}, standard_catalogue());
  const BenchRollout<double> rollout(instance, inputs);
  BenchState<double> state = rollout.start(0, 20.0);
  double last_C = 0.0;
  rollout.run(0, rows, 0.0, state,
              [&](Eigen::Index, const BenchReadings<double>& read) { last_C = read.motor_C; });
  CHECK(last_C == Approx(20.0 + 3.0 / 0.2).epsilon(1e-4));
}

namespace {

/// Angle in degrees at rows 10 ms apart of an axis under a PID servo, from rest.
std::vector<double> served(const std::vector<double>& target_deg, bool moves, const EffectParameters& late) {
  Model model;
  model.axis = RigidAxisModel{inertia, viscous, torque_constant};
  model.servo = PositionPidServo{0.02, 0.002, 0.01, 2.0, 0.005, 0.0};
  if (!late.empty()) model.effects["target_delay"] = late;
  const auto rows = static_cast<Eigen::Index>(target_deg.size());
  Inputs inputs;
  inputs.t_s = Eigen::VectorXd::LinSpaced(rows, 0.0, 0.01 * static_cast<double>(rows - 1));
  inputs.runs = {{0, rows, ""}};
  inputs.closed_loop = true;
  inputs.target_moves = moves;
  inputs.target_deg = Eigen::Map<const Eigen::VectorXd>(target_deg.data(), rows);
  inputs.seen_deg = inputs.seen_dps = inputs.servo_A = inputs.servo_integral = Eigen::VectorXd::Zero(rows);
  const Instance<double> instance(model, {}, {}, standard_catalogue());
  const AxisRollout<double> rollout(instance, inputs);
  AxisState<double> state = rollout.start(0, 0.0, 0.0, 0.0);
  std::vector<double> angle;
  rollout.window(inputs.runs[0], 0, rows, state,
                 [&](Eigen::Index, const AxisReadings<double>& read) { angle.push_back(read.angle_deg); });
  return angle;
}

}  // namespace

TEST_CASE("a target that is late by some rows moves the axis as one that was logged so much later") {
  const std::size_t rows = 300, late = 4;
  std::vector<double> target, later;
  for (std::size_t i = 0; i < rows; ++i) {
    const auto at = [](std::size_t k) { return 30.0 * std::sin(0.05 * static_cast<double>(k)); };
    target.push_back(at(i));
    later.push_back(i < late ? target.front() : at(i - late));
  }
  for (const bool moves : {true, false}) {
    CAPTURE(moves);
    const std::vector<double> delayed = served(target, moves, {{"s", 0.01 * late}}),
                              shifted = served(later, moves, {});
    // A target that holds is averaged over half a row: an eighth of a step of the servo's target at most.
    CHECK(furthest(delayed, shifted) < (moves ? 1e-6 : 0.4));
    CHECK(furthest(served(target, moves, {}), shifted) > 5.0);
    CHECK(furthest(served(target, moves, {{"s", 0.0}}), served(target, moves, {})) < 1e-12);
  }
}
