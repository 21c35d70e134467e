// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

/// Joints under a controller, simulated apart from the library: what the inverse problem must tell of them is known.
namespace closed_loop {

/// Physics that a simulation may lack, in N m.
struct Extra {
  double coulomb = 0.0, gravity = 0.0, gravity_phase = 0.0, spring_per_rad = 0.0, cogging = 0.0, cycles = 0.0,
         constant = 0.0;

  double load(double angle) const {
    return gravity * std::sin(angle + gravity_phase) + spring_per_rad * angle +
           cogging * std::sin(cycles * angle) - constant;
  }
};

struct Joint {
  double inertia_kgm2 = 0.004, viscous_Nms_per_rad = 0.01, torque_constant_Nm_per_A = 0.2;
  Extra extra;
  double stiffness_Hz = 4.0;   ///< of the controller
  bool integral = false;       ///< PID, else PD
  double effort_noise = 0.05;  ///< of the recorded effort, as a share of its RMS
  double rate_noise_dps = 0.1, angle_noise_deg = 0.02;
};

/// A log of it.
struct Log {
  std::vector<double> t_s, drive_A, angle_deg, rate_dps;
};

/// The same numbers with every standard library.
class Random {
public:
  explicit Random(std::uint64_t seed) : state_(seed * 2862933555777941757u + 3037000493u) {}
  double uniform() {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return static_cast<double>(state_ >> 11) / 9007199254740992.0;
  }
  double normal() {
    return std::sqrt(-2.0 * std::log(uniform() + 1e-300)) * std::cos(6.283185307179586 * uniform());
  }

private:
  std::uint64_t state_;
};

/// Lets a joint follow four sines. The controller acts once a row; between rows the joint moves in small steps, and sticks where
/// friction holds it.
inline Log follow(const Joint& joint, double dt_s, int rows, std::uint64_t seed) {
  Random random(seed);
  double hertz[4], phase[4];
  for (int i = 0; i < 4; ++i) {
    hertz[i] = 0.1 * std::pow(0.25 * joint.stiffness_Hz / 0.1, random.uniform());
    phase[i] = 6.283185307179586 * random.uniform();
  }
  const auto target = [&](double t, bool slope) {
    double sum = 0.0;
    for (int i = 0; i < 4; ++i) {
      const double omega = 6.283185307179586 * hertz[i];
      sum += slope ? omega * std::cos(omega * t + phase[i])
                   : std::sin(omega * t + phase[i]) - std::sin(phase[i]);
    }
    return sum;
  };
  const double omega = 6.283185307179586 * joint.stiffness_Hz;
  const double kp = joint.inertia_kgm2 * omega * omega / joint.torque_constant_Nm_per_A,
               kd = 1.4 * joint.inertia_kgm2 * omega / joint.torque_constant_Nm_per_A,
               ki = joint.integral ? 0.25 * omega * kp : 0.0;
  constexpr double deg = 57.29577951308232;
  constexpr int parts = 20;
  Log log;
  double angle = 0.0, rate = 0.0, accumulated = 0.0, square = 0.0;
  for (int row = 0; row < rows; ++row) {
    const double t = row * dt_s;
    const double seen_angle = angle + joint.angle_noise_deg / deg * random.normal(),
                 seen_rate = rate + joint.rate_noise_dps / deg * random.normal();
    const double error = target(t, false) - seen_angle;
    accumulated += error * dt_s;
    const double drive = kp * error + kd * (target(t, true) - seen_rate) + ki * accumulated;
    log.t_s.push_back(t);
    log.drive_A.push_back(drive);
    log.angle_deg.push_back(deg * angle + joint.angle_noise_deg * random.normal());
    log.rate_dps.push_back(deg * rate + joint.rate_noise_dps * random.normal());
    square += drive * drive;
    for (int part = 0; part < parts; ++part) {
      const double h = dt_s / parts;
      const double torque =
          joint.torque_constant_Nm_per_A * drive - joint.viscous_Nms_per_rad * rate - joint.extra.load(angle);
      const double friction = joint.extra.coulomb * h / joint.inertia_kgm2;
      const double free = rate + h * torque / joint.inertia_kgm2;
      // Friction takes away no more than there is.
      const double next = std::fabs(free) <= friction ? 0.0 : free - (free > 0.0 ? friction : -friction);
      angle += 0.5 * h * (rate + next);
      rate = next;
    }
  }
  const double noise = joint.effort_noise * std::sqrt(square / rows);
  for (double& one : log.drive_A) one += noise * random.normal();
  return log;
}

/// RMS of the effort.
inline double effort_rms(const Log& log) {
  double square = 0.0;
  for (const double one : log.drive_A) square += one * one;
  return std::sqrt(square / static_cast<double>(log.drive_A.size()));
}

}  // namespace closed_loop
