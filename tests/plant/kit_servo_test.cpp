// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
//
// What servos of hobby and robot kits do beside their gains, against a joint and a servo that are stepped here: the profile in
// closed form, the servo at its period, the joint fifty times in between.

#include "../catch.hpp"

#include <thermopower/gap/simulate.hpp>
#include <thermopower/plant/goal_profile.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

using namespace thermopower::gap;
namespace plant = thermopower::plant;

namespace {

constexpr double deg = 57.29577951308232, row_s = 0.01;

plant::PositionPidServo kit_servo() {
  plant::PositionPidServo servo;
  servo.kp_A_per_deg = 0.04;
  servo.kd_A_s_per_deg = 0.002;
  servo.limit_A = 2.0;
  servo.period_s = 0.005;
  return servo;
}

/// Targets of two seconds each.
double target_at(double t_s) {
  return std::vector<double>{60.0, -20.0, -21.0, 35.0}[static_cast<std::size_t>(t_s / 2.0 + 1e-9) % 4];
}

/// Where a trapezoid from one angle at rest to another is after a time, and how fast.
std::pair<double, double> trapezoid(double from, double to, double dps, double dps2, double t_s) {
  const double way = std::abs(to - from), sign = to < from ? -1.0 : 1.0;
  const double peak = std::min(dps, std::sqrt(way * dps2)), ramp_s = peak / dps2,
               level_s = way / peak - ramp_s;
  if (t_s < ramp_s) return {from + sign * 0.5 * dps2 * t_s * t_s, sign * dps2 * t_s};
  if (t_s < ramp_s + level_s) return {from + sign * peak * (t_s - 0.5 * ramp_s), sign * peak};
  const double left_s = std::max(0.0, 2.0 * ramp_s + level_s - t_s);
  return {to - sign * 0.5 * dps2 * left_s * left_s, sign * dps2 * left_s};
}

/// The joint behind such a servo: its angle at each row.
Eigen::VectorXd truth(const plant::PositionPidServo& servo, int rows) {
  Eigen::VectorXd angle(rows);
  double theta = 0.0, omega = 0.0, command = 0.0;
  for (int row = 0; row < rows; ++row) {
    angle[row] = theta * deg;
    for (int sample = 0; sample < 2; ++sample) {
      const double t_s = row_s * row + 0.005 * sample, since = std::fmod(t_s + 1e-9, 2.0);
      double goal = target_at(row_s * row), goal_dps = 0.0;
      if (servo.profile_dps > 0.0)
        std::tie(goal, goal_dps) = trapezoid(t_s < 2.0 - 1e-6 ? 0.0 : target_at(t_s - 2.0), target_at(t_s),
                                             servo.profile_dps, servo.profile_dps2, since);
      double error = goal - theta * deg;
      if (std::abs(error) <= servo.dead_zone_deg) error = 0.0;
      double next = servo.kp_A_per_deg * error + servo.kd_A_s_per_deg * (goal_dps - omega * deg);
      next = std::clamp(next, -servo.limit_A, servo.limit_A);
      const double most = servo.slew_A_per_s > 0.0 ? servo.slew_A_per_s * 0.005 : 1e9;
      command = std::clamp(next, command - most, command + most);
      for (int i = 0; i < 50; ++i) {
        omega += 1e-4 * (0.2 * command - 1e-3 * omega) / 1e-3;
        theta += 1e-4 * omega;
      }
    }
  }
  return angle;
}

Eigen::VectorXd simulated(const plant::PositionPidServo& servo, int rows) {
  Model model;
  model.name = "kit servo";
  model.axis = RigidAxisModel{1e-3, 1e-3, 0.2};
  model.servo = servo;
  Recording recording;
  recording.name = "kit";
  recording.t_s.resize(rows);
  Eigen::VectorXd target(rows);
  const Eigen::VectorXd start = Eigen::VectorXd::Zero(rows);
  for (int row = 0; row < rows; ++row) {
    recording.t_s[row] = row_s * row;
    target[row] = target_at(row_s * row);
  }
  recording.set("target_deg", target);
  recording.set("angle_deg", start);
  recording.set("rate_dps", start);
  SimulationOptions options;
  options.horizon_s = 0.0;
  for (const auto& one : simulate(model, recording, options))
    if (to_string(one.signal) == "angle_deg") return one.values;
  return {};
}

double apart(const Eigen::VectorXd& a, const Eigen::VectorXd& b) { return (a - b).cwiseAbs().maxCoeff(); }

}  // namespace

TEST_CASE("a profile, a dead zone and a slew of the servo are simulated as the servo has them") {
  const int rows = 800;
  const plant::PositionPidServo plain = kit_servo();
  plant::PositionPidServo servo = plain;
  SECTION("nothing of them") {}
  SECTION("a profile") {
    servo.profile_dps = 90.0;
    servo.profile_dps2 = 300.0;
  }
  SECTION("a dead zone, within which the third target lies") { servo.dead_zone_deg = 1.5; }
  // A quarter of it makes the loop unstable: nobody predicts the phase of its swings.
  SECTION("a slew") { servo.slew_A_per_s = 80.0; }
  const Eigen::VectorXd measured = truth(servo, rows), ours = simulated(servo, rows);
  REQUIRE(ours.size() == rows);
  // Of 80 degrees of travel. The profile is stepped at the servo's period, half a period's way is 0.2 degrees.
  CHECK(apart(measured, ours) < 0.5);
  // Each of them matters here: without it the simulation is elsewhere.
  if (servo.profile_dps > 0.0 || servo.slew_A_per_s > 0.0)
    CHECK(apart(measured, simulated(plain, rows)) > 5.0);
  if (servo.dead_zone_deg > 0.0) CHECK(apart(measured, simulated(plain, rows)) > 0.5);
}

TEST_CASE("a profile without acceleration is a line, and one with it never leaves its bounds") {
  plant::GoalProfile line(50.0, 0.0, 10.0);
  line.go(20.0, 0.1, 0.005);
  CHECK(line.deg() == Approx(15.0));
  line.go(20.0, 0.2, 0.005);
  CHECK(line.deg() == Approx(20.0));
  CHECK(line.dps() == 0.0);
  plant::GoalProfile profile(90.0, 300.0, 0.0);
  double before_deg = 0.0, before_dps = 0.0;
  for (int i = 0; i < 2000; ++i) {
    // The target changes on the way, too.
    profile.go(i % 300 < 110 ? 70.0 : -40.0, 0.005, 0.005);
    CAPTURE(i, profile.deg(), profile.dps());
    CHECK(std::abs(profile.dps()) <= 90.0 + 1e-9);
    CHECK(std::abs(profile.dps() - before_dps) <= 2.0 * 300.0 * 0.005 + 1e-9);
    CHECK(std::abs(profile.deg() - before_deg) <= 90.0 * 0.005 + 1e-9);
    before_deg = profile.deg();
    before_dps = profile.dps();
  }
  profile.go(-40.0, 3.0, 0.005);
  CHECK(profile.deg() == Approx(-40.0));
}
