// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../fixture.hpp"

#include <cmath>
#include <cstdint>

namespace engine_fixture {

/// A joint of the fixture's inertia and torque constant under slow and fast commands: semi-implicit steps of 10 us, which
/// share no equation and no integrator with the library.
/// @param drag  of a rate in rad/s: what acts against it, in N m
template <class Drag>
Recording joint_in_fine_steps(Drag&& drag, std::uint64_t seed) {
  constexpr Eigen::Index rows = 3000;
  constexpr double dt_s = 0.01, step_s = 1e-5, angle_noise_deg = 0.02, rate_noise_dps = 0.15;
  Recording recording;
  recording.name = "joint";
  recording.t_s = Eigen::VectorXd::LinSpaced(rows, 0.0, dt_s * static_cast<double>(rows - 1));
  Eigen::VectorXd drive(rows), angle(rows), rate(rows);
  Noise noise(seed);
  double position = 0.0, speed = 0.0;
  for (Eigen::Index i = 0; i < rows; ++i) {
    const double t_s = recording.t_s[i];
    drive[i] = 0.16 * std::sin(1.7 * t_s) * std::sin(0.31 * t_s) + 0.05 * std::sin(5.3 * t_s);
    angle[i] = position * 57.29577951308232 + angle_noise_deg * noise.normal();
    rate[i] = speed * 57.29577951308232 + rate_noise_dps * noise.normal();
    for (int k = 0; k < static_cast<int>(dt_s / step_s + 0.5); ++k) {
      speed += step_s / 1e-3 * (0.1 * drive[i] - drag(speed));
      position += step_s * speed;
    }
  }
  recording.set("drive_A", drive);
  recording.set("angle_deg", angle);
  recording.set("rate_dps", rate);
  return recording;
}

}  // namespace engine_fixture
