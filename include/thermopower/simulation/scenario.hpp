// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <thermopower/simulation/battery.hpp>

/// @file scenario.hpp
/// What happens to a gimbal, as data.

namespace thermopower::simulation {

/// A sine that fades in and out: a base that sways, a wind that comes in gusts.
///
/// @snippet simulation_examples.cpp scenario
/// How to: @ref rig.
struct Wave {
  double amplitude;     ///< Degrees for a base, N m for a torque.
  double frequency_Hz;  ///< >= 0
  double phase_rad;     ///< At time 0.
  double from_s;        ///< Begins to fade in.
  double to_s;          ///< Has faded out; above `from_s`.

  /// Value at a time. It fades over half a second, or half the window where that is shorter.
  double at(double t_s) const noexcept {
    if (t_s <= from_s || t_s >= to_s) return 0.0;
    const double fade_s = std::fmin(0.5, 0.5 * (to_s - from_s));
    const double edge_s = std::fmin(t_s - from_s, to_s - t_s);
    const double share = edge_s >= fade_s ? 1.0 : edge_s / fade_s;
    const double envelope = share * share * (3.0 - 2.0 * share);
    return envelope * amplitude * std::sin(2.0 * M_PI * frequency_Hz * t_s + phase_rad);
  }
};

/// A push: half a sine of torque.
///
/// @snippet simulation_examples.cpp scenario
/// How to: @ref rig.
struct Push {
  double at_s;        ///< Begins.
  double duration_s;  ///< Above 0.
  double peak_Nm;     ///< Either sign.

  /// Torque at a time. @return N m
  double at(double t_s) const noexcept {
    const double share = (t_s - at_s) / duration_s;
    return share > 0.0 && share < 1.0 ? peak_Nm * std::sin(M_PI * share) : 0.0;
  }
};

/// What happens to one axis.
///
/// @snippet simulation_examples.cpp scenario
/// How to: @ref rig.
struct AxisScenario {
  double target_deg = 0.0;   ///< Angle to be held, in space.
  std::vector<Wave> base;    ///< Motion of what the axis is fixed to, degrees.
  std::vector<Wave> wind;    ///< Torque on the camera, N m.
  std::vector<Push> pushes;  ///< Impacts.
  double winding_C = NAN;    ///< To start from; NaN: as warm as the air.
  double body_C = NAN;       ///< To start from; NaN: as warm as the air.

  /// Angle of the base. @return degrees
  double base_deg(double t_s) const noexcept {
    double sum = 0.0;
    for (const Wave& wave : base) sum += wave.at(t_s);
    return sum;
  }
  /// Torque from outside. @return N m
  double torque_Nm(double t_s) const noexcept {
    double sum = 0.0;
    for (const Wave& wave : wind) sum += wave.at(t_s);
    for (const Push& push : pushes) sum += push.at(t_s);
    return sum;
  }
};

/// A whole run. Nothing in it is random: a scenario with wind is made from a seed by `scenarios.hpp` and is
/// then fixed.
struct Scenario {
  std::string name;                  ///< One word or two.
  double duration_s = 60.0;          ///< Length.
  double settle_s = 5.0;             ///< Nothing is counted before this.
  double air_C = 26.0;               ///< Air and surroundings.
  double airspeed_mps = 0.0;         ///< Over the motors.
  Battery<double>::Config supply;    ///< Battery or bench supply.
  double charge = 1.0;               ///< Of the battery at the start, 0 .. 1.
  std::array<AxisScenario, 3> axes;  ///< Roll, pitch, yaw.
};

}  // namespace thermopower::simulation
