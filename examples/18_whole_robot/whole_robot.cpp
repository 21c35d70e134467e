// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
//
// A quadruped that hangs in the air and swings its twelve joints. The real one differs from its model in two ways: the knee of the
// left front leg rubs, and the gears of all hips carry more inertia. In its log the targets of two joints are exchanged.
// The program writes quadruped.xml (the model) and quadruped.csv (the log), for docs/how-to/diagnose-a-robot.md.
//   whole_robot [folder]

#include "mujoco_body.hpp"

#include <thermopower/robot/forward_fit.hpp>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <random>
#include <string>
#include <vector>

namespace robot = thermopower::robot;

namespace {

std::string model() {
  std::string text =
      "<mujoco model=\"quadruped\">\n  <compiler angle=\"radian\"/>\n  <default>\n"
      "    <joint armature=\"0.01\" damping=\"0.2\" frictionloss=\"0.2\"/>\n    <geom type=\"capsule\" size=\"0.03\"/>\n"
      "  </default>\n  <worldbody>\n    <body name=\"trunk\" pos=\"0 0 1\">\n"
      "      <geom type=\"box\" size=\"0.2 0.1 0.05\" mass=\"8\"/>\n";
  std::string actuators;
  for (const std::string leg : {"FL", "FR", "RL", "RR"}) {
    const std::string x = leg[0] == 'F' ? "0.2" : "-0.2", side = leg[1] == 'L' ? "" : "-";
    text += "      <body name=\"" + leg + "_hip\" pos=\"" + x + " " + side +
            "0.1 0\">\n        <joint name=\"" + leg +
            "_hip_joint\" axis=\"1 0 0\"/>\n        <geom fromto=\"0 0 0 0 " + side +
            "0.08 0\" mass=\"0.7\"/>\n" + "        <body name=\"" + leg + "_thigh\" pos=\"0 " + side +
            "0.08 0\">\n          <joint name=\"" + leg +
            "_thigh_joint\" axis=\"0 1 0\"/>\n          <geom fromto=\"0 0 0 0 0 -0.21\" mass=\"1.1\"/>\n" +
            "          <body name=\"" + leg + "_calf\" pos=\"0 0 -0.21\">\n            <joint name=\"" + leg +
            "_calf_joint\" axis=\"0 1 0\"/>\n            <geom fromto=\"0 0 0 0 0 -0.21\" mass=\"0.4\"/>\n" +
            "            <site name=\"" + leg +
            "_foot\" pos=\"0 0 -0.21\"/>\n          </body>\n        </body>\n      </body>\n";
    for (const char* part : {"hip", "thigh", "calf"})
      actuators += "    <general name=\"" + leg + "_" + part + "\" joint=\"" + leg + "_" + part +
                   "_joint\" gainprm=\"30\" biastype=\"affine\" biasprm=\"0 -30 -1.5\"/>\n";
  }
  return text + "    </body>\n  </worldbody>\n  <actuator>\n" + actuators + "  </actuator>\n</mujoco>\n";
}

}  // namespace

int main(int argc, char** argv) {
  const std::string folder = argc > 1 ? std::string(argv[1]) + "/" : "";
  std::ofstream(folder + "quadruped.xml") << model();
  const robot::MujocoBody body("quadruped.xml", model());
  const std::vector<robot::Joint>& joints = body.robot().joints;

  // The real robot.
  std::vector<robot::JointDynamics> real;
  for (const robot::Joint& joint : joints) {
    robot::JointDynamics d = robot::configured(joint);
    if (joint.name.find("hip") != std::string::npos) d.armature = 0.04;
    if (joint.name == "FL_calf_joint") d.friction = 0.9;
    real.push_back(d);
  }

  // Twenty seconds of targets at 200 Hz: four sines in each joint.
  constexpr double step_s = 0.005, turn = 6.283185307179586;
  constexpr Eigen::Index rows = 4000;
  std::mt19937 random(17);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::normal_distribution<double> normal;
  const auto count = static_cast<Eigen::Index>(joints.size());
  const Eigen::VectorXd t_s = Eigen::VectorXd::LinSpaced(rows, 0.0, step_s * static_cast<double>(rows - 1));
  Eigen::MatrixXd target(rows, count);
  for (Eigen::Index j = 0; j < count; ++j) {
    target.col(j).setConstant(j % 3 == 0 ? 0.0 : j % 3 == 1 ? 0.7 : -1.5);
    for (int k = 0; k < 4; ++k) {
      const double amplitude = 0.12 + 0.1 * uniform(random), phase = turn * uniform(random),
                   frequency = 0.15 * std::pow(14.0, 0.25 * (k + uniform(random)));
      target.col(j).array() += amplitude * (turn * frequency * t_s.array() + phase).sin();
    }
  }
  Eigen::MatrixXd start = Eigen::MatrixXd::Zero(2, count);
  start.row(0) = target.row(0);
  const Eigen::MatrixXd position = body.simulate(t_s, target, start, real, {});
  target.col(1).swap(target.col(10));  // FL_thigh_joint and RR_thigh_joint

  std::ofstream log(folder + "quadruped.csv");
  log << "t_s";
  for (const robot::Joint& joint : joints)
    log << ',' << joint.name << "/target_rad," << joint.name << "/position_rad";
  log << '\n';
  for (Eigen::Index row = 0; row < rows; ++row) {
    log << t_s[row];
    for (Eigen::Index j = 0; j < count; ++j)
      log << ',' << target(row, j) << ',' << position(row, j) + 1e-4 * normal(random);
    log << '\n';
  }
  std::printf("wrote %squadruped.xml and %squadruped.csv\n", folder.c_str(), folder.c_str());
  return log ? 0 : 1;
}
