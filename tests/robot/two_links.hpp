// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/robot/log.hpp>

#include <array>
#include <cmath>
#include <random>
#include <string>

namespace test {

/// @brief Two links in a vertical plane on position controllers, from the textbook's equations (Spong, Hutchinson, Vidyasagar,
/// section 7.3): nothing of it comes from MuJoCo or from the library. Angles count from straight down.
struct TwoLinks {
  static constexpr double l1 = 0.3, c1 = 0.15, c2 = 0.1, m1 = 1.2, m2 = 0.7, i1 = 0.01, i2 = 0.004, g = 9.81;
  static constexpr double kp = 30.0, kd = 1.5;

  struct Truth {
    std::array<double, 2> armature{0.01, 0.01}, damping{0.1, 0.1}, friction{0.1, 0.1}, constant{0.0, 0.0},
        spring{0.0, 0.0};
  };

  /// The same as MJCF, with armature, damping and friction as in Truth's defaults.
  static std::string mjcf() {
    return R"(<mujoco model="two links"><compiler angle="radian"/><option gravity="0 0 -9.81"/><worldbody>
<body name="upper"><inertial pos="0 0 -0.15" mass="1.2" diaginertia="0.01 0.01 0.001"/>
  <joint name="left_shoulder" axis="0 -1 0" armature="0.01" damping="0.1" frictionloss="0.1"/>
  <body name="lower" pos="0 0 -0.3"><inertial pos="0 0 -0.1" mass="0.7" diaginertia="0.004 0.004 0.0004"/>
    <joint name="left_elbow" axis="0 -1 0" armature="0.01" damping="0.1" frictionloss="0.1"/></body></body>
</worldbody><actuator>
<position name="a" joint="left_shoulder" kp="30"/><position name="b" joint="left_elbow" kp="30"/></actuator></mujoco>)";
  }

  /// Torques in N m that this motion takes, without armature and friction.
  static std::array<double, 2> torque(const double* q, const double* w, const double* a) {
    const double c = std::cos(q[1]), s = std::sin(q[1]);
    const double m11 = i1 + i2 + m1 * c1 * c1 + m2 * (l1 * l1 + c2 * c2 + 2 * l1 * c2 * c);
    const double m12 = i2 + m2 * (c2 * c2 + l1 * c2 * c), m22 = i2 + m2 * c2 * c2, h = m2 * l1 * c2 * s;
    const double g2 = m2 * g * c2 * std::sin(q[0] + q[1]);
    const double g1 = (m1 * c1 + m2 * l1) * g * std::sin(q[0]) + g2;
    return {m11 * a[0] + m12 * a[1] - h * (2 * w[0] * w[1] + w[1] * w[1]) + g1,
            m12 * a[0] + m22 * a[1] + h * w[0] * w[0] + g2};
  }

  /// Targets in rad at a time in s.
  static std::array<double, 2> targets(double t) {
    return {0.2 + 0.5 * std::sin(2.1 * t) + 0.3 * std::sin(5.3 * t + 1.0),
            -0.3 + 0.6 * std::sin(2.9 * t + 0.5) + 0.3 * std::sin(6.7 * t)};
  }

  /// @param noise  standard deviation of a position in rad
  static thermopower::robot::Log log(const Truth& truth, double noise, unsigned seed, bool with_effort,
                                     double duration_s = 24.0) {
    constexpr double row_s = 0.005;
    constexpr int parts = 10;
    const double h = row_s / parts;
    thermopower::robot::Log out;
    const auto rows = static_cast<Eigen::Index>(duration_s / row_s);
    out.file = "two links";
    out.begin = {0};
    out.t_s.resize(rows);
    out.position.resize(rows, 2);
    out.target.resize(rows, 2);
    if (with_effort) out.effort.resize(rows, 2);
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::array<double, 4> x{0.4, -0.1, 0.0, 0.0};  // angles, rates
    std::array<double, 2> command{};               // target that is in force
    const auto rate = [&](const std::array<double, 4>& at) {
      std::array<double, 2> lacks{};
      const double zero[2] = {0.0, 0.0};
      const auto rest = torque(at.data(), at.data() + 2, zero);
      for (std::size_t j = 0; j < 2; ++j)
        lacks[j] = kp * (command[j] - at[j]) - kd * at[2 + j] - rest[j] - truth.damping[j] * at[2 + j] -
                   truth.friction[j] * std::tanh(at[2 + j] / 0.005) - truth.constant[j] -
                   truth.spring[j] * at[j];
      const double c = std::cos(at[1]);
      const double m11 =
          i1 + i2 + m1 * c1 * c1 + m2 * (l1 * l1 + c2 * c2 + 2 * l1 * c2 * c) + truth.armature[0];
      const double m12 = i2 + m2 * (c2 * c2 + l1 * c2 * c), m22 = i2 + m2 * c2 * c2 + truth.armature[1];
      const double det = m11 * m22 - m12 * m12;
      return std::array<double, 4>{at[2], at[3], (m22 * lacks[0] - m12 * lacks[1]) / det,
                                   (m11 * lacks[1] - m12 * lacks[0]) / det};
    };
    for (Eigen::Index row = 0; row < rows; ++row) {
      const double t = row_s * static_cast<double>(row);
      out.t_s[row] = t;
      for (int j = 0; j < 2; ++j) {
        out.position(row, j) = x[static_cast<std::size_t>(j)] + noise * normal(random);
        out.target(row, j) = targets(t)[static_cast<std::size_t>(j)];
      }
      for (int part = 0; part < parts; ++part) {
        // An effort is measured at some time between two targets: where it is logged, the target moves on all the time.
        const double now = with_effort ? t + h * (part + 0.5) : t;
        const std::array<double, 2> target = targets(now);
        command = target;
        if (part == 0 && with_effort)
          for (std::size_t j = 0; j < 2; ++j)
            out.effort(row, static_cast<Eigen::Index>(j)) =
                kp * (targets(t)[j] - x[j]) - kd * x[2 + j] + 0.01 * normal(random);
        const auto step = [&](const std::array<double, 4>& slope, double share) {
          std::array<double, 4> to = x;
          for (std::size_t i = 0; i < 4; ++i) to[i] += share * h * slope[i];
          return to;
        };
        const auto k1 = rate(x), k2 = rate(step(k1, 0.5)), k3 = rate(step(k2, 0.5)), k4 = rate(step(k3, 1.0));
        for (std::size_t i = 0; i < 4; ++i) x[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
      }
    }
    return out;
  }
};

}  // namespace test
