// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The wiring between a robot of 29 joints and its log: what is wrong is named with its joints, and nothing else is.

#include "../catch.hpp"
#include "humanoid.hpp"

#include <thermopower/robot/wiring.hpp>

#include <functional>

namespace robot = thermopower::robot;

namespace {

const robot::MujocoBody& body() {
  static const robot::MujocoBody one("humanoid", test::Humanoid::mjcf());
  return one;
}

const robot::Log& sound() {
  static const robot::Log log = test::Humanoid::log(body(), {}, 7);
  return log;
}

int joint(const std::string& name) {
  const std::vector<std::string> names = test::Humanoid::names();
  return static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
}

std::string said(const robot::Wiring& wiring) {
  std::string out;
  for (const auto& one : wiring.findings) out += one.text + "\n";
  return out;
}

}  // namespace

TEST_CASE("nothing is found wrong in sound logs of any kind") {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    CAPTURE(seed);
    const robot::Log log = test::Humanoid::log(body(), test::Humanoid::draw(seed), seed);
    const robot::Wiring wiring = robot::check_wiring(body(), body().robot(), log);
    for (const auto& one : wiring.findings) {
      CAPTURE(one.text);
      CHECK(one.fault == robot::WiringFault::delay);
    }
  }
}

TEST_CASE("a fault of the wiring is named with its joints, and put right") {
  const int hip = joint("left_hip_pitch"), elbow = joint("right_elbow"), knee = joint("left_knee");
  const auto exchange = [&](Eigen::MatrixXd& of) { of.col(hip).swap(of.col(elbow)); };
  const struct {
    const char* text;
    std::function<void(robot::Log&)> spoil;
  } cases[] = {
      {"the targets of left_hip_pitch and right_elbow are exchanged\n",
       [&](robot::Log& log) { exchange(log.target); }},
      {"the positions of left_hip_pitch and right_elbow are exchanged\n",
       [&](robot::Log& log) { exchange(log.position); }},
      {"the velocities of left_hip_pitch and right_elbow are exchanged\n",
       [&](robot::Log& log) { exchange(log.velocity); }},
      {"the efforts of left_hip_pitch and right_elbow are exchanged\n",
       [&](robot::Log& log) { exchange(log.effort); }},
      {"the targets of left_knee count the other way round\n",
       [&](robot::Log& log) { log.target.col(knee) *= -1.0; }},
      {"the positions of left_knee count the other way round\n",
       [&](robot::Log& log) { log.position.col(knee) *= -1.0; }},
      {"the efforts of left_knee count the other way round\n",
       [&](robot::Log& log) { log.effort.col(knee) *= -1.0; }},
      {"the targets of all joints are in degrees\n",
       [](robot::Log& log) { log.target *= 57.29577951308232; }},
      {"the velocities of all joints are in revolutions per minute\n",
       [](robot::Log& log) { log.velocity *= 9.549296585513721; }},
      {"the efforts of all joints are in mN m\n", [](robot::Log& log) { log.effort *= 1000.0; }},
  };
  for (const auto& one : cases) {
    CAPTURE(one.text);
    robot::Log log = sound();
    one.spoil(log);
    const robot::Wiring wiring = robot::check_wiring(body(), body().robot(), log);
    CHECK(said(wiring) == one.text);
    robot::mend(wiring, log);
    CHECK(log.position.isApprox(sound().position, 1e-9));
    CHECK(log.velocity.isApprox(sound().velocity, 1e-9));
    CHECK(log.target.isApprox(sound().target, 1e-9));
    CHECK(log.effort.isApprox(sound().effort, 1e-9));
  }
}

TEST_CASE("all columns of two joints exchanged are told from the columns of one quantity") {
  robot::Log log = sound();
  const int hip = joint("left_hip_pitch"), elbow = joint("right_elbow");
  for (Eigen::MatrixXd* of : {&log.position, &log.velocity, &log.target, &log.effort})
    of->col(hip).swap(of->col(elbow));
  const robot::Wiring wiring = robot::check_wiring(body(), body().robot(), log);
  REQUIRE(!wiring.findings.empty());
  CHECK(wiring.findings[0].fault == robot::WiringFault::exchanged);
  CHECK(wiring.findings[0].text == "all columns of left_hip_pitch and right_elbow are exchanged");
}

TEST_CASE("gains in another order, and gains per degree, are told from the efforts") {
  const int hip = joint("left_hip_pitch"), elbow = joint("right_elbow");
  robot::Robot swapped = body().robot(), per_degree = swapped;
  auto &a = swapped.joints[static_cast<std::size_t>(hip)],
       &b = swapped.joints[static_cast<std::size_t>(elbow)];
  std::swap(a.kp, b.kp);
  std::swap(a.kd, b.kd);
  robot::Wiring wiring = robot::check_wiring(body(), swapped, sound());
  CHECK(said(wiring) == "the gains of left_hip_pitch and right_elbow are exchanged\n");
  robot::mend(wiring, swapped);
  CHECK(a.kp == body().robot().joints[static_cast<std::size_t>(hip)].kp);
  for (robot::Joint& one : per_degree.joints) one.kp /= 57.29577951308232, one.kd /= 57.29577951308232;
  wiring = robot::check_wiring(body(), per_degree, sound());
  REQUIRE(wiring.findings.size() == 1);
  CHECK(wiring.findings[0].fault == robot::WiringFault::unit);
  robot::mend(wiring, per_degree);
  CHECK(per_degree.joints[0].kp == Approx(body().robot().joints[0].kp));
}

TEST_CASE("targets that are logged early are a delay of the whole bus") {
  robot::Log log = sound();
  const Eigen::Index late = 3, rows = log.rows();
  const Eigen::MatrixXd target = log.target;
  log.target.topRows(rows - late) = target.bottomRows(rows - late);
  const robot::Wiring wiring = robot::check_wiring(body(), body().robot(), log);
  REQUIRE(wiring.findings.size() == 1);
  CHECK(wiring.findings[0].fault == robot::WiringFault::delay);
  CHECK(wiring.target_delay_s == Approx(0.015).margin(0.001));
}
