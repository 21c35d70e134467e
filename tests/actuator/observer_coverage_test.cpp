// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Is the truth where the observer says, when what is declared of its errors is true? Motors, wires and sensors are
// written out here and share no code with the library: the true motor is stepped by Euler in hundredths of a second,
// each run draws its standing errors once and keeps them.

#include "../catch.hpp"

#include <cmath>
#include <cstdio>
#include <random>

#include <thermopower/actuator/temperature_observer.hpp>
#include <thermopower/control/certified/limiter.hpp>

namespace {

using namespace thermopower;

/// One standard deviation of each.
struct Errors {
  const char* name;
  double heat, air_K, voltage, offset_A, noise_A, start_K;
};

constexpr double winding_J_per_K = 8.0, body_J_per_K = 80.0, coupling_W_per_K = 1.0, air_W_per_K = 0.2;
constexpr double cold_ohm = 8.0, per_K = 0.00393, air_C = 25.0;

struct World {
  double winding_C, body_C, air_C, heat_factor, voltage_factor, offset_A;
  double volt = 0.0;

  double resistance_ohm() const { return cold_ohm * (1.0 + per_K * (winding_C - 20.0)); }
  /// Returns the heat that arose, J.
  double pass(double seconds) {
    const int steps = static_cast<int>(seconds * 100.0 + 0.5);
    double joule = 0.0;
    for (int i = 0; i < steps; ++i) {
      const double heat_W = volt * volt / resistance_ohm();
      const double across_W = coupling_W_per_K * (winding_C - body_C);
      joule += heat_W * 0.01;
      winding_C += 0.01 * (heat_W - across_W) / winding_J_per_K;
      body_C += 0.01 * (across_W - air_W_per_K * (body_C - air_C)) / body_J_per_K;
    }
    return joule;
  }
};

TemperatureObserverConfig declared(const Errors& errors) {
  TemperatureObserverConfig config =
      TemperatureObserverConfig::standard({static_cast<float>(winding_J_per_K),
                                           static_cast<float>(body_J_per_K),
                                           static_cast<float>(coupling_W_per_K),
                                           {static_cast<float>(air_W_per_K)}});
  config.heat_error = static_cast<float>(errors.heat > 0.0 ? errors.heat : 1e-4);
  config.air_error_K = static_cast<float>(errors.air_K);
  return config;
}
WindingResistance::Config sensor(const Errors& errors) {
  WindingResistance::Config config = WindingResistance::Config::standard();
  config.resistance_ohm = static_cast<float>(cold_ohm);
  config.tempco_per_K = static_cast<float>(per_K);
  config.voltage_std_fraction = static_cast<float>(errors.voltage);
  config.current_offset_A = static_cast<float>(errors.offset_A);
  config.current_std_A = static_cast<float>(errors.noise_A);
  return config;
}
World drawn(const Errors& errors, std::mt19937& random) {
  std::normal_distribution<double> normal;
  World world = {};
  const double start_C = air_C + 20.0;
  world.winding_C = start_C + errors.start_K * normal(random);
  world.body_C = start_C + errors.start_K * normal(random);
  world.air_C = air_C + errors.air_K * normal(random);
  world.heat_factor = std::fmax(0.1, 1.0 + errors.heat * normal(random));
  world.voltage_factor = 1.0 + errors.voltage * normal(random);
  world.offset_A = errors.offset_A * normal(random);
  return world;
}
void correct(TemperatureObserver& observer, const World& world, const WindingResistance& winding,
             const Errors& errors, std::mt19937& random) {
  std::normal_distribution<double> normal;
  const double ampere =
      world.volt / world.resistance_ohm() + world.offset_A + errors.noise_A * normal(random);
  observer.correct_winding(winding, static_cast<float>(world.volt * world.voltage_factor),
                           static_cast<float>(std::round(ampere * 1000.0) / 1000.0));
}

struct Coverage {
  double winding, body;            // within two sigma
  double winding_over, body_over;  // above the estimate plus three
};

Coverage coverage(const Errors& errors, double step_s, int measure_every, int runs) {
  std::mt19937 random(17);
  const WindingResistance winding(sensor(errors));
  REQUIRE(winding.validate() == ConfigError::none);
  long seen = 0, winding_in = 0, body_in = 0, winding_over = 0, body_over = 0;
  for (int run = 0; run < runs; ++run) {
    World world = drawn(errors, random);
    TemperatureObserver observer(declared(errors), 110.0f, 25.0f);
    REQUIRE(observer.validate() == ConfigError::none);
    observer.start(45.0f, 45.0f, static_cast<float>(errors.start_K), static_cast<float>(errors.start_K),
                   0.0f);
    const int steps = static_cast<int>(400.0 / step_s);
    double until_s = 0.0;
    for (int i = 0; i < steps; ++i) {
      if (i * step_s >= until_s) {  // work comes and goes
        until_s += std::uniform_real_distribution<double>(5.0, 60.0)(random);
        world.volt = std::uniform_real_distribution<double>(3.2, 11.0)(random);
      }
      const double told_W = world.pass(step_s) / step_s / world.heat_factor;
      observer.step(static_cast<float>(told_W), static_cast<float>(air_C), static_cast<float>(step_s));
      if (measure_every > 0 && i % measure_every == 0) correct(observer, world, winding, errors, random);
      if (i % static_cast<int>(10.0 / step_s) != 0) continue;
      ++seen;
      const auto winding_K = world.winding_C - static_cast<double>(observer.state().winding_C);
      const auto body_K = world.body_C - static_cast<double>(observer.state().body_C);
      winding_in += std::fabs(winding_K) <= 2.0 * static_cast<double>(observer.winding_std_K()) ? 1 : 0;
      body_in += std::fabs(body_K) <= 2.0 * static_cast<double>(observer.body_std_K()) ? 1 : 0;
      winding_over += world.winding_C > static_cast<double>(observer.winding_upper_C(3.0f)) ? 1 : 0;
      body_over += world.body_C > static_cast<double>(observer.body_upper_C(3.0f)) ? 1 : 0;
    }
  }
  const auto share = [&](long count) { return static_cast<double>(count) / static_cast<double>(seen); };
  return {share(winding_in), share(body_in), share(winding_over), share(body_over)};
}

const Errors mixes[] = {{"voltage alone", 0, 0, 0.01, 0, 0.005, 1},
                        {"offset alone", 0, 0, 0, 0.005, 0.005, 1},
                        {"heat alone", 0.2, 0, 0, 0, 0.005, 1},
                        {"air alone", 0, 2, 0, 0, 0.005, 1},
                        {"voltage and offset", 0, 0, 0.01, 0.005, 0.005, 1},
                        {"heat and air", 0.2, 2, 0, 0, 0.005, 1},
                        {"all of them", 0.2, 2, 0.01, 0.005, 0.005, 2},
                        {"all of them, little noise", 0.2, 2, 0.01, 0.005, 0.0005, 2}};

/// How often the loop steps the observer, and in how many of its steps the winding is read.
struct Rate {
  const char* name;
  double step_s;
  int measure_every;
};
const Rate rates[] = {
    {"never", 0.25, 0}, {"every 0.27 s", 0.09, 3}, {"every 0.5 s", 0.25, 2}, {"every 10 s", 1.0, 10}};

}  // namespace

TEST_CASE("the truth is within two sigma in 93 to 97 %, under any mix of the declared errors") {
  std::printf("| errors | measured | within 2 sigma: winding | body | above 3 sigma: winding | body |\n");
  for (const Errors& errors : mixes)
    for (const Rate& rate : rates) {
      if (rate.measure_every == 0 && errors.heat + errors.air_K == 0.0) continue;  // nothing acts
      const Coverage found = coverage(errors, rate.step_s, rate.measure_every, 1000);
      std::printf("| %s | %s | %.1f %% | %.1f %% | %.2f %% | %.2f %% |\n", errors.name, rate.name,
                  100 * found.winding, 100 * found.body, 100 * found.winding_over, 100 * found.body_over);
      INFO(errors.name << ", measured " << rate.name);
      CHECK(found.winding > 0.93);
      CHECK(found.winding < 0.97);
      CHECK(found.body > 0.93);
      CHECK(found.body < 0.97);
      CHECK(found.winding_over < 0.005);
      CHECK(found.body_over < 0.005);
    }
}

TEST_CASE("a certified limiter that is told the estimate plus three sigma keeps its limits that often") {
  // Heat that may be 60 % more than computed: three sigma of what is declared.
  const Errors errors = {"all", 0.2, 2, 0.01, 0.005, 0.005, 2};
  constexpr double supply_V = 13.0, step_s = 0.09, winding_limit_C = 110.0, body_limit_C = 60.0;
  const Bounds ohm = {static_cast<float>(cold_ohm / 1.6), 8.1f}, tempco = {0.00392f, 0.00394f};
  CertifiedLimiter<>::Config config = CertifiedLimiter<>::Config::standard();
  config.network = CertifiedTwoNode::Config::around(declared(errors).thermal, 0.01f, 110.0f, 60.0f);
  config.use = {
      HeatBounds::ohmic(13.0f, 0.0f, ohm, tempco, 20.0f, 0.0f, 110.0f, 1.0f), 35.0f, 0.1f, 30.0f, 1, 0};
  config.air_error_K = 8.0f;
  REQUIRE(config.validate() == ConfigError::none);
  const WindingResistance winding(sensor(errors));
  double heat_W[2] = {0.0, 0.0}, most_over_K = 0.0;
  long over = 0, over_runs = 0, seen = 0;
  const int runs = 400;
  for (const bool is_told : {false, true}) {
    std::mt19937 random(23);
    for (int run = 0; run < runs; ++run) {
      World world = drawn(errors, random);
      TemperatureObserver observer(declared(errors), 110.0f, 25.0f);
      observer.start(45.0f, 45.0f, 2.0f, 2.0f, 0.0f);
      CertifiedLimiter<> limiter(config);
      double joule = 0.0;
      bool is_over = false;
      for (int i = 0; i < 10000; ++i) {  // a quarter of an hour at full demand
        if (is_told && i % 3 == 0) {
          correct(observer, world, winding, errors, random);
          limiter.tighten(GuardedCelsius::winding_upper_of(observer, 3.0f),
                          GuardedCelsius::body_upper_of(observer, 3.0f));
        }
        const uint8_t power =
            limiter
                .step({255, static_cast<float>(supply_V), static_cast<float>(air_C)}, i == 0 ? 0.0f : 0.09f)
                .power;
        // The winding's heat follows POWER; what arises is more or less than what the controller computes.
        world.volt = supply_V * std::sqrt(power / 255.0 * world.heat_factor);
        const double done_J = world.pass(step_s);
        joule += done_J;
        world.volt = supply_V * std::sqrt(power / 255.0);
        observer.step(static_cast<float>(done_J / step_s / world.heat_factor), static_cast<float>(air_C),
                      0.09f);
        const double over_K = std::fmax(world.winding_C - winding_limit_C, world.body_C - body_limit_C);
        most_over_K = std::fmax(most_over_K, over_K);
        ++seen;
        over += over_K > 0.0 ? 1 : 0;
        is_over = is_over || over_K > 0.0;
      }
      heat_W[is_told ? 1 : 0] += joule / (10000 * step_s) / runs;
      over_runs += is_over ? 1 : 0;
    }
    if (!is_told) CHECK(over == 0);  // the proof alone
  }
  std::printf(
      "told three sigma: over a limit for %.2f %% of the time in %ld of %d runs, by at most %.1f K; "
      "mean heat %.2f W, %.2f W without\n",
      100.0 * static_cast<double>(over) / (0.5 * static_cast<double>(seen)), over_runs, runs, most_over_K,
      heat_W[1], heat_W[0]);
  CHECK(static_cast<double>(over) < 0.003 * 0.5 * static_cast<double>(seen));
  CHECK(most_over_K < 2.0);
  CHECK(heat_W[1] > heat_W[0]);
}
