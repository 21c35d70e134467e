// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/recording.hpp>

#include <Eigen/Dense>

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

/// A "real" gimbal that shares no equation with the library's: point masses on three nested frames. Their positions
/// are differentiated numerically, which gives the inertia (sum of m J^T J), what the motion asks for
/// (sum of m J^T dJ/dt w) and gravity (sum of m J^T g). No angular velocity, no moment of inertia appears.
class PointMassGimbal {
public:
  using Vector = Eigen::Vector3d;  ///< of yaw, roll, pitch, or of x, y, z

  /// A mass that turns with a stage.
  struct Mass {
    int stage;  ///< 0: yaw, 1: roll, 2: the camera
    double kg;
    Vector at_m;  ///< in the stage's axes: ahead, right, down
  };

  std::vector<Mass> masses = {{0, 0.10, {0.06, 0.0, -0.03}}, {0, 0.10, {-0.06, 0.0, -0.03}},  // yaw stage
                              {1, 0.04, {0.0, 0.07, 0.0}},   {1, 0.04, {0.0, -0.07, 0.0}},    // roll arm
                              {1, 0.03, {0.0, 0.0, 0.05}},   {1, 0.03, {0.0, 0.0, -0.05}},
                              {2, 0.08, {0.08, 0.0, 0.0}},   {2, 0.08, {-0.08, 0.0, 0.0}},  // a long lens
                              {2, 0.06, {0.0, 0.03, 0.0}},   {2, 0.06, {0.0, -0.03, 0.0}},
                              {2, 0.06, {0.0, 0.0, 0.035}},  {2, 0.06, {0.0, 0.0, -0.035}}};
  std::array<double, 3> viscous_Nms_per_rad = {1.5e-3, 1e-3, 8e-4};
  std::array<double, 3> torque_constant_Nm_per_A = {0.12, 0.1, 0.08};
  std::array<double, 3> friction_Nm = {0.0, 0.0, 0.0};       ///< dry
  std::array<double, 3> cable_Nm_per_rad = {0.0, 0.0, 0.0};  ///< springs that rest at 0
  Vector gravity_mps2{0.0, 0.0, 9.81};

  /// Where a mass is in the frame's axes.
  static Vector position(const Mass& mass, const Vector& angle_rad) {
    Vector p = mass.at_m;
    if (mass.stage >= 2) p = Eigen::AngleAxisd(angle_rad[2], Vector::UnitY()) * p;
    if (mass.stage >= 1) p = Eigen::AngleAxisd(angle_rad[1], Vector::UnitX()) * p;
    return Eigen::AngleAxisd(angle_rad[0], Vector::UnitZ()) * p;
  }

  /// Inertia of the joints in a pose, kg m^2.
  Eigen::Matrix3d inertia(const Vector& angle_rad) const {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (const Mass& mass : masses) {
      const Eigen::Matrix3d by_angle = derivative(mass, angle_rad);
      sum += mass.kg * by_angle.transpose() * by_angle;
    }
    return sum;
  }

  /// Kinetic and potential energy, J.
  double energy(const Vector& angle_rad, const Vector& rate) const {
    double sum = 0.5 * rate.dot(inertia(angle_rad) * rate);
    for (const Mass& mass : masses) sum -= mass.kg * gravity_mps2.dot(position(mass, angle_rad));
    return sum;
  }

  /// Angular acceleration of the joints, dry friction left out.
  Vector acceleration(const Vector& angle_rad, const Vector& rate, const Vector& drive_A) const {
    constexpr double h = 1e-4;  // s along the motion
    Vector torque;
    for (int i = 0; i < 3; ++i) {
      const auto at = static_cast<std::size_t>(i);
      torque[i] = torque_constant_Nm_per_A[at] * drive_A[i] - viscous_Nms_per_rad[at] * rate[i] -
                  cable_Nm_per_rad[at] * angle_rad[i];
    }
    for (const Mass& mass : masses) {
      const Vector bends = (position(mass, angle_rad + h * rate) - 2.0 * position(mass, angle_rad) +
                            position(mass, angle_rad - h * rate)) /
                           (h * h);
      torque += mass.kg * derivative(mass, angle_rad).transpose() * (gravity_mps2 - bends);
    }
    return inertia(angle_rad).ldlt().solve(torque);
  }

  /// Moves on by h seconds: a Runge-Kutta step, then dry friction as an impulse that at most stops a joint.
  void step(Vector& angle_rad, Vector& rate, const Vector& drive_A, double h) const {
    const Vector k1 = acceleration(angle_rad, rate, drive_A);
    const Vector w2 = rate + 0.5 * h * k1;
    const Vector k2 = acceleration(angle_rad + 0.5 * h * rate, w2, drive_A);
    const Vector w3 = rate + 0.5 * h * k2;
    const Vector k3 = acceleration(angle_rad + 0.5 * h * w2, w3, drive_A);
    const Vector w4 = rate + h * k3;
    const Vector k4 = acceleration(angle_rad + h * w3, w4, drive_A);
    angle_rad += h / 6.0 * (rate + 2.0 * (w2 + w3) + w4);
    rate += h / 6.0 * (k1 + 2.0 * (k2 + k3) + k4);
    const Eigen::Matrix3d mobility = inertia(angle_rad).inverse();
    for (int i = 0; i < 3; ++i) {
      const double most = h * friction_Nm[static_cast<std::size_t>(i)];
      const double stops = -rate[i] / mobility(i, i);
      rate += mobility.col(i) * std::fmax(-most, std::fmin(most, stops));
    }
  }

  /// A recording at 100 Hz: a controller moves all joints at once along sums of sines; encoders and gyroscopes with
  /// noise.
  /// @param rows  how many
  /// @param seed  of noise and motion
  thermopower::gap::Recording recorded(Eigen::Index rows, std::uint64_t seed) const {
    const char* names[] = {"yaw", "roll", "pitch"};
    thermopower::gap::Recording recording;
    recording.name = "gimbal";
    recording.t_s = Eigen::VectorXd::LinSpaced(rows, 0.0, 0.01 * static_cast<double>(rows - 1));
    Eigen::MatrixXd drive(rows, 3), angle(rows, 3), rate(rows, 3);
    Vector q = Vector::Zero(), w = Vector::Zero(), u = Vector::Zero();
    const double phase = static_cast<double>(seed);
    const double stiffness[] = {2.0, 1.6, 1.4}, damping[] = {0.16, 0.13, 0.1}, reach[] = {0.8, 0.5, 0.9};
    std::uint64_t dice = seed * 977 + 5;
    for (Eigen::Index row = 0; row < rows; ++row) {
      const double t = recording.t_s[row];
      for (int i = 0; i < 3; ++i) {
        const double k = 1.0 + 0.3 * i;
        const double target =
            reach[i] * (0.6 * std::sin(1.3 * k * t + phase + i) + 0.4 * std::sin(4.1 * k * t + 2.0 * phase) +
                        0.15 * std::sin(9.7 * k * t + i));
        u[i] = std::fmax(-2.0, std::fmin(2.0, stiffness[i] * (target - q[i]) - damping[i] * w[i]));
      }
      drive.row(row) = u.transpose();
      for (int i = 0; i < 3; ++i) {
        angle(row, i) = q[i] * 57.29577951308232 + 0.02 * noise(dice);
        rate(row, i) = w[i] * 57.29577951308232 + 0.15 * noise(dice);
      }
      for (int k = 0; k < 5; ++k) step(q, w, u, 0.002);
    }
    for (int i = 0; i < 3; ++i) {
      recording.set(std::string(names[i]) + "_A", drive.col(i));
      recording.set(std::string(names[i]) + "_deg", angle.col(i));
      recording.set(std::string(names[i]) + "_dps", rate.col(i));
    }
    return recording;
  }

private:
  static Eigen::Matrix3d derivative(const Mass& mass, const Vector& angle_rad) {
    constexpr double h = 1e-5;
    Eigen::Matrix3d columns;
    for (int i = 0; i < 3; ++i) {
      const Vector off = h * Vector::Unit(i);
      columns.col(i) = (position(mass, angle_rad + off) - position(mass, angle_rad - off)) / (2.0 * h);
    }
    return columns;
  }

  static double noise(std::uint64_t& state) {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) {
      state = state * 6364136223846793005u + 1442695040888963407u;
      sum += static_cast<double>(state >> 11) / 9007199254740992.0;
    }
    return sum;
  }
};
