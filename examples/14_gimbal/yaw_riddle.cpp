// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

/// @file yaw_riddle.cpp
/// Problem: the thesis (section 5.2) saw yaw errors 18 times as large as those of roll and pitch, "for an unknown
/// reason". Is it the order of the Euler angles, near the nadir?
/// Model: the gimbal of point_masses.hpp holds its pose against random torques on its joints. Its attitude is read
/// in two orders: that of its joints (yaw, roll, pitch), and that of aircraft (yaw, pitch, roll), which knows no
/// yaw where the camera looks straight down.
/// Notation: errors are root mean squares over half a minute, in degrees; the factors are the yaw error over
/// that of roll and over that of pitch.

#include "point_masses.hpp"

#include <cmath>
#include <cstdint>
#include <cstdio>

namespace {

using Vector = PointMassGimbal::Vector;
constexpr double deg = 57.29577951308232;

/// Yaw, roll and pitch of an attitude in the order yaw, pitch, roll.
Vector aircraft_angles(const Eigen::Matrix3d& attitude) {
  return {std::atan2(attitude(1, 0), attitude(0, 0)), std::atan2(attitude(2, 1), attitude(2, 2)),
          std::asin(std::fmax(-1.0, std::fmin(1.0, -attitude(2, 0))))};
}

Eigen::Matrix3d attitude_of(const Vector& joints_rad) {
  return (Eigen::AngleAxisd(joints_rad[0], Vector::UnitZ()) *
          Eigen::AngleAxisd(joints_rad[1], Vector::UnitX()) *
          Eigen::AngleAxisd(joints_rad[2], Vector::UnitY()))
      .toRotationMatrix();
}

/// How far an angle is from another, -180 to 180 degrees.
double apart(double a_rad, double b_rad) { return std::remainder(a_rad - b_rad, 2.0 * 3.141592653589793); }

}  // namespace

int main() {
  std::printf(
      "pitch  | joints' order: yaw, roll, pitch; yaw / roll, yaw / pitch | aircraft's order: the same\n");
  for (const double pitch_deg : {0.0, -45.0, -80.0, -86.8, -89.0}) {
    const PointMassGimbal gimbal;
    const Vector held(0.0, 0.0, pitch_deg / deg), aimed = aircraft_angles(attitude_of(held));
    Vector q = held, w = Vector::Zero(), joints = Vector::Zero(), aircraft = Vector::Zero();
    std::uint64_t dice = 11;
    constexpr int rows = 3000;
    Vector pushed = Vector::Zero();
    for (int row = 0; row < rows; ++row) {
      Vector u;
      for (int i = 0; i < 3; ++i) {
        dice = dice * 6364136223846793005u + 1442695040888963407u;
        const double push = static_cast<double>(dice >> 11) / 9007199254740992.0 - 0.5;
        pushed[i] += 0.05 * (push - pushed[i]);  // gusts of a fifth of a second
        const double stiffness = 600.0 * gimbal.inertia(held)(i, i);
        const double torque_Nm =
            stiffness * (0.2 * pushed[i] - (q[i] - held[i]) - 0.06 * w[i]);  // the same unrest on each joint
        u[i] = torque_Nm / gimbal.torque_constant_Nm_per_A[static_cast<std::size_t>(i)];
      }
      for (int k = 0; k < 5; ++k) gimbal.step(q, w, u, 0.002);
      const Vector seen = aircraft_angles(attitude_of(q));
      for (int i = 0; i < 3; ++i) {
        joints[i] += std::pow(apart(q[i], held[i]) * deg, 2) / rows;
        aircraft[i] += std::pow(apart(seen[i], aimed[i]) * deg, 2) / rows;
      }
    }
    const auto line = [](const Vector& squares) {
      const Vector rms = squares.cwiseSqrt();
      std::printf(" | %7.3f %7.3f %7.3f, %5.2f %5.2f", rms[0], rms[1], rms[2], rms[0] / rms[1],
                  rms[0] / rms[2]);
    };
    std::printf("%6.1f", pitch_deg);
    line(joints);
    line(aircraft);
    std::printf("\n");
  }
}
