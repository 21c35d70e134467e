// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// A whole robot: names, the body that MuJoCo answers for, and the diagnosis of two links whose truth is known.

#include "../catch.hpp"
#include "hidden_truth.hpp"
#include "two_links.hpp"

#include "mujoco_body.hpp"
#include "robot_files.hpp"

#include <thermopower/robot/diagnose.hpp>
#include <thermopower/robot/effort_timing.hpp>
#include <thermopower/robot/names.hpp>
#include <thermopower/robot/table.hpp>

#include <algorithm>

namespace robot = thermopower::robot;

namespace {

robot::Robot with_gains(const robot::MujocoBody& body) {
  robot::Robot out = body.robot();
  for (robot::Joint& joint : out.joints) joint.kp = test::TwoLinks::kp, joint.kd = test::TwoLinks::kd;
  return out;
}

bool tells(const robot::JointDiagnosis& joint, robot::Family family) {
  return std::any_of(joint.causes.begin(), joint.causes.end(),
                     [&](const robot::Term& term) { return term.family == family; });
}

const robot::Change* change(const robot::JointDiagnosis& joint, const std::string& name) {
  for (const robot::Change& one : joint.changes)
    if (one.name == name) return &one;
  return nullptr;
}

}  // namespace

TEST_CASE("a column's name says which joint and which quantity it holds") {
  robot::Robot dog;
  for (const char* name : {"FL_hip_joint", "FL_thigh_joint", "FR_hip_joint"}) {
    dog.joints.emplace_back();
    dog.joints.back().name = name;
  }
  const robot::NameMatcher matcher(dog);
  const auto of = [&](const std::string& name) { return matcher.match({name}).front(); };
  const struct {
    const char* name;
    robot::Role role;
    int joint;
    double factor;
  } cases[] = {{"FL_hip_joint/position_rad", robot::Role::position, 0, 1.0},
               {"FR_hip_joint/target_rad", robot::Role::target, 2, 1.0},
               {"/joint_states.position[FL_thigh_joint]", robot::Role::position, 1, 1.0},
               {"/joint_states.velocity[FL_thigh_joint]", robot::Role::velocity, 1, 1.0},
               {"/joint_states.effort[FR_hip_joint]", robot::Role::effort, 2, 1.0},
               {"tau_FL_hip", robot::Role::effort, 0, 1.0},
               {"FL_hip_pos_deg", robot::Role::position, 0, 0.017453292519943295},
               {"FL_hip.rate_dps", robot::Role::velocity, 0, 0.017453292519943295},
               {"desired_position/FL_hip", robot::Role::target, 0, 1.0},
               {"FL_hip_joint/torque_cmd", robot::Role::feed, 0, 1.0},
               {"q_1", robot::Role::position, 0, 1.0},
               {"base_position_x_m", robot::Role::base_pose, 0, 1.0},
               {"base_orientation_w", robot::Role::base_pose, 3, 1.0},
               {"FL_hip_joint/temperature", robot::Role::none, 0, 1.0},
               {"battery_V", robot::Role::none, -1, 1.0}};
  for (const auto& one : cases) {
    CAPTURE(one.name);
    const robot::ColumnMeaning meaning = of(one.name);
    CHECK(meaning.role == one.role);
    if (one.role == robot::Role::none) continue;
    CHECK(meaning.joint == one.joint);
    CHECK(meaning.factor == Approx(one.factor));
  }
  // Numbers from 0 on, unless some column has a name.
  const auto numbered = matcher.match({"q_0", "q_1", "q_2", "q_3"});
  CHECK(numbered[2].joint == 2);
  CHECK(numbered[3].role == robot::Role::none);
  CHECK(matcher.match({"q_0", "FL_hip_joint/position"})[0].role == robot::Role::none);
}

TEST_CASE("joints on both sides and at both ends are built alike") {
  CHECK(robot::side_free_name("FL_hip_joint") == robot::side_free_name("RR_hip_joint"));
  CHECK(robot::side_free_name("left_elbow") == robot::side_free_name("right_elbow"));
  CHECK(robot::side_free_name("l_knee") == "*_knee");
  CHECK(robot::side_free_name("elbow") == "elbow");
}

TEST_CASE("a zero-phase filter leaves a slow sine where it is, and takes a fast one away") {
  const robot::ZeroPhaseFilter filter(0.1);
  Eigen::VectorXd slow(400), fast(400);
  for (Eigen::Index i = 0; i < 400; ++i) {
    slow[i] = std::sin(0.05 * static_cast<double>(i));
    fast[i] = std::sin(2.5 * static_cast<double>(i));
  }
  // Run twice, a Butterworth filter of third order passes 1 / (1 + (tan(w/2) / tan(pi 0.1))^6).
  const double gain = 1.0 / (1.0 + std::pow(std::tan(0.025) / std::tan(0.31415926535), 6));
  CHECK((filter(slow) - gain * slow).segment(50, 300).cwiseAbs().maxCoeff() < 1e-4);
  CHECK(filter(fast).segment(50, 300).cwiseAbs().maxCoeff() < 1e-3);
}

TEST_CASE("MuJoCo asks for the torques that the textbook's two links take") {
  const robot::MujocoBody body("two links", test::TwoLinks::mjcf());
  REQUIRE(body.robot().joints.size() == 2);
  CHECK(body.robot().joints[0].kp == 30.0);
  CHECK(body.robot().joints[1].friction == 0.1);
  robot::Motion motion;
  motion.position.resize(2, 2);
  motion.position << 0.4, -0.9, -1.2, 0.3;
  motion.velocity.resize(2, 2);
  motion.velocity << 1.1, -0.7, 0.2, 2.0;
  motion.acceleration.resize(2, 2);
  motion.acceleration << 3.0, -5.0, 0.5, 1.0;
  const robot::BodyRows rows = body.ask(motion);
  for (Eigen::Index row = 0; row < 2; ++row) {
    const double q[2] = {motion.position(row, 0), motion.position(row, 1)},
                 w[2] = {motion.velocity(row, 0), motion.velocity(row, 1)},
                 a[2] = {motion.acceleration(row, 0), motion.acceleration(row, 1)}, none[2] = {0.0, 0.0};
    const auto torque = test::TwoLinks::torque(q, w, a), weight = test::TwoLinks::torque(q, none, none);
    for (Eigen::Index j = 0; j < 2; ++j) {
      CHECK(rows.torque(row, j) == Approx(torque[static_cast<std::size_t>(j)]));
      CHECK(rows.gravity(row, j) == Approx(weight[static_cast<std::size_t>(j)]));
    }
    // One kg m along the link, and one across it.
    const double along = 9.81 * std::sin(q[0]), across = 9.81 * std::cos(q[0]);
    const double a1 = std::fabs(rows.moment_a(row, 0)), b1 = std::fabs(rows.moment_b(row, 0));
    CHECK(std::min(std::fabs(a1 - std::fabs(along)), std::fabs(a1 - std::fabs(across))) < 1e-9);
    CHECK(a1 * a1 + b1 * b1 == Approx(9.81 * 9.81));
    const double moved[2] = {a[0] + 1.0, a[1]};
    CHECK(rows.inertia(row, 0) ==
          Approx(test::TwoLinks::torque(q, w, moved)[0] - test::TwoLinks::torque(q, w, a)[0]));
  }
}

TEST_CASE("in a simulation MuJoCo moves as the textbook's two links do") {
  const robot::MujocoBody body("two links", test::TwoLinks::mjcf());
  test::TwoLinks::Truth truth;
  truth.friction = {0.0, 0.0};
  const robot::Log log = test::TwoLinks::log(truth, 0.0, 1, false, 4.0);
  std::vector<robot::JointDynamics> joints(2);
  for (auto& joint : joints) {
    joint.armature = 0.01;
    joint.damping = 0.1;
    joint.kp = test::TwoLinks::kp;
    joint.kd = test::TwoLinks::kd;
  }
  Eigen::MatrixXd start = Eigen::MatrixXd::Zero(2, 2);
  start.row(0) = log.position.row(0);
  const Eigen::MatrixXd position = body.simulate(log.t_s, log.target, start, joints, {});
  // Steps of 1 ms of first order: some mrad.
  CHECK((position - log.position).cwiseAbs().maxCoeff() < 0.01);
}

TEST_CASE("a sound robot has no gap, from targets and from efforts") {
  const robot::MujocoBody body("two links", test::TwoLinks::mjcf());
  for (const bool with_effort : {false, true}) {
    CAPTURE(with_effort);
    const robot::Log log = test::TwoLinks::log({}, 1e-4, 3, with_effort);
    const robot::RobotDiagnosis diagnosis = robot::diagnose(body, with_gains(body), log, {});
    for (const robot::JointDiagnosis& joint : diagnosis.joints) {
      CAPTURE(joint.name);
      CHECK(joint.verdict == robot::JointVerdict::no_gap);
      CHECK(joint.causes.empty());
    }
  }
}

TEST_CASE("friction in one joint is found there, with its size, and the other joint is not accused") {
  const robot::MujocoBody body("two links", test::TwoLinks::mjcf());
  test::TwoLinks::Truth truth;
  truth.friction = {0.1, 0.35};
  for (const bool with_effort : {false, true}) {
    CAPTURE(with_effort);
    const robot::Log log = test::TwoLinks::log(truth, 1e-4, 4, with_effort);
    const robot::RobotDiagnosis diagnosis = robot::diagnose(body, with_gains(body), log, {});
    CHECK(diagnosis.joints[0].causes.empty());
    REQUIRE(tells(diagnosis.joints[1], robot::Family::friction));
    CHECK(diagnosis.joints[1].causes.size() == 1);
    CHECK(diagnosis.joints[1].found.friction == Approx(0.35).margin(0.03));
    CHECK(diagnosis.joints[1].effort.after < 0.2 * diagnosis.joints[1].effort.before);
    CHECK(change(diagnosis.joints[1], "friction")->from == 0.1);
  }
}

TEST_CASE(
    "whenever in its row an effort is logged, sound joints are not accused, and those with an effect are found") {
  using Logged = test::HiddenTruth::Logged;
  for (const Logged logged : {Logged::after_jump, Logged::before_jump, Logged::averaged}) {
    test::HiddenTruth truth(test::HiddenTruth::Kind::arm, 2);
    const robot::Log log = truth.log(true, 20.0, logged);
    const robot::MujocoBody body("model", truth.model());
    const robot::RobotDiagnosis diagnosis = robot::diagnose(body, body.robot(), log, {});
    for (std::size_t j = 0; j < diagnosis.joints.size(); ++j) {
      CAPTURE(static_cast<int>(logged), j);
      const auto is_here = [&](const test::HiddenTruth::Effect& one) {
        return one.joint == static_cast<int>(j);
      };
      const bool affected = std::any_of(truth.effects().begin(), truth.effects().end(), is_here);
      CHECK(diagnosis.joints[j].causes.empty() != affected);
    }
  }
}

TEST_CASE("the rate at a jump of the effort is below its mean by what a stepped joint shows") {
  for (const double x : {1e-3, 0.05, 0.7, 3.0}) {
    CAPTURE(x);
    // I w' = -kd w + f, where f falls from 1/2 to -1/2 in each row; I = 1, h = 1, kd = x.
    constexpr int parts = 20000, periods = 40;
    double w = 0.0, at_jump = 0.0, sum = 0.0;
    const int rows = x < 0.1 ? 1 : periods;
    // A slow joint does not settle in some rows: it sets out from where the period closes, by symmetry of the mean.
    if (rows == 1) w = -1.0 / 12.0;
    for (int row = 0; row < rows; ++row) {
      at_jump = w;
      sum = 0.0;
      for (int i = 0; i < parts; ++i) {
        const double t = (i + 0.5) / parts, middle = w + 0.5 / parts * (0.5 - t - x * w);
        w += (0.5 - t - x * middle) / parts;
        sum += middle / parts;
      }
    }
    CHECK(robot::ripple_share(x) == Approx(x * (sum - at_jump)).epsilon(0.01));
  }
}

TEST_CASE("a joint that the log lacks is not judged, and the reason says so") {
  const robot::MujocoBody body("two links", test::TwoLinks::mjcf());
  robot::Log log = test::TwoLinks::log({}, 1e-4, 5, false, 10.0);
  log.target.resize(0, 0);
  const robot::RobotDiagnosis diagnosis = robot::diagnose(body, with_gains(body), log, {});
  CHECK(diagnosis.joints[0].verdict == robot::JointVerdict::not_judged);
  CHECK(diagnosis.joints[0].reason == "the log has neither its effort nor its target");
  CHECK(robot::table_text(diagnosis).find("not_judged: the log has neither") != std::string::npos);
}

TEST_CASE("the amended file holds what changed and nothing else, and MuJoCo loads it") {
  const std::string text = test::TwoLinks::mjcf();
  const robot::MujocoBody body("two links", text);
  robot::RobotDiagnosis diagnosis;
  diagnosis.robot = body.robot();
  diagnosis.joints.resize(2);
  diagnosis.joints[0].name = "left_shoulder";
  diagnosis.joints[1].name = "left_elbow";
  diagnosis.joints[1].causes.push_back({robot::Family::friction, {}, 1.0, {}});
  diagnosis.joints[1].changes = {{"friction", "N m", 0.1, 0.35, 0.01},
                                 {"drag", "N m s2/rad2", 0.0, 0.2, 0.01}};
  diagnosis.joints[1].found.friction = 0.35;
  const robot::AmendedFile file = robot::amended_mjcf(text, diagnosis);
  const robot::MujocoBody again("amended", file.text);
  CHECK(again.robot().joints[1].friction == 0.35);
  CHECK(again.robot().joints[1].damping == 0.1);
  CHECK(again.robot().joints[0].friction == 0.1);
  REQUIRE(file.left_out.size() == 1);
  CHECK(file.left_out[0].find("drag 0 to 0.2") != std::string::npos);
  CHECK(file.text.find("<!-- thermopower: left_elbow: friction 0.1 to 0.35 (standard error 0.01) N m.") !=
        std::string::npos);
}

TEST_CASE("a file that is not a robot is refused with what was expected") {
  CHECK_THROWS_WITH(robot::MujocoBody("x.xml", "<html></html>"),
                    "x.xml: is not a robot; expected an MJCF file (<mujoco>) or a URDF file (<robot>)");
}

TEST_CASE("a robot in URDF has its limits and frictions") {
  const robot::MujocoBody body("arm.urdf", R"(<robot name="arm"><link name="base"/>
<link name="upper"><inertial><origin xyz="0 0 -0.1"/><mass value="1"/>
<inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>
<visual><geometry><mesh filename="missing.stl"/></geometry></visual></link>
<joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 1 0"/>
<limit lower="-1" upper="1" effort="7" velocity="3"/><dynamics damping="0.2" friction="0.3"/></joint></robot>)");
  REQUIRE(body.robot().joints.size() == 1);
  const robot::Joint& joint = body.robot().joints[0];
  CHECK(body.is_urdf());
  CHECK(joint.name == "shoulder");
  CHECK(joint.damping == 0.2);
  CHECK(joint.friction == 0.3);
  CHECK(joint.effort_limit == 7.0);
  CHECK(joint.upper == 1.0);
}
