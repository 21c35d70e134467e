// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/simulation/thesis_gimbal.hpp>

#include <cmath>

#include "../catch.hpp"

using namespace thermopower::simulation;

namespace {

using Axis = GimbalAxis<double>;

const BaseMotion<double> still = {0.0, 0.0, 0.0};

Axis::Config without_friction() {
  Axis::Config config = thesis_roll<double>().mechanics;
  config.friction = {0.0, 0.0, 1.0, 0.01, 0.0};
  return config;
}

// Half a second of a roll axis that is pushed while its base sways, in steps of `dt_s`.
Axis::State pushed(double dt_s) {
  Axis axis(thesis_roll<double>().mechanics, {0.1, 0.0});
  const long steps = std::lround(0.48 / dt_s), per_input = std::lround(0.008 / dt_s);
  Axis::Inputs inputs{0.0, 0.0, still};
  for (long i = 0; i < steps; ++i) {
    if (i % per_input == 0) {
      const double t_s = static_cast<double>(i) * dt_s;
      inputs.motor_Nm = 0.006 * std::cos(9.0 * t_s);
      inputs.disturbance_Nm = 0.003 * std::sin(31.0 * t_s);
      inputs.base = {0.2 * std::sin(3.0 * t_s), 0.6 * std::cos(3.0 * t_s), -1.8 * std::sin(3.0 * t_s)};
    } else {
      inputs.base = {inputs.base.angle_rad +
                         dt_s * (inputs.base.rate_rad_per_s + 0.5 * dt_s * inputs.base.accel_rad_per_s2),
                     inputs.base.rate_rad_per_s + dt_s * inputs.base.accel_rad_per_s2,
                     inputs.base.accel_rad_per_s2};
    }
    axis.step(inputs, dt_s);
  }
  return axis.state();
}

}  // namespace

TEST_CASE(
    "Halving the step shrinks the error by sixteen: the integrator is of fourth order on the whole model") {
  const Axis::State exact = pushed(0.008 / 1024);
  double previous = 0.0;
  for (const double parts : {8.0, 16.0, 32.0, 64.0}) {
    const double error = std::fabs(pushed(0.008 / parts).angle_rad - exact.angle_rad);
    if (previous > 0.0) {
      INFO("step " << 0.008 / parts << " s, error " << error << " rad");
      CHECK(previous / error > 11.0);
      CHECK(previous / error < 23.0);
    }
    previous = error;
  }
}

TEST_CASE("At the board's cycle the mechanics are right to a ten-thousandth of a telemetry count") {
  const double count_rad = 2.0 * M_PI / 16384.0;
  CHECK(std::fabs(pushed(0.0008).angle_rad - pushed(0.008 / 1024).angle_rad) < 1e-4 * count_rad);
}

TEST_CASE("Without friction the axis keeps its energy") {
  const Axis::Config config = without_friction();
  Axis axis(config, {0.4, 0.0});
  const auto energy = [&] {
    const double angle = axis.state().angle_rad, rate = axis.state().rate_rad_per_s;
    return 0.5 * config.inertia_kg_m2 * rate * rate -
           config.imbalance_Nm * std::cos(angle - config.hanging_rad) +
           0.5 * config.cable_Nm_per_rad * (angle - config.cable_rest_rad) * (angle - config.cable_rest_rad) -
           config.cogging_Nm / config.cogging_per_turn * std::cos(config.cogging_per_turn * angle);
  };
  const double before = energy();
  double swing = 0.0;
  for (int i = 0; i < 12500; ++i) {
    axis.step({0.0, 0.0, still}, 0.0008);
    swing = std::fmax(swing,
                      0.5 * config.inertia_kg_m2 * axis.state().rate_rad_per_s * axis.state().rate_rad_per_s);
  }
  CHECK(swing > 1e-3);
  CHECK(std::fabs(energy() - before) < 1e-5 * swing);
}

TEST_CASE("Left alone, the axis comes to rest where weight, cable and cogging balance") {
  const Axis::Config config = thesis_roll<double>().mechanics;
  Axis axis(config, {0.4, 0.0});
  for (int i = 0; i < 400000; ++i) axis.step({0.0, 0.0, still}, 0.0008);
  CHECK(std::fabs(axis.state().rate_rad_per_s) < 1e-9);
  CHECK(std::fabs(axis.acceleration(axis.state().angle_rad, 0.0, {0.0, 0.0, still}, 0.0)) < 1e-4);
}

TEST_CASE("A moving base drags the camera through friction, cable and cogging only") {
  Axis::Config config = without_friction();
  config.cable_Nm_per_rad = config.cogging_Nm = config.imbalance_Nm = 0.0;
  Axis isolated(config, {0.0, 0.0});
  isolated.step({0.0, 0.0, {0.5, 3.0, 10.0}}, 0.01);
  CHECK(isolated.state().angle_rad == 0.0);
  config.friction.viscous_Nm_s_per_rad = 0.01;
  Axis dragged(config, {0.0, 0.0});
  dragged.step({0.0, 0.0, {0.5, 3.0, 10.0}}, 0.01);
  CHECK(dragged.state().rate_rad_per_s > 0.0);
}

TEST_CASE("Friction opposes the motion, peaks near the Stribeck speed and settles at Coulomb plus viscous") {
  const JointFriction<double> friction = {0.0012, 0.0018, 0.15, 0.02, 2e-4};
  CHECK(friction.torque_Nm(0.0) == 0.0);
  for (const double speed : {0.001, 0.03, 0.5, 20.0})
    CHECK(friction.torque_Nm(-speed) == -friction.torque_Nm(speed));
  CHECK(friction.torque_Nm(0.06) > 1.2 * 0.0012);
  CHECK(friction.torque_Nm(0.06) < 0.0018);
  CHECK(friction.torque_Nm(20.0) == Approx(0.0012 + 2e-4 * 20.0).epsilon(1e-3));
}
