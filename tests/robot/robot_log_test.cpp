// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Logs of whole robots from MCAP files, and loads that nobody logged.

#include "../catch.hpp"
#include "hidden_truth.hpp"

#include "mujoco_body.hpp"
#include "robot_log.hpp"

#include <thermopower/robot/diagnose.hpp>

#include <cmath>

namespace robot = thermopower::robot;

TEST_CASE("a robot's log is read from MCAP, whatever its encoding and compression") {
  robot::Robot arm;
  arm.name = "arm";
  for (const char* name : {"elbow", "wrist"}) {
    arm.joints.emplace_back();
    arm.joints.back().name = name;
  }
  const struct {
    const char* file;
    Eigen::Index messages;  // of /joint_states
  } files[] = {{"cdr_plain", 120},  {"cdr_zstd", 120},  {"cdr_lz4", 120},
               {"cdr_chunks", 120}, {"json_plain", 19}, {"json_zstd", 120}};
  for (const auto& [file, messages] : files) {
    CAPTURE(file);
    const robot::Log log =
        robot::read_robot_log(std::string(THERMOPOWER_TEST_DATA) + "/mcap/" + file + ".mcap", arm);
    // The writer says: messages at 100 Hz, the elbow at 0.3 sin(i / 9) rad and up to 0.1 mrad more.
    REQUIRE(log.rows() == messages);
    CHECK(log.begin.size() == 1);
    for (Eigen::Index i = 0; i < log.rows(); ++i) {
      const double more = log.position(i, 0) - 0.3 * std::sin(static_cast<double>(i) / 9.0);
      CHECK(more >= -1e-9);
      CHECK(more <= 1e-4 + 1e-9);
    }
    // The first row is that in which every topic has spoken.
    CHECK(log.t_s[messages - 1] - log.t_s[1] ==
          Approx(0.01 * static_cast<double>(messages - 2)).margin(0.001));
    CHECK(robot::Log::has(log.velocity, 1));
    CHECK(robot::Log::has(log.target, 0));  // /elbow/command
    CHECK(!robot::Log::has(log.effort, 0));
  }
}

namespace {

// A quadruped whose efforts are those of the rigid body and of friction as in its model, and of a force under each foot.
robot::Log with_forces(const robot::MujocoBody& body, robot::Log log, double share_of_weight) {
  const robot::Series series = robot::make_series(log);
  const robot::BodyRows rows = body.ask(series.motion);
  const robot::LimbForces forces = body.upward_force(series.motion);
  const double under_a_foot = share_of_weight * body.robot().mass_kg * 9.81 / 4.0;
  for (Eigen::Index j = 0; j < log.effort.cols(); ++j) {
    const robot::Joint& joint = body.robot().joints[static_cast<std::size_t>(j)];
    const Eigen::ArrayXd w = series.motion.velocity.col(j);
    log.effort.col(j) = rows.torque.col(j) + joint.armature * series.motion.acceleration.col(j) +
                        joint.damping * series.motion.velocity.col(j) +
                        (joint.friction * (w / 0.01).tanh()).matrix() + under_a_foot * forces.effort.col(j);
  }
  return log;
}

}  // namespace

TEST_CASE("on the ground the joints whose load nobody knows are refused, and in the air none is") {
  test::HiddenTruth truth(test::HiddenTruth::Kind::quadruped, 1);
  const robot::MujocoBody body("quadruped", truth.model());
  REQUIRE(body.robot().floating_base);
  const robot::Log log = truth.log(true, 12.0);
  const robot::RobotDiagnosis in_air = robot::diagnose(body, body.robot(), with_forces(body, log, 0.0), {});
  CHECK(!in_air.stands_on_ground);
  for (const robot::JointDiagnosis& joint : in_air.joints)
    CHECK(joint.verdict != robot::JointVerdict::not_judged);
  const robot::RobotDiagnosis standing = robot::diagnose(body, body.robot(), with_forces(body, log, 1.0), {});
  CHECK(standing.stands_on_ground);
  for (const robot::JointDiagnosis& joint : standing.joints) {
    CAPTURE(joint.name);
    CHECK(joint.verdict == robot::JointVerdict::not_judged);
    CHECK(joint.reason ==
          "its limb stands on the ground, and nobody logged the force there: log in the air or on a stand");
    CHECK(joint.causes.empty());
  }
  // The user knows better.
  robot::Options options;
  options.in_the_air = true;
  const robot::RobotDiagnosis told =
      robot::diagnose(body, body.robot(), with_forces(body, log, 1.0), {}, options);
  CHECK(!told.stands_on_ground);
}

TEST_CASE("a base that moves is an input where it is logged") {
  test::HiddenTruth truth(test::HiddenTruth::Kind::quadruped, 1);
  const robot::MujocoBody body("quadruped", truth.model());
  robot::Log log = truth.log(true, 12.0);
  // The trunk pitches by 0.3 rad and bobs by 8 cm.
  log.base_pose.resize(log.rows(), 7);
  for (Eigen::Index row = 0; row < log.rows(); ++row) {
    const double t = log.t_s[row], pitch = 0.3 * std::sin(3.0 * t);
    log.base_pose.row(row) << 0.0, 0.0, 1.0 + 0.08 * std::sin(6.0 * t), std::cos(0.5 * pitch), 0.0,
        std::sin(0.5 * pitch), 0.0;
  }
  const robot::Series series = robot::make_series(log);
  REQUIRE(series.motion.base_velocity.rows() == series.rows());
  const Eigen::Index middle = series.rows() / 2;
  const double t = series.t_s[middle];
  CHECK(series.motion.base_velocity(middle, 2) == Approx(0.48 * std::cos(6.0 * t)).margin(0.005));
  CHECK(series.motion.base_velocity(middle, 4) == Approx(0.9 * std::cos(3.0 * t)).margin(0.01));
  CHECK(series.motion.base_acceleration(middle, 2) == Approx(-2.88 * std::sin(6.0 * t)).margin(0.05));
  CHECK(series.motion.base_acceleration(middle, 4) == Approx(-2.7 * std::sin(3.0 * t)).margin(0.05));
  const robot::Log moving = with_forces(body, log, 0.0);
  const robot::RobotDiagnosis with_base = robot::diagnose(body, body.robot(), moving, {});
  for (const robot::JointDiagnosis& joint : with_base.joints) {
    CAPTURE(joint.name);
    CHECK(joint.verdict == robot::JointVerdict::no_gap);
  }
}

TEST_CASE(
    "a logged effort accuses no sound joint, whether it is that before or that after the drives take over a target") {
  using Logged = test::HiddenTruth::Logged;
  for (const Logged logged : {Logged::after_jump, Logged::before_jump}) {
    test::HiddenTruth truth(test::HiddenTruth::Kind::arm, 2);
    const robot::Log log = truth.log(true, 20.0, logged);
    const robot::MujocoBody body("arm", truth.model());
    const robot::RobotDiagnosis found = robot::diagnose(body, body.robot(), log, {});
    CHECK(found.delay_s == 0.0);
    for (std::size_t j = 0; j < found.joints.size(); ++j) {
      CAPTURE(found.joints[j].name);
      bool is_sound = true;
      for (const auto& effect : truth.effects()) is_sound = is_sound && effect.joint != static_cast<int>(j);
      CHECK(found.joints[j].causes.empty() == is_sound);
    }
  }
}
