// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/recording.hpp>
#include <thermopower/plant/thermal_network.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <random>

namespace test {

/// A motor bolted to a frame, with equations of its own: winding, stator, frame, mount, and a part behind the frame.
struct BoltedMotor {
  // Its network, as whoever built it would write it down.
  double winding_J_per_K = 22.0, stator_J_per_K = 95.0, frame_J_per_K = 420.0, mount_J_per_K = 1500.0;
  double winding_to_stator_W_per_K = 0.9, stator_to_frame_W_per_K = 1.6, frame_to_mount_W_per_K = 1.1,
         frame_to_air_W_per_K = 0.35, mount_to_air_W_per_K = 1.3;
  double resistance_ohm = 0.8, tempco_per_K = 0.00393;
  // What the simulation knows nothing of.
  double winding_to_frame_W_per_K = 0.0, frame_radiates_m2 = 0.0, behind_frame_J_per_K = 0.0,
         behind_frame_W_per_K = 0.0, air_drift_K_per_h = 0.0, air_bias_K = 0.0, stator_share = 0.0,
         stator_to_air_W_per_K = 0.0, frame_thermometer_K = 0.0;
  bool stator_is_measured = false;

  /// What is logged of it in two hours: steps of the current, every 5 s, thermometers with noise and 0.1 K steps.
  thermopower::gap::Recording recorded(unsigned seed) const {
    constexpr Eigen::Index rows = 1440;
    constexpr double interval_s = 5.0;
    std::mt19937 random(seed);
    std::normal_distribution<double> noise;
    thermopower::gap::Recording r;
    r.name = "motor on a frame " + std::to_string(seed);
    r.t_s.resize(rows);
    Eigen::VectorXd current(rows), air(rows), winding(rows), stator(rows), frame(rows);
    const double air_C = 21.0 + static_cast<double>(seed);
    std::array<double, 5> T;
    T.fill(air_C);
    double A = 0.0;
    for (Eigen::Index i = 0; i < rows; ++i) {
      if (i % 72 == 0) A = i % 288 == 216 ? 0.0 : 1.0 + 0.1 * static_cast<double>(random() % 50);
      r.t_s[i] = interval_s * static_cast<double>(i);
      current[i] = A;
      air[i] = air_C;
      const auto read = [&](double C) { return std::round(10.0 * (C + 0.05 * noise(random))) / 10.0; };
      winding[i] = read(T[0]);
      stator[i] = read(T[1]);
      frame[i] = read(T[2] + frame_thermometer_K);
      for (int step = 0; step < 10; ++step)
        walk(T, A, air_C + air_bias_K + air_drift_K_per_h * r.t_s[i] / 3600.0, interval_s / 10.0);
    }
    r.set("current_A", current);
    r.set("ambient_C", air);
    r.set("winding_C", winding);
    r.set("frame_C", frame);
    if (stator_is_measured) r.set("stator_C", stator);
    return r;
  }

private:
  std::array<double, 5> slope(const std::array<double, 5>& T, double A, double air_C) const {
    const double heat = A * A * resistance_ohm * (1.0 + tempco_per_K * (T[0] - 25.0));
    const double to_stator = winding_to_stator_W_per_K * (T[0] - T[1]),
                 to_frame = stator_to_frame_W_per_K * (T[1] - T[2]),
                 past_stator = winding_to_frame_W_per_K * (T[0] - T[2]),
                 to_mount = frame_to_mount_W_per_K * (T[2] - T[3]),
                 behind = behind_frame_W_per_K * (T[2] - T[4]);
    const double radiated =
        5.670374419e-8 * frame_radiates_m2 * (std::pow(T[2] + 273.15, 4.0) - std::pow(air_C + 273.15, 4.0));
    return {((1.0 - stator_share) * heat - to_stator - past_stator) / winding_J_per_K,
            (stator_share * heat + to_stator - to_frame - stator_to_air_W_per_K * (T[1] - air_C)) /
                stator_J_per_K,
            (to_frame + past_stator - to_mount - behind - radiated - frame_to_air_W_per_K * (T[2] - air_C)) /
                frame_J_per_K,
            (to_mount - mount_to_air_W_per_K * (T[3] - air_C)) / mount_J_per_K,
            behind_frame_J_per_K > 0.0 ? behind / behind_frame_J_per_K : 0.0};
  }

  /// The midpoint rule.
  void walk(std::array<double, 5>& T, double A, double air_C, double h_s) const {
    std::array<double, 5> middle = T;
    const std::array<double, 5> first = slope(T, A, air_C);
    for (std::size_t i = 0; i < 5; ++i) middle[i] += 0.5 * h_s * first[i];
    const std::array<double, 5> rate = slope(middle, A, air_C);
    for (std::size_t i = 0; i < 5; ++i) T[i] += h_s * rate[i];
  }
};

/// What whoever built it would write down: its four parts, and nothing else.
inline thermopower::plant::ThermalNetwork network_of(const BoltedMotor& motor) {
  thermopower::plant::ThermalNetwork network;
  network.nodes = {{"winding", motor.winding_J_per_K, "winding_C"},
                   {"stator", motor.stator_J_per_K, motor.stator_is_measured ? "stator_C" : ""},
                   {"frame", motor.frame_J_per_K, "frame_C"},
                   {"mount", motor.mount_J_per_K}};
  network.given = {{"air", "ambient_C"}};
  network.links = {{"winding", "stator", motor.winding_to_stator_W_per_K},
                   {"stator", "frame", motor.stator_to_frame_W_per_K},
                   {"frame", "mount", motor.frame_to_mount_W_per_K},
                   {"frame", "air", motor.frame_to_air_W_per_K},
                   {"mount", "air", motor.mount_to_air_W_per_K}};
  network.heat = {
      {"current_A",
       {{"winding", 1.0}},
       thermopower::plant::NetworkWinding{"winding", motor.resistance_ohm, motor.tempco_per_K, 25.0}}};
  return network;
}

}  // namespace test
