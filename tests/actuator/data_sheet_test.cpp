// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Motors of two nodes that this test heats on a bench of its own, as a maker of motors does; the sheet says what the bench
// found. The truth must lie within the bounds, whichever numbers of the sheet are left out.

#include <thermopower/actuator/data_sheet.hpp>

#include "../catch.hpp"

#include <cmath>
#include <random>

using namespace thermopower;

namespace {

struct Motor {
  double ohm, torque_constant, winding_J_per_K, body_J_per_K, coupling_W_per_K, loss_W_per_K;

  double ohm_at(double winding_C) const { return ohm * (1.0 + 0.00393 * (winding_C - 25.0)); }

  /// The current that holds the winding at 125 degC in air of 25, by bisection of what it settles at.
  double continuous_A() const {
    double low = 0.0, high = 100.0;
    for (int i = 0; i < 60; ++i) {
      const double current_A = 0.5 * (low + high), heat_W = current_A * current_A * ohm_at(125.0);
      (25.0 + heat_W / coupling_W_per_K + heat_W / loss_W_per_K < 125.0 ? low : high) = current_A;
    }
    return low;
  }
  /// Until the housing has risen by 63 % of what it will, at constant heat.
  double motor_s() const {
    double winding_K = 0.0, body_K = 0.0, now_s = 0.0;
    const double dt_s = 0.02 * winding_J_per_K / coupling_W_per_K;
    for (; body_K < (1.0 - std::exp(-1.0)) / loss_W_per_K; now_s += dt_s) {  // of 1 W
      const double across_W = coupling_W_per_K * (winding_K - body_K);
      winding_K += dt_s * (1.0 - across_W) / winding_J_per_K;
      body_K += dt_s * (across_W - loss_W_per_K * body_K) / body_J_per_K;
    }
    return now_s;
  }
};

bool is_within(double truth, const ConstantRange& range) {
  return truth >= range.lowest && truth <= range.highest && range.lowest < range.nominal &&
         range.nominal < range.highest;
}

Motor drawn_motor(std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto between = [&](double low, double high) {
    return low * std::pow(high / low, static_cast<double>(random() >> 5) / 134217728.0);
  };
  Motor motor = {between(0.2, 20.0), between(0.005, 0.1), 0.0, 0.0, 0.0, between(0.05, 1.0)};
  motor.coupling_W_per_K =
      motor.loss_W_per_K * between(1.2, 8.0);  // winding to housing: 0.11 to 0.45 of the whole
  motor.body_J_per_K = motor.loss_W_per_K * between(300.0, 1500.0);
  motor.winding_J_per_K = motor.body_J_per_K * between(0.05, 0.2);
  return motor;
}

MotorDataSheet whole_sheet(const Motor& motor) {
  return {motor.ohm,
          motor.torque_constant,
          24.0 / motor.ohm * motor.torque_constant,
          24.0,
          motor.continuous_A(),
          125.0,
          1.0 / motor.coupling_W_per_K,
          1.0 / motor.loss_W_per_K,
          motor.winding_J_per_K / motor.coupling_W_per_K,
          motor.motor_s()};
}

}  // namespace

TEST_CASE("the truth lies within the bounds, whichever three groups of numbers the sheet has") {
  for (std::uint32_t seed = 1; seed <= 300; ++seed) {
    const Motor motor = drawn_motor(seed);
    for (int left_out = 0; left_out < 8; ++left_out) {
      MotorDataSheet sheet = whole_sheet(motor);
      if ((left_out & 1) != 0) sheet.resistance_ohm = 0.0;  // from the stall torque
      if ((left_out & 2) != 0) sheet.winding_K_per_W = sheet.housing_K_per_W = 0.0;
      if ((left_out & 4) != 0) sheet.winding_s = 0.0;
      CAPTURE(seed, left_out);
      REQUIRE(sheet.is_enough());
      CHECK(is_within(motor.ohm, sheet.resistance()));
      CHECK(is_within(motor.coupling_W_per_K, sheet.coupling()));
      CHECK(is_within(motor.loss_W_per_K, sheet.conductance()));
      CHECK(is_within(motor.winding_J_per_K, sheet.winding_heat_capacity()));
      CHECK(is_within(motor.body_J_per_K, sheet.body_heat_capacity()));
      // Safe means safe: the true winding stays below its limit at that current, for ever.
      const double heat_W = sheet.safe_square_A2(40.0) * motor.ohm_at(125.0);
      CHECK(40.0 + heat_W / motor.coupling_W_per_K + heat_W / motor.loss_W_per_K < 125.0);
    }
  }
}

TEST_CASE("a sheet that says too little is not enough, and one that contradicts itself says by how much") {
  const MotorDataSheet whole = whole_sheet(drawn_motor(7));
  CHECK(std::fabs(whole.disagreement()) < 1e-6);
  MotorDataSheet boasting = whole;
  boasting.continuous_A *= 1.3;  // rated on a heat sink
  CHECK(boasting.disagreement() == Approx(1.0 / 1.69 - 1.0).epsilon(1e-6));
  for (int missing = 0; missing < 3; ++missing) {
    MotorDataSheet sheet = {whole.resistance_ohm, 0, 0, 0, whole.continuous_A, 0, 0, 0, 0, whole.motor_s};
    CHECK(sheet.is_enough());
    if (missing == 0) sheet.resistance_ohm = 0.0;
    if (missing == 1) sheet.continuous_A = 0.0;
    if (missing == 2) sheet.motor_s = 0.0;
    CHECK_FALSE(sheet.is_enough());
  }
}
