// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "mujoco_body.hpp"

#include <thermopower/robot/forward_fit.hpp>
#include <thermopower/robot/log.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <sstream>
#include <string>
#include <vector>

namespace test {

/// @brief A humanoid of 29 joints on a stand, and logs of it whose constants differ from the model's.
class Humanoid {
public:
  static std::string mjcf() {
    std::ostringstream out;
    out << "<mujoco model=\"humanoid\"><compiler angle=\"radian\" inertiafromgeom=\"false\"/><worldbody>"
           "<body name=\"pelvis\" pos=\"0 0 1\">";
    for (const bool left : {true, false}) {
      const double y = left ? 0.12 : -0.12;
      const std::string s = left ? "left_" : "right_";
      open(out, s + "hip_pitch", "0 1 0", -2.5, 2.9, 0, y, -0.1, 1.5, 0, 0, -0.03);
      open(out, s + "hip_roll", "1 0 0", left ? -0.5 : -3.0, left ? 3.0 : 0.5, 0, 0, -0.03, 1.7, 0.02, 0,
           -0.08);
      open(out, s + "hip_yaw", "0 0 1", -2.7, 2.7, 0.02, 0, -0.1, 1.9, 0, 0, -0.1);
      open(out, s + "knee", "0 1 0", -0.1, 2.9, -0.07, 0, -0.18, 1.9, 0.005, 0, -0.12);
      open(out, s + "ankle_pitch", "0 1 0", -0.87, 0.52, 0, 0, -0.3, 0.2, 0, 0, -0.01);
      open(out, s + "ankle_roll", "1 0 0", -0.26, 0.26, 0, 0, -0.02, 0.8, 0.04, 0, -0.03);
      close(out, 6);
    }
    open(out, "waist_yaw", "0 0 1", -2.6, 2.6, 0, 0, 0.05, 0.3, 0, 0, 0.02);
    open(out, "waist_roll", "1 0 0", -0.52, 0.52, 0, 0, 0.04, 0.2, 0, 0, 0.01);
    open(out, "waist_pitch", "0 1 0", -0.52, 0.52, 0, 0, 0.02, 7.5, 0.01, 0, 0.15);
    for (const bool left : {true, false}) {
      const double y = left ? 0.1 : -0.1;
      const std::string s = left ? "left_" : "right_";
      open(out, s + "shoulder_pitch", "0 1 0", -3.1, 2.7, 0, y, 0.24, 0.7, 0, y / 3, -0.01);
      open(out, s + "shoulder_roll", "1 0 0", left ? -1.6 : -2.3, left ? 2.3 : 1.6, 0, y / 3, -0.02, 0.6, 0,
           0, -0.06);
      open(out, s + "shoulder_yaw", "0 0 1", -2.6, 2.6, 0, 0, -0.1, 0.7, 0.01, 0, -0.06);
      open(out, s + "elbow", "0 1 0", -1.05, 2.1, 0.015, 0, -0.08, 0.6, 0.06, 0, -0.01);
      open(out, s + "wrist_roll", "1 0 0", -1.97, 1.97, 0.1, 0, -0.01, 0.1, 0.02, 0, 0);
      open(out, s + "wrist_pitch", "0 1 0", -1.6, 1.6, 0.04, 0, 0, 0.5, 0.02, 0, 0);
      open(out, s + "wrist_yaw", "0 0 1", -1.6, 1.6, 0.046, 0, 0, 0.25, 0.06, 0, 0);
      close(out, 7);
    }
    close(out, 3);
    out << "</body></worldbody><actuator>";
    std::size_t j = 0;
    for (const std::string& name : names())
      out << "<general name=\"" << name << "\" joint=\"" << name << "\" biastype=\"affine\" gainprm=\""
          << kp(j) << "\" biasprm=\"0 " << -kp(j) << ' ' << -kd(j) << "\"/>",
          ++j;
    out << "</actuator></mujoco>";
    return out.str();
  }

  static std::vector<std::string> names() {
    std::vector<std::string> out;
    for (const std::string s : {"left_", "right_"})
      for (const char* joint : {"hip_pitch", "hip_roll", "hip_yaw", "knee", "ankle_pitch", "ankle_roll"})
        out.push_back(s + joint);
    for (const char* joint : {"waist_yaw", "waist_roll", "waist_pitch"}) out.emplace_back(joint);
    for (const std::string s : {"left_", "right_"})
      for (const char* joint : {"shoulder_pitch", "shoulder_roll", "shoulder_yaw", "elbow", "wrist_roll",
                                "wrist_pitch", "wrist_yaw"})
        out.push_back(s + joint);
    return out;
  }

  // Gains that people use on such robots: strong at the hip, weak at the wrist.
  static double kp(std::size_t j) {
    static const double leg[6] = {100, 100, 100, 150, 40, 30}, arm[7] = {40, 40, 30, 40, 20, 20, 16};
    return j < 12 ? leg[j % 6] : j < 15 ? 120.0 : arm[(j - 15) % 7];
  }
  static double kd(std::size_t j) { return 0.025 * kp(j) + 0.3; }

  /// What a log is like.
  struct Draw {
    double step_s = 0.005, duration_s = 10.0;
    bool with_velocity = true, with_effort = true, one_at_a_time = false, mirrored = false, steps = false;
    double late_s = 0.0;  ///< of the whole bus
    double spread = 3.0;  ///< factor by which constants may differ from the model's
  };

  /// A draw of its own for each seed.
  static Draw draw(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    Draw out;
    out.step_s = uniform(random) < 0.5 ? 0.005 : uniform(random) < 0.5 ? 0.002 : 0.01;
    out.duration_s = 8.0 + 8.0 * uniform(random);
    out.with_velocity = uniform(random) < 0.6;
    out.with_effort = uniform(random) < 0.6;
    const double kind = uniform(random);
    out.one_at_a_time = kind < 0.15;
    out.mirrored = kind > 0.85;
    out.steps = kind > 0.7 && kind <= 0.85;
    out.late_s = uniform(random) < 0.5 ? 0.0 : 0.02 * uniform(random);
    return out;
  }

  static thermopower::robot::Log log(const thermopower::robot::MujocoBody& body, const Draw& draw,
                                     unsigned seed) {
    namespace robot = thermopower::robot;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    std::normal_distribution<double> normal;
    const auto joints = static_cast<Eigen::Index>(body.robot().joints.size());
    const auto rows = static_cast<Eigen::Index>(draw.duration_s / draw.step_s);
    robot::Log out;
    out.file = "humanoid";
    out.begin = {0};
    out.t_s = Eigen::VectorXd::LinSpaced(rows, 0.0, draw.step_s * static_cast<double>(rows - 1));
    out.target.resize(rows, joints);
    std::vector<robot::JointDynamics> truth;
    const auto factor = [&] { return std::pow(draw.spread, 2.0 * uniform(random) - 1.0); };
    Eigen::MatrixXd start = Eigen::MatrixXd::Zero(2, joints);
    for (Eigen::Index j = 0; j < joints; ++j) {
      const robot::Joint& joint = body.robot().joints[static_cast<std::size_t>(j)];
      robot::JointDynamics d = robot::configured(joint);
      d.armature *= factor();
      d.damping *= factor();
      d.friction *= factor();
      d.bias = 0.1 * joint.friction * normal(random);
      d.gravity_error = 0.15 * normal(random);
      d.kp *= 1.0 + 0.05 * normal(random);
      d.delay_s = draw.late_s;
      truth.push_back(d);
      const double lower = std::max(joint.lower, -1.2), upper = std::min(joint.upper, 1.2),
                   middle = 0.5 * (lower + upper) + 0.1 * (upper - lower) * (uniform(random) - 0.5);
      double amplitude[3], frequency[3], phase[3];
      for (int k = 0; k < 3; ++k) {
        amplitude[k] = (upper - lower) * (0.05 + 0.09 * uniform(random));
        frequency[k] = 0.2 + 1.2 * uniform(random);
        phase[k] = 6.283 * uniform(random);
      }
      const double begin = draw.duration_s * static_cast<double>(j) / static_cast<double>(joints) * 0.8,
                   length = std::max(1.5, 0.15 * draw.duration_s);
      double held = middle;
      for (Eigen::Index row = 0; row < rows; ++row) {
        const double t = out.t_s[row];
        double wave = 0.0;
        for (int k = 0; k < 3; ++k) wave += amplitude[k] * std::sin(6.283 * frequency[k] * t + phase[k]);
        if (draw.one_at_a_time)
          wave = t > begin && t < begin + length
                     ? 0.2 * (upper - lower) *
                           std::sin(6.283 * 3.0 * (t - begin) / length * (1.0 + (t - begin) / length))
                     : 0.0;
        if (draw.steps) {
          if (row == 0 || uniform(random) < draw.step_s / 0.8)
            held = middle + 0.3 * (upper - lower) * (uniform(random) - 0.5);
          wave = held - middle;
        }
        out.target(row, j) = middle + wave;
      }
      start(0, j) = out.target(0, j);
    }
    if (draw.mirrored)  // both sides get the same targets, mirrored where the range is
      for (Eigen::Index j = 0; j < joints; ++j) {
        const bool right = (j >= 6 && j < 12) || j >= 22;
        if (!right) continue;
        const Eigen::Index left = j < 12 ? j - 6 : j - 7;
        const auto& a = body.robot().joints[static_cast<std::size_t>(j)];
        const auto& b = body.robot().joints[static_cast<std::size_t>(left)];
        const double sign = a.lower == b.lower ? 1.0 : -1.0;
        out.target.col(j) = sign * out.target.col(left);
        start(0, j) = out.target(0, j);
      }
    out.position = body.simulate(out.t_s, out.target, start, truth, {});
    Eigen::MatrixXd velocity(rows, joints);
    for (Eigen::Index j = 0; j < joints; ++j)
      velocity.col(j) = robot::derivative(out.position.col(j), draw.step_s);
    if (draw.with_effort) {
      out.effort.resize(rows, joints);
      const auto late = static_cast<Eigen::Index>(std::lround(draw.late_s / draw.step_s));
      for (Eigen::Index row = 0; row < rows; ++row)
        for (Eigen::Index j = 0; j < joints; ++j) {
          const auto& d = truth[static_cast<std::size_t>(j)];
          const double effort =
              d.kp * (out.target(std::max<Eigen::Index>(0, row - late), j) - out.position(row, j)) -
              d.kd * velocity(row, j);
          out.effort(row, j) = effort * (1.0 + 0.02 * normal(random)) + 0.02 * normal(random);
        }
    }
    const double noise = 2e-5 * std::pow(20.0, uniform(random));
    for (Eigen::Index row = 0; row < rows; ++row)
      for (Eigen::Index j = 0; j < joints; ++j) {
        out.position(row, j) += noise * normal(random);
        velocity(row, j) += 0.02 * normal(random);
      }
    if (draw.with_velocity) out.velocity = velocity;
    return out;
  }

private:
  static void open(std::ostream& out, const std::string& name, const char* axis, double lower, double upper,
                   double x, double y, double z, double mass, double cx, double cy, double cz) {
    const double inertia = 0.002 * mass + 0.0002;
    out << "<body name=\"" << name << "_link\" pos=\"" << x << ' ' << y << ' ' << z << "\"><inertial pos=\""
        << cx << ' ' << cy << ' ' << cz << "\" mass=\"" << mass << "\" diaginertia=\"" << inertia << ' '
        << inertia << ' ' << inertia << "\"/><joint name=\"" << name << "\" axis=\"" << axis
        << "\" limited=\"true\" range=\"" << lower << ' ' << upper
        << "\" armature=\"0.01\" damping=\"0.2\" frictionloss=\"0.3\"/>";
  }
  static void close(std::ostream& out, int bodies) {
    for (int i = 0; i < bodies; ++i) out << "</body>";
  }
};

}  // namespace test
