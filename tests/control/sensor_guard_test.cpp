// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Thermometers that lie, and the guard between them and the limiters. The joint that they sit on is integrated here.

#include "../catch.hpp"
#include "limiter_inputs.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <thermopower/thermopower.hpp>
#include <vector>

using namespace thermopower;

namespace {

const float nan_C = std::numeric_limits<float>::quiet_NaN(),
            infinite_C = std::numeric_limits<float>::infinity();

/// A guard that has believed a reading.
SensorGuard guard_at(float reading_C, float expected_C) {
  SensorGuard guard;
  REQUIRE(guard.step({reading_C, expected_C}, 0.1f) == reading_C);
  return guard;
}
/// The reason for what is read from now on, as soon as it is no longer bridged.
LimitReason reason_of(SensorGuard guard, float reading_C, float expected_C) {
  GuardedCelsius said;
  for (int i = 0; i < 100; ++i) said = guard.step({reading_C, expected_C}, 0.1f);
  CHECK(std::isnan(said) == (said.reason() != LimitReason::none));
  return said.reason();
}

}  // namespace

TEST_CASE("readings that a place cannot have are refused, and the reason says which") {
  const SensorGuard warm = guard_at(40.0f, 41.0f);
  for (const float torn_C :
       {-88.6f, -40.0f, -127.0f, -273.2f, -300.0f, 238.0f, 300.0f, 1.0e30f, nan_C, infinite_C, -infinite_C}) {
    INFO(torn_C);
    CHECK(reason_of(warm, torn_C, 41.0f) == LimitReason::sensor_out_of_range);
  }
  CHECK(reason_of(warm, 40.0f, 41.0f) == LimitReason::none);
  CHECK(reason_of(warm, 10.0f, 41.0f) == LimitReason::sensor_disagrees);
  CHECK(reason_of(warm, 40.0f, nan_C) == LimitReason::temperature_not_finite);
  // A jump; after it, slower than the place could have followed, the level is one like any other.
  SensorGuard jumped = warm;
  CHECK(jumped.step({60.0f, 60.0f}, 0.1f).reason() == LimitReason::sensor_too_fast);
  for (int i = 0; i < 300; ++i) jumped.step({60.0f, 60.0f}, 0.1f);
  CHECK(jumped.step({60.0f, 60.0f}, 0.1f) == 60.0f);
}

TEST_CASE("a reading that is hotter than the model is believed") {
  SensorGuard guard = guard_at(40.0f, 40.0f);
  for (float hot_C = 40.0f; hot_C < 140.0f; hot_C += 0.4f) {
    const GuardedCelsius said = guard.step({hot_C, 40.0f}, 0.1f);
    REQUIRE(said == hot_C);
  }
}

TEST_CASE("a short disturbance is bridged by the last good reading and what the model has warmed since") {
  SensorGuard guard = guard_at(40.0f, 41.0f);
  const GuardedCelsius bridged = guard.step({-88.6f, 42.5f}, 0.5f);
  CHECK(bridged == 41.5f);
  CHECK(guard.state().reason == LimitReason::sensor_out_of_range);
  CHECK(guard.step({-88.6f, 30.0f}, 0.5f) == 40.0f);  // not colder than it was
  // A limiter goes on with it.
  SafetyLimiter<> limiter;
  CHECK(limiter.step({200, bridged, 0.0f}, 0.1f).power == 200);
  // But nothing of it is a measurement.
  CHECK(std::isnan(guard.upper(2.0f)));
  CHECK_FALSE(guard.measured(1.0f, 1.0f).is_valid);
  CHECK(guard.step({40.0f, 42.5f}, 0.1f) == 40.0f);
  CHECK(guard.upper(2.0f) == 42.0f);
  CHECK(guard.measured(1.0f, 0.5f).is_valid);
  CHECK(guard.measured(1.0f, 0.5f).value_C == 40.0f);
  CHECK(guard.measured(1.0f, 0.5f).std_K == 1.0f);
  CHECK(guard.measured(1.0f, 0.5f).standing_std_K == 0.5f);
}

TEST_CASE("what is bridged for longer is a fault, and good readings have to make up for it") {
  SensorGuard guard = guard_at(40.0f, 40.0f);
  int bridged = 0;
  while (!std::isnan(guard.step({nan_C, 40.0f}, 0.1f))) ++bridged;
  CHECK(bridged == Approx(20).margin(1));  // two seconds
  for (int i = 0; i < 1000; ++i) guard.step({nan_C, 40.0f}, 0.1f);
  int waited = 0;
  while (std::isnan(guard.step({40.0f + 0.001f * static_cast<float>(waited), 40.0f}, 0.1f))) ++waited;
  CHECK(waited > 60);  // four seconds of bad readings are remembered: four times as long
  CHECK(waited < 200);
}

TEST_CASE("single spikes cost nothing, spikes in more than a fifth of the time are a fault") {
  for (const int period : {50, 8, 3}) {
    SensorGuard guard = guard_at(40.0f, 40.0f);
    int refused = 0;
    for (int i = 0; i < 6000; ++i) {
      const float reading_C = i % period == period - 1 ? 177.1f : 40.0f + 0.1f * static_cast<float>(i % 3);
      refused += std::isnan(guard.step({reading_C, 40.0f}, 0.1f)) ? 1 : 0;
    }
    INFO("every " << period << "th");
    CHECK((refused > 0) == (period < 5));
  }
}

TEST_CASE("a reading that stands still while heat flows is stuck until it moves") {
  SensorGuard guard = guard_at(25.0f, 25.0f);
  LimitReason reason = LimitReason::none;
  float expected_C = 25.0f;
  for (; expected_C < 60.0f && reason == LimitReason::none; expected_C += 0.05f)
    reason = guard.step({25.0f, expected_C}, 0.1f).reason();
  CHECK(reason == LimitReason::sensor_stuck);
  CHECK(expected_C < 25.0f + 5.2f);
  // Where the model cools back to it, it is stuck all the same.
  for (int i = 0; i < 200; ++i) guard.step({25.0f, 25.0f}, 0.1f);
  CHECK(std::isnan(guard.step({25.0f, 25.0f}, 0.1f)));
  for (int i = 0; i < 300; ++i) guard.step({25.0f + 0.01f * static_cast<float>(i), 26.0f}, 0.1f);
  CHECK(guard.state().reason == LimitReason::none);
  // And nothing is stuck where nothing flows.
  SensorGuard calm = guard_at(25.0f, 25.0f);
  for (int i = 0; i < 100000; ++i) REQUIRE(calm.step({25.0f, 25.0f}, 0.1f) == 25.0f);
}

TEST_CASE("two sensors that read each other's place are exchanged, and two that do not are not") {
  SensorGuard::Config wide = SensorGuard::Config::standard();
  wide.disagreement_K = 200.0f;  // so that nothing else finds it
  SensorGuard winding(wide), housing(wide);
  GuardedCelsius said_winding, said_housing;
  float hot_C = 25.0f;
  for (int i = 0; i < 600; ++i) {
    hot_C += 0.05f;  // the model's winding; its housing stays at 25
    said_winding = winding.step({25.1f + 0.001f * static_cast<float>(i), hot_C}, {hot_C, 25.0f}, 0.1f);
    said_housing = housing.step({hot_C, 25.0f}, {25.1f, hot_C}, 0.1f);
  }
  CHECK(std::isnan(said_winding));
  CHECK(std::isnan(said_housing));
  CHECK(said_housing.reason() == LimitReason::sensors_exchanged);
  SensorGuard right(wide);
  for (int i = 0; i < 600; ++i) {
    const float warm_C = 25.0f + 0.05f * static_cast<float>(i);
    REQUIRE_FALSE(std::isnan(right.step({warm_C - 3.0f, warm_C}, {26.0f, 25.0f}, 0.1f)));
  }
}

TEST_CASE("a guard without a clock, or with a configuration that cannot be, believes nothing") {
  for (const float dt_s : {nan_C, -0.1f, infinite_C}) {
    SensorGuard guard = guard_at(40.0f, 40.0f);
    CHECK(guard.step({40.0f, 40.0f}, dt_s).reason() == LimitReason::time_invalid);
    CHECK(std::isnan(guard.upper(1.0f)));
  }
  SensorGuard standing = guard_at(40.0f, 40.0f);
  LimitReason reason = LimitReason::none;
  for (int i = 0; i < 25; ++i) reason = standing.step({40.0f, 40.0f}, 0.0f).reason();
  CHECK(reason == LimitReason::time_stands_still);
  // Believed again once half as much time was told as not.
  for (int i = 0; i < 9; ++i) CHECK_FALSE(standing.step({40.0f, 40.0f}, 0.1f) == 40.0f);
  standing.step({40.0f, 40.0f}, 0.1f);
  CHECK(standing.step({40.0f, 40.0f}, 0.1f) == 40.0f);

  const auto with = [](auto change) {
    SensorGuard::Config config = SensorGuard::Config::standard();
    change(config);
    SensorGuard guard(config);
    if (is_error(config.validate()))
      CHECK(guard.step({30.0f, 30.0f}, 0.1f).reason() == LimitReason::config_invalid);
    return config.validate();
  };
  CHECK(with([](auto&) {}) == ConfigError::none);
  CHECK(with([](auto& c) { c.lowest_C = nan_C; }) == ConfigError::minimum_plausible_C);
  CHECK(with([](auto& c) { c.lowest_C = -280.0f; }) == ConfigError::minimum_plausible_C);
  CHECK(with([](auto& c) { c.highest_C = c.lowest_C; }) == ConfigError::maximum_plausible_C);
  CHECK(with([](auto& c) { c.rate_K_per_s = 0.0f; }) == ConfigError::rate_per_s);
  CHECK(with([](auto& c) { c.still_K = -0.1f; }) == ConfigError::change_K);
  CHECK(with([](auto& c) { c.stuck_K = c.still_K; }) == ConfigError::stuck_K);
  CHECK(with([](auto& c) { c.disagreement_K = 0.0f; }) == ConfigError::maximum_difference_K);
  CHECK(with([](auto& c) { c.hold_s = nan_C; }) == ConfigError::timeout_s);
}

TEST_CASE("what a guard refuses, every limiter answers with the least power and the guard's reason") {
  SensorGuard guard;
  const GuardedCelsius torn_C = guard.step({-88.6f, 30.0f}, 0.1f);
  SafetyLimiter<> safety;
  CHECK(safety.step({255, torn_C, 0.0f}, 0.1f).power == least_power());
  CHECK(safety.step({255, torn_C, 0.0f}, 0.1f).reason == LimitReason::sensor_out_of_range);
  NodeLimiter nodes;
  const GuardedCelsius good_C = told::degrees(30.0f);
  for (const NodeLimiter::Inputs& inputs :
       {NodeLimiter::Inputs{255, torn_C, good_C, 25.0f}, NodeLimiter::Inputs{255, good_C, torn_C, 25.0f}}) {
    CHECK(nodes.step(inputs, 0.1f).power == least_power());
    CHECK(nodes.step(inputs, 0.1f).reason == LimitReason::sensor_out_of_range);
  }
  // A place at a known distance of it is not known either, for the same reason.
  CHECK(torn_C.warmer_by(20.0f).fault() == LimitReason::sensor_out_of_range);
  CHECK(GuardedCelsius().fault() == LimitReason::temperature_not_finite);
  CHECK(good_C.fault() == LimitReason::none);
  const TwoNodeThermalModel<> model({120.0f, 900.0f, 1.9f, {0.8f}}, 30.0f);
  CHECK(GuardedCelsius::hottest_of(model) == 30.0f);
  CHECK(GuardedCelsius::body_of(ThermalModel<>({{18.0f}, {0.05f}}, 31.0f)) == 31.0f);
}

namespace {

// A joint whose constants are up to a tenth off the model's, and a thermistor that begins to lie at some time.
struct Lie {
  const char* name;
  float (*read)(double housing_C, double since_s, std::mt19937& random);
};
const Lie lies[] = {
    {"torn", [](double, double, std::mt19937&) { return -88.6f; }},
    {"not there", [](double, double, std::mt19937&) { return nan_C; }},
    {"shorted", [](double, double, std::mt19937&) { return 300.0f; }},
    {"at room temperature", [](double, double, std::mt19937&) { return 25.0f; }},
    {"at zero", [](double, double, std::mt19937&) { return 0.0f; }},
    {"noise",
     [](double, double, std::mt19937& random) { return static_cast<float>(random() % 400) - 150.0f; }},
    {"a loose contact",
     [](double housing_C, double, std::mt19937& random) {
       return random() % 3 == 0 ? -88.6f : static_cast<float>(housing_C);
     }},
    {"drifts down by 5 K/min", [](double housing_C, double since_s,
                                  std::mt19937&) { return static_cast<float>(housing_C - since_s / 12.0); }},
    {"cools slowly, as if it hung in the air",
     [](double housing_C, double since_s, std::mt19937&) {
       return static_cast<float>(25.0 + (housing_C - 25.0) * std::exp(-since_s / 120.0));
     }},
    {"spikes",
     [](double housing_C, double since_s, std::mt19937&) {
       return static_cast<int>(since_s) % 17 == 0 ? 177.1f : static_cast<float>(housing_C);
     }},
};

struct Outcome {
  double hottest_C = -1e9, model_off_K = 0.0;  ///< The latter: by how much the model was too cold at most.
  int cycles_at_least_power = 0;
  LimitReason last = LimitReason::none;
};

Outcome run_joint(const Lie* lie, bool is_guarded, std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto about = [&](double value) {
    return value * (0.9 + 0.2 * static_cast<double>(random() % 1001) / 1000.0);
  };
  const double winding_J = about(120.0), housing_J = about(900.0), across = about(1.9), to_air = about(0.8);
  const double begins_s = static_cast<double>(random() % 900);
  double winding_C = 25.0, housing_C = 25.0, share = 1.0 / 255.0;
  TwoNodeThermalModel<> model({120.0f, 900.0f, 1.9f, {0.8f}}, 25.0f);
  SensorGuard guard;
  SafetyLimiter<> limiter({110.0f, 20.0f, 60.0f});
  Outcome outcome;
  for (int second = 0; second < 1800; ++second) {
    const double wanted_A = (second / 300) % 2 == 0 ? 22.0 : 9.0, current_A = wanted_A * share;
    const float heat_W = static_cast<float>(current_A * current_A * 0.35) *
                         (1.0f + 0.00393f * (model.state().winding_C - 25.0f));
    for (int part = 0; part < 20; ++part) {
      const double true_W = current_A * current_A * 0.35 * (1.0 + 0.00393 * (winding_C - 25.0));
      const double over_W = across * (winding_C - housing_C);
      winding_C += 0.05 * (true_W - over_W) / winding_J;
      housing_C += 0.05 * (over_W - to_air * (housing_C - 25.0)) / housing_J;
    }
    outcome.hottest_C = std::max(outcome.hottest_C, winding_C);
    model.step({heat_W, 0.0f, {25.0f, 0.0f}}, 1.0f);
    outcome.model_off_K =
        std::max(outcome.model_off_K, winding_C - static_cast<double>(model.state().winding_C));
    const double since_s = second - begins_s;
    const float reading_C = lie != nullptr && since_s >= 0.0 ? lie->read(housing_C, since_s, random)
                                                             : static_cast<float>(housing_C);
    const float rise_K = model.state().winding_C - model.state().body_C;
    const GuardedCelsius housing = is_guarded ? guard.step({reading_C, model.state().body_C}, 1.0f)
                                              : GuardedCelsius::unchecked(reading_C);
    const LimitedPower granted =
        limiter.step({255, housing.warmer_by(rise_K), model.hottest_rate_K_per_s()}, 1.0f);
    outcome.last = granted.reason;
    outcome.cycles_at_least_power += granted.power == least_power() ? 1 : 0;
    share = static_cast<double>(granted.power) / 255.0;
  }
  return outcome;
}

}  // namespace

TEST_CASE(
    "no lie of a thermistor brings a guarded winding over its limit by more than the guard allows and the model is off") {
  const double limit_C = 110.0,
               allowed_K = static_cast<double>(SensorGuard::Config::standard().disagreement_K);
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    const Outcome honest = run_joint(nullptr, true, seed);
    CHECK(is_fault(honest.last) == false);
    CHECK(honest.cycles_at_least_power < 180);  // a guard that trusts nobody would be easy
    for (const Lie& lie : lies) {
      INFO(lie.name << ", seed " << seed);
      const Outcome lied = run_joint(&lie, true, seed);
      CHECK(lied.hottest_C < limit_C + allowed_K + lied.model_off_K);
    }
  }
}

TEST_CASE("without the guard the same lies overheat the winding: the test can fail") {
  double worst_C = 0.0;
  for (const Lie& lie : lies) worst_C = std::max(worst_C, run_joint(&lie, false, 3).hottest_C);
  CHECK(worst_C > 300.0);
}
