// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Forecasts against the motors themselves: stepped by Euler until it happens. They share no code with the library.

#include "../catch.hpp"

#include <cmath>
#include <random>

#include <thermopower/actuator/two_node_forecast.hpp>

namespace {

using thermopower::TwoNodeForecast;

struct Motor {
  double winding_J_per_K, body_J_per_K, coupling_W_per_K, air_W_per_K, winding_C, body_C, air_C;

  void pass(double heat_W, double seconds) {
    const double across_W = coupling_W_per_K * (winding_C - body_C);
    winding_C += seconds * (heat_W - across_W) / winding_J_per_K;
    body_C += seconds * (across_W - air_W_per_K * (body_C - air_C)) / body_J_per_K;
  }
  double step_s() const { return 1e-3 * winding_J_per_K / coupling_W_per_K; }
  double longest_s() const { return 30.0 * (winding_J_per_K + body_J_per_K) / air_W_per_K; }
  TwoNodeForecast::Config config() const {
    return {static_cast<float>(winding_J_per_K),
            static_cast<float>(body_J_per_K),
            static_cast<float>(coupling_W_per_K),
            {static_cast<float>(air_W_per_K)}};
  }
  TwoNodeForecast::State state() const {
    return {static_cast<float>(winding_C), static_cast<float>(body_C), static_cast<float>(air_C)};
  }
};

Motor drawn(std::mt19937& random) {
  const auto between = [&](double low, double high) {
    return low * std::pow(high / low, std::uniform_real_distribution<double>(0.0, 1.0)(random));
  };
  std::uniform_real_distribution<double> celsius(20.0, 100.0);
  const double air_C = std::uniform_real_distribution<double>(-10.0, 35.0)(random);
  Motor motor = {between(3, 30), 0, between(0.3, 3), 0, celsius(random), celsius(random), air_C};
  motor.body_J_per_K = motor.winding_J_per_K * between(2, 20);
  motor.air_W_per_K = motor.coupling_W_per_K * between(0.05, 0.5);
  return motor;
}

/// First time at which a limit is reached; infinite where it is not.
double seconds_to(Motor motor, double heat_W, double winding_C, double body_C, double within_s) {
  const double step_s = motor.step_s();
  for (double now_s = 0.0; now_s < within_s; now_s += step_s) {
    if (motor.winding_C >= winding_C || motor.body_C >= body_C) return now_s;
    motor.pass(heat_W, step_s);
  }
  return INFINITY;
}

}  // namespace

TEST_CASE("the time to the first limit is that of the motor, whatever it stands at and whatever heats it") {
  std::mt19937 random(31);
  int never = 0, at_once = 0, later = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const Motor motor = drawn(random);
    const double heat_W = motor.air_W_per_K * std::uniform_real_distribution<double>(0.0, 150.0)(random);
    const double winding_C = 110.0, body_C = 95.0;
    const double expected_s = seconds_to(motor, heat_W, winding_C, body_C, motor.longest_s());
    const TwoNodeForecast forecast(motor.config(), motor.state(), static_cast<float>(heat_W));
    const auto given_s =
        static_cast<double>(forecast.seconds_to({static_cast<float>(winding_C), static_cast<float>(body_C)}));
    INFO(trial << ": " << given_s << " s for " << expected_s << " s");
    if (std::isinf(expected_s) || std::isinf(given_s)) {
      // Whoever settles within a tenth of a kelvin of a limit may reach it or not.
      const double settled_C = motor.air_C + heat_W / motor.air_W_per_K;
      const double winding_settled_C = settled_C + heat_W / motor.coupling_W_per_K;
      if (std::fabs(settled_C - body_C) > 0.1 && std::fabs(winding_settled_C - winding_C) > 0.1)
        REQUIRE(std::isinf(expected_s) == std::isinf(given_s));
      ++never;
      continue;
    }
    (expected_s == 0.0 ? at_once : later) += 1;
    REQUIRE(given_s == Approx(expected_s).epsilon(0.01).margin(0.05));
  }
  CHECK(never > 50);
  CHECK(at_once > 20);
  CHECK(later > 50);
}

TEST_CASE("full power is back when it can act for the horizon, and not before") {
  std::mt19937 random(37);
  int later = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const Motor motor = drawn(random);
    const double rest_W = 0.0, horizon_s = 20.0, winding_C = 110.0, body_C = 95.0;
    const double full_W = motor.air_W_per_K * std::uniform_real_distribution<double>(40.0, 200.0)(random);
    const TwoNodeForecast forecast(motor.config(), motor.state(), static_cast<float>(rest_W));
    const TwoNodeForecast::Limits limits = {static_cast<float>(winding_C), static_cast<float>(body_C)};
    const float given_s =
        forecast.seconds_until(motor.config(), static_cast<float>(motor.air_C), static_cast<float>(full_W),
                               static_cast<float>(horizon_s), limits);
    if (std::isinf(given_s)) continue;
    const auto bears = [&](double after_s) {
      Motor then = motor;
      for (double now_s = 0.0; now_s < after_s; now_s += then.step_s()) then.pass(rest_W, then.step_s());
      return seconds_to(then, full_W, winding_C, body_C, horizon_s + 1.0) >= horizon_s;
    };
    INFO(trial << ": " << given_s << " s");
    CHECK(bears(1.02 * static_cast<double>(given_s) + 0.2));
    if (given_s > 2.0f) {
      CHECK_FALSE(bears(0.98 * static_cast<double>(given_s) - 0.2));
      ++later;
    }
  }
  CHECK(later > 30);
}

TEST_CASE("a forecast from what is not known says so, and one that never ends ends") {
  const TwoNodeForecast::Config config = {8.0f, 80.0f, 1.0f, {0.2f}};
  const float nan = thermopower::detail::not_a_number();
  CHECK(std::isnan(TwoNodeForecast(config, {nan, 50.0f, 25.0f}, 5.0f).seconds_to({110.0f, 60.0f})));
  CHECK(std::isnan(TwoNodeForecast(config, {50.0f, 50.0f, 25.0f}, nan).seconds_to({110.0f, 60.0f})));
  const TwoNodeForecast resting(config, {25.0f, 25.0f, 25.0f}, 0.0f);
  CHECK(std::isinf(resting.seconds_to({110.0f, 60.0f})));
  CHECK(resting.seconds_until(config, 25.0f, 5.0f, 30.0f, {110.0f, 60.0f}) == 0.0f);
  // In air that is too hot for any power.
  const TwoNodeForecast hot(config, {70.0f, 70.0f, 65.0f}, 0.0f);
  CHECK(std::isinf(hot.seconds_until(config, 65.0f, 5.0f, 30.0f, {110.0f, 60.0f})));
}
