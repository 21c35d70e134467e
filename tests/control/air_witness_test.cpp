// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Thermometers of the air that drift together, or stick together, while an actuator with a thermometer of its own works in the true air.
// The actuator is integrated here, with constants other than its model's.

#include <thermopower/control/air_temperature.hpp>

#include "../catch.hpp"

#include <algorithm>
#include <cmath>
#include <random>

using namespace thermopower;

namespace {

/// A motor of one mass: C dT/dt = P - G (T - air).
struct Mass {
  double J_per_K, W_per_K, T_C;
  void pass(double heat_W, double air_C, double seconds) {
    T_C += seconds * (heat_W - W_per_K * (T_C - air_C)) / J_per_K;
  }
};

struct Outcome {
  double most_below_K = -1e9;  ///< The true air above the air that is believed.
  double most_model_K = 0.0;   ///< The true motor from its model, were that in the true air.
  double witnessed_s = 0.0;    ///< How long readings counted.
  double named_s = -1.0;       ///< When the witness disagreed first.
  double coldest_air_C = 1e9;  ///< That was believed.
};

/// Three hours. @param air, camera, frame  functions of time, degC
template <class Air, class Camera, class Frame>
Outcome watch(const AirWitness::Config& config, double gain_error, Air air, Camera camera, Frame frame,
              std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> power(0.0, 2.0);
  AirTemperature room(AirTemperature::Config::declared(45.0f));
  AirWitness witness(config);
  REQUIRE(witness.validate() == ConfigError::none);
  Mass truth = {18.0 * (1.0 + gain_error), 0.05 / (1.0 + gain_error), air(0.0)},
       model = {18.0, 0.05, air(0.0)}, ideal = model;
  Outcome outcome;
  double heat_W = 0.0, until_s = 0.0;
  for (double now_s = 0.0; now_s < 10800.0; now_s += 0.5) {
    if (now_s >= until_s) heat_W = power(random), until_s = now_s + 300.0 * power(random);
    const auto camera_C = static_cast<float>(camera(now_s)), frame_C = static_cast<float>(frame(now_s));
    const double read_C =
        std::isfinite(room.state().read_C) ? static_cast<double>(room.state().read_C) : air(0.0);
    truth.pass(heat_W, air(now_s), 0.5);
    model.pass(heat_W, read_C, 0.5);
    ideal.pass(heat_W, air(now_s), 0.5);
    outcome.most_model_K = std::max(outcome.most_model_K, std::fabs(truth.T_C - ideal.T_C));
    witness.step(GuardedCelsius::unchecked(static_cast<float>(truth.T_C)), static_cast<float>(model.T_C),
                 0.5f);
    const AirTemperature::State& state = room.step(camera_C, frame_C, witness, 0.5f);
    outcome.most_below_K = std::max(outcome.most_below_K, air(now_s) - static_cast<double>(state.air_C));
    outcome.coldest_air_C = std::min(outcome.coldest_air_C, static_cast<double>(state.air_C));
    outcome.witnessed_s += state.is_witnessed ? 0.5 : 0.0;
    if (outcome.named_s < 0.0 && witness.state().reason == LimitReason::sensor_disagrees)
      outcome.named_s = now_s;
  }
  return outcome;
}

double steady(double) { return 25.0; }

}  // namespace

TEST_CASE("a motor that is as warm as its model says lets readings count, from five time constants on") {
  const AirWitness::Config config = AirWitness::Config::standard();
  const Outcome outcome = watch(
      config, 0.0, steady, steady, [](double) { return 25.5; }, 1);
  CHECK(outcome.witnessed_s == Approx(10800.0 - 1800.0).margin(1.0));
  CHECK(outcome.coldest_air_C == Approx(25.5 + 2.0 * 3.0 + 6.0));  // the warmer one, and the margin
  CHECK(outcome.named_s < 0.0);
}

TEST_CASE("without a motor's thermometer, or with one that is refused, the declared air counts") {
  AirTemperature room(AirTemperature::Config::declared(40.0f));
  AirWitness witness;
  for (int i = 0; i < 4000; ++i) {
    witness.step(GuardedCelsius(LimitReason::sensor_stuck), 25.0f, 1.0f);
    CHECK(room.step(25.0f, 25.0f, witness, 1.0f).air_C == 40.0f);
  }
  CHECK(witness.state().reason == LimitReason::sensor_stuck);
  CHECK_FALSE(room.state().is_witnessed);
  for (int i = 0; i < 1800; ++i) witness.step(GuardedCelsius::unchecked(25.0f), 25.0f, 1.0f);
  CHECK(room.step(25.0f, 25.0f, witness, 1.0f).is_witnessed);
  // One thermometer alone is not enough, nor are two that disagree.
  CHECK(room.step(25.0f, static_cast<float>(NAN), witness, 1.0f).air_C == 40.0f);
  CHECK(room.step(5.0f, 25.0f, witness, 1.0f).air_C == 40.0f);
  CHECK(room.step(44.0f, 25.0f, witness, 1.0f).air_C == 44.0f);  // warmer than was declared is believed
  // What is no time, or no model, is no witness.
  CHECK_FALSE((witness.step(GuardedCelsius::unchecked(25.0f), 25.0f, -1.0f), witness.is_vouching()));
  CHECK(witness.state().reason == LimitReason::time_invalid);
  witness.step(GuardedCelsius::unchecked(25.0f), static_cast<float>(NAN), 1.0f);
  CHECK(witness.state().reason == LimitReason::sensor_disagrees);
}

TEST_CASE("two thermometers that drift or stick together never make the air too cold, and are named") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(0.0, 1.0);
  const AirWitness::Config config = AirWitness::Config::standard();
  int counted = 0, drawn = 0;
  for (std::uint32_t seed = 1; seed <= 120; ++seed) {
    const double gain_error = 0.06 * (any(random) - 0.5), from_s = 7000.0 * any(random);
    const double per_s = (0.2 + 0.8 * any(random)) / 60.0, apart_K = 3.0 * any(random);
    const auto since = [=](double now_s) { return std::max(0.0, now_s - from_s); };
    const auto drifting = [=](double now_s) { return std::max(-30.0, 25.0 - per_s * since(now_s)); };
    const auto warming = [=](double now_s) { return std::min(45.0, 25.0 + per_s * since(now_s)); };
    const bool is_drift = seed % 2 == 0;
    const Outcome outcome =
        is_drift
            ? watch(
                  config, gain_error, steady, drifting, [=](double t) { return drifting(t) + apart_K; }, seed)
            : watch(
                  config, gain_error, warming, steady, [=](double t) { return steady(t) + apart_K; }, seed);
    ++drawn;
    INFO("seed " << seed << ", constants off by " << gain_error);
    // The claim is about models that are as good as declared.
    if (outcome.most_model_K > static_cast<double>(config.model_K)) continue;
    ++counted;
    CHECK(outcome.most_below_K <= 0.0);
    CHECK(outcome.named_s >= 0.0);
    // Named before the air is further off than the margin.
    CHECK(outcome.named_s <= from_s + 12.0 / per_s);
  }
  CHECK(counted > drawn / 2);
}

TEST_CASE("thermometers that are wrong from the start are never believed") {
  for (const double wrong_K : {-25.0, -15.0, -8.0}) {
    const auto low = [=](double) { return 30.0 + wrong_K; };
    const Outcome outcome = watch(
        AirWitness::Config::standard(), 0.0, [](double) { return 30.0; }, low, low, 3);
    CHECK(outcome.witnessed_s == 0.0);
    CHECK(outcome.named_s >= 0.0);
  }
}

TEST_CASE("a wrong constant of the witness is refused by name, and vouches for nothing") {
  AirWitness::Config config = AirWitness::Config::standard();
  CHECK(config.validate() == ConfigError::none);
  for (const float bad : {0.0f, -1.0f, static_cast<float>(NAN)}) {
    config = AirWitness::Config::standard();
    config.model_K = bad;
    CHECK(config.validate() == ConfigError::maximum_difference_K);
    config = AirWitness::Config::standard();
    config.delay_s = bad;
    CHECK(config.validate() == ConfigError::timeout_s);
  }
  config = AirWitness::Config::standard();
  config.drift_K_per_s = -1.0f;
  CHECK(config.validate() == ConfigError::rate_per_s);
  AirWitness witness(config);
  for (int i = 0; i < 4000; ++i) witness.step(GuardedCelsius::unchecked(25.0f), 25.0f, 1.0f);
  CHECK_FALSE(witness.is_vouching());
  CHECK(witness.state().reason == LimitReason::config_invalid);
}
