// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// What the certified limiter makes of measurements, whenever they were taken and whenever it is told, of bodies
// that are colder than the air, and of steps that come late. The plant is integrated here, in small steps, and
// shares nothing with the library.

#include "../../catch.hpp"
#include "../limiter_inputs.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <random>

#include <thermopower/control/certified/limiter.hpp>

using namespace thermopower;

namespace {

const float not_measured = detail::not_a_number();

/// A motor somewhere in its bounds, which it may move through.
struct Plant {
  double winding_J_per_K, body_J_per_K, coupling_W_per_K, conductance_W_per_K, ohm_at_20C, supply_V;
  double winding_C, body_C, air_C;

  /// POWER that acts for a time; steps of a fiftieth of the fastest time constant, or of a millisecond.
  void run(int power, double time_s) {
    const double step_s = std::min(0.02 * winding_J_per_K / (coupling_W_per_K + conductance_W_per_K), 0.02);
    for (double left_s = time_s; left_s > 0.0; left_s -= step_s) {
      const double dt_s = std::min(left_s, step_s);
      // The midpoint rule.
      double dw, db;
      rates(power, winding_C, body_C, dw, db);
      rates(power, winding_C + 0.5 * dt_s * dw, body_C + 0.5 * dt_s * db, dw, db);
      winding_C += dt_s * dw, body_C += dt_s * db;
    }
  }
  void rates(int power, double w, double b, double& dw, double& db) const {
    const double heat_W = supply_V * supply_V * power / 255.0 / (ohm_at_20C * (1.0 + 0.0039 * (w - 20.0)));
    dw = (heat_W - coupling_W_per_K * (w - b)) / winding_J_per_K;
    db = (coupling_W_per_K * (w - b) - conductance_W_per_K * (b - air_C)) / body_J_per_K;
  }
};

typedef std::mt19937_64 Random;
double uniform(Random& random, double from, double to) {
  return std::uniform_real_distribution<double>(from, to)(random);
}

struct Draw {
  CertifiedLimiter<>::Config config;
  Plant plant;
  double hold_s;
};

/// A motor of random size, declared within 30 %. @param longest_hold_s  how coarse the control may be
Draw draw(Random& random, double longest_hold_s, double lightest_body = 2.0, double heaviest_body = 30.0,
          double loosest = 0.3) {
  Draw d;
  const double winding = std::exp(uniform(random, std::log(2.0), std::log(40.0)));
  const double body = winding * uniform(random, lightest_body, heaviest_body);
  const double tau_s = std::exp(uniform(random, std::log(2.0), std::log(40.0)));
  const double coupling = winding / tau_s, conductance = coupling * uniform(random, 0.05, 0.4);
  const double tolerance = uniform(random, 0.0, loosest);
  const auto within = [&](double value) { return value * uniform(random, 1.0 - tolerance, 1.0 + tolerance); };
  const double limit_body_C = uniform(random, 60.0, 90.0),
               limit_winding_C = limit_body_C + uniform(random, 5.0, 80.0);
  // Full power would take the winding far over its limit.
  const double ohm = 13.0 * 13.0 / (uniform(random, 1.0, 6.0) * conductance * (limit_winding_C - 20.0));
  d.plant = {within(winding),
             within(body),
             coupling * uniform(random, 1.0 - tolerance, 2.0),
             conductance * uniform(random, 1.0 - tolerance, 2.0),
             within(ohm),
             uniform(random, 11.0, 13.0),
             25.0,
             25.0,
             25.0};
  d.hold_s = std::exp(uniform(random, std::log(0.02), std::log(longest_hold_s)));
  const auto around = [&](double value) {
    return Bounds{static_cast<float>(value * (1.0 - tolerance) * 0.999),
                  static_cast<float>(value * (1.0 + tolerance) * 1.001)};
  };
  d.config = CertifiedLimiter<>::Config::standard();
  d.config.network = {around(winding),
                      around(body),
                      static_cast<float>(coupling * (1.0 - tolerance) * 0.999),
                      static_cast<float>(conductance * (1.0 - tolerance) * 0.999),
                      static_cast<float>(limit_winding_C),
                      static_cast<float>(limit_body_C)};
  d.config.use.heat = HeatBounds::ohmic(13.0f, 1.0f, around(ohm), {0.0038f, 0.0040f}, 20.0f, -20.0f,
                                        static_cast<float>(limit_winding_C));
  d.config.use.highest_air_C = 45.0f;
  d.config.use.hold_s = static_cast<float>(d.hold_s * 1.0001);
  d.config.use.horizon_s = static_cast<float>(std::max(30.0, d.hold_s * 2.0));
  d.config.air_error_K = 0.0f;
  return d;
}

}  // namespace

TEST_CASE("a measurement of any instant, told at any instant, never takes a bound below the truth") {
  Random random(20260611);
  double closest_winding_K = 1e9, closest_body_K = 1e9, lowered_K = 0.0;
  long refused = 0, steps = 0;
  for (int run = 0; run < 1500; ++run) {
    Draw d = draw(random, 10.0);
    if (is_error(d.config.validate())) {
      ++refused;
      continue;
    }
    Plant& plant = d.plant;
    CertifiedLimiter<> limiter(d.config), untold(d.config);
    // Cold as the air, or anything below the limits that the limiter starts from.
    plant.air_C = uniform(random, -15.0, 44.0);
    plant.body_C = plant.winding_C = plant.air_C;
    const bool has_measured_air = uniform(random, 0.0, 1.0) < 0.7;
    const int order =
        static_cast<int>(random() % 3);  // before the step, after it, or in the middle of the time
    const double often = uniform(random, 0.0, 1.0);
    const double error_K = uniform(random, 0.0, 1.0) < 0.5 ? 0.0 : uniform(random, 0.0, 5.0);
    int power = 1;
    bool was_certified = false;
    for (int i = 0; i < 250; ++i, ++steps) {
      const double dt_s = d.hold_s * uniform(random, 0.2, 1.0), at_s = order == 0 ? dt_s
                                                                       : order == 1
                                                                           ? 0.0
                                                                           : uniform(random, 0.0, dt_s);
      const auto tell = [&] {
        if (uniform(random, 0.0, 1.0) > often) return;
        const double off = uniform(random, 0.0, 1.0) < 0.5 ? 0.0 : uniform(random, 0.0, error_K);
        const int which = static_cast<int>(random() % 3);
        limiter.tighten(
            told::degrees(which == 1 ? not_measured : static_cast<float>(plant.winding_C + off + 1e-4)),
            told::degrees(which == 0 ? not_measured : static_cast<float>(plant.body_C + off + 1e-4)));
      };
      plant.run(power, at_s);
      tell();
      plant.run(power, dt_s - at_s);
      if (random() % 7 == 0) plant.air_C = uniform(random, -15.0, 44.0);
      const float air_C = has_measured_air ? static_cast<float>(plant.air_C) : not_measured;
      const std::uint8_t demand = static_cast<std::uint8_t>(random() % 4 == 0 ? 1 + random() % 255 : 255);
      power = limiter.step({demand, 13.0f, air_C}, static_cast<float>(dt_s)).power;
      const CertifiedLimiter<>::State state = limiter.state();
      const double winding_K = static_cast<double>(state.winding_upper_C) - plant.winding_C;
      const double body_K = static_cast<double>(state.body_upper_C) - plant.body_C;
      closest_winding_K = std::min(closest_winding_K, winding_K);
      closest_body_K = std::min(closest_body_K, body_K);
      if (winding_K < -2e-3 || body_K < -2e-3)
        FAIL("run " << run << " step " << i << ": the truth is " << -winding_K
                    << " K above the winding's bound, " << -body_K << " K above the body's");
      REQUIRE(plant.winding_C <= static_cast<double>(d.config.network.maximum_winding_C));
      REQUIRE(plant.body_C <= static_cast<double>(d.config.network.maximum_body_C));
      // Once certified, always certified.
      if (was_certified && !state.is_certified)
        FAIL("run " << run << " step " << i << ": no longer certified");
      was_certified = state.is_certified;
      untold.step({demand, 13.0f, air_C}, static_cast<float>(dt_s));
      lowered_K += static_cast<double>(untold.winding_upper_C() - state.winding_upper_C);
    }
    CHECK(was_certified);
  }
  CAPTURE(closest_winding_K, closest_body_K, refused, steps);
  CHECK(refused < 750);
  CHECK(steps > 150000);
  CHECK(lowered_K / static_cast<double>(steps) > 1.0);  // and telling it is worth something
}

TEST_CASE("a measurement told before a step or after the one before makes no difference") {
  Random random(7);
  for (int run = 0; run < 200; ++run) {
    Draw d = draw(random, 5.0);
    if (is_error(d.config.validate())) continue;
    CertifiedLimiter<> before(d.config), after(d.config);
    for (int i = 0; i < 100; ++i) {
      const float winding_C = static_cast<float>(uniform(random, -20.0, 120.0)),
                  body_C = static_cast<float>(uniform(random, -20.0, 90.0));
      const CertifiedLimiter<>::Inputs inputs = {255, 13.0f, static_cast<float>(uniform(random, 0.0, 44.0))};
      const float dt_s = static_cast<float>(d.hold_s * uniform(random, 0.1, 1.0));
      after.tighten(told::degrees(winding_C), told::degrees(body_C));
      before.ceiling();
      before.tighten(told::degrees(winding_C), told::degrees(body_C));
      REQUIRE(before.step(inputs, dt_s).power == after.step(inputs, dt_s).power);
      REQUIRE(before.winding_upper_C() == after.winding_upper_C());
      // Told once more after the step: nothing is lowered before time has passed.
      const float bound_C = after.winding_upper_C();
      after.tighten(told::degrees(-50.0f), told::degrees(-50.0f));
      REQUIRE(after.winding_upper_C() == bound_C);
      before.tighten(told::degrees(-50.0f), told::degrees(-50.0f));
    }
  }
}

TEST_CASE("a body that is colder than the air warms the winding, and the bounds know") {
  Random random(99);
  double worst_K = 1e9;
  for (int run = 0; run < 600; ++run) {
    Draw d = draw(random, 10.0, 0.3, 2.0, 0.02);
    if (is_error(d.config.validate())) continue;
    Plant& plant = d.plant;
    CertifiedLimiter<> limiter(d.config);
    plant.air_C = uniform(random, 30.0, 44.0);
    plant.body_C = uniform(random, -15.0, plant.air_C);  // brought in from the cold
    plant.winding_C = uniform(random, plant.body_C, static_cast<double>(d.config.network.maximum_winding_C));
    // No conductance is declared but the least: a gust takes the body to the air at once.
    plant.conductance_W_per_K *= std::exp(uniform(random, 0.0, std::log(200.0)));
    if (run % 3 != 0) {  // the slowest winding on the lightest body there can be
      plant.winding_J_per_K =
          static_cast<double>(d.config.network.winding_heat_capacity_J_per_K.highest) * 0.9999;
      plant.body_J_per_K = static_cast<double>(d.config.network.body_heat_capacity_J_per_K.lowest) * 1.0001;
      plant.coupling_W_per_K = static_cast<double>(d.config.network.least_coupling_W_per_K) * 1.0001;
    }
    limiter.start(static_cast<float>(plant.winding_C) + 1e-3f, static_cast<float>(plant.body_C) + 1e-3f);
    int power = 1;
    for (int i = 0; i < 300; ++i) {
      const double dt_s = d.hold_s * uniform(random, 0.5, 1.0);
      plant.run(power, dt_s);
      power = limiter
                  .step({static_cast<std::uint8_t>(run % 2 == 0 ? 255 : 1), 13.0f,
                         static_cast<float>(plant.air_C)},
                        static_cast<float>(dt_s))
                  .power;
      worst_K = std::min(worst_K, std::min(static_cast<double>(limiter.winding_upper_C()) - plant.winding_C,
                                           static_cast<double>(limiter.body_upper_C()) - plant.body_C));
      if (worst_K < -2e-3) FAIL("run " << run << " step " << i << ": " << -worst_K << " K above a bound");
    }
  }
}

TEST_CASE("a step that comes late takes the certificate away until the next one in time") {
  Random random(3);
  int tried = 0;
  while (tried < 50) {
    Draw d = draw(random, 0.5);
    if (is_error(d.config.validate())) continue;
    ++tried;
    CertifiedLimiter<> limiter(d.config);
    const float hold_s = static_cast<float>(d.hold_s);
    for (int i = 0; i < 20; ++i) limiter.step({255, 13.0f, 25.0f}, hold_s);
    REQUIRE(limiter.is_certified());
    limiter.step({255, 13.0f, 25.0f}, hold_s * 1.5f);
    CHECK_FALSE(limiter.is_certified());
    CHECK(limiter.state().late_steps == 1);
    for (int i = 0; i < 200000 && !limiter.is_certified(); ++i) limiter.step({255, 13.0f, 25.0f}, hold_s);
    CHECK(limiter.is_certified());
  }
}

TEST_CASE("one node: measurements of any instant, told at any instant") {
  Random random(11);
  for (int run = 0; run < 300; ++run) {
    const double capacity = uniform(random, 20.0, 200.0), tau_s = uniform(random, 20.0, 400.0),
                 conductance = capacity / tau_s;
    const double ohm = 13.0 * 13.0 / (uniform(random, 1.0, 5.0) * conductance * 40.0),
                 hold_s = uniform(random, 0.05, 10.0);
    CertifiedLimiter<CertifiedOneNode>::Config config =
        CertifiedLimiter<CertifiedOneNode>::Config::standard();
    config.network = {Bounds::around(static_cast<float>(capacity), 0.1f),
                      static_cast<float>(conductance * 0.9), 60.0f};
    config.use.heat = HeatBounds::ohmic(13.0f, 1.0f, Bounds::around(static_cast<float>(ohm), 0.05f),
                                        {0.0038f, 0.004f}, 20.0f, -20.0f, 60.0f);
    config.use.highest_air_C = 40.0f, config.use.hold_s = static_cast<float>(hold_s * 1.0001),
    config.air_error_K = 0.0f;
    if (is_error(config.validate())) continue;
    CertifiedLimiter<CertifiedOneNode> limiter(config);
    const double c = capacity * uniform(random, 0.9, 1.1), g = conductance * uniform(random, 0.91, 1.5),
                 r = ohm * uniform(random, 0.95, 1.05);
    double T = 20.0, air_C = 20.0;
    int power = 1;
    const auto pass = [&](double time_s) {
      for (int k = 0; k < 200; ++k)
        T += time_s / 200.0 *
             (13.0 * 13.0 * power / 255.0 / (r * (1.0 + 0.0039 * (T - 20.0))) - g * (T - air_C)) / c;
    };
    for (int i = 0; i < 300; ++i) {
      const double dt_s = hold_s * uniform(random, 0.2, 1.0), at_s = dt_s * uniform(random, 0.0, 1.0);
      pass(at_s);
      if (random() % 2 == 0)
        limiter.tighten(told::degrees(static_cast<float>(T) + 1e-3f), told::degrees(not_measured));
      pass(dt_s - at_s);
      if (random() % 9 == 0) air_C = uniform(random, -15.0, 40.0);
      power = limiter.step({255, 13.0f, static_cast<float>(air_C)}, static_cast<float>(dt_s)).power;
      if (T > static_cast<double>(limiter.winding_upper_C()) + 2e-3)
        FAIL("run " << run << ": " << T << " above " << limiter.winding_upper_C());
      REQUIRE(T <= 60.0);
    }
  }
}

namespace {

enum class Measured { nothing, supply, temperatures };

/// How far a winding of 8 J/K passes its limit in half an hour when each power takes effect late, K; negative: it stays below.
/// @param counted_s  of the delay, how much is counted into hold_s
double over_limit_K(Measured measured, double delay_s, double counted_s) {
  CertifiedLimiter<>::Config config = CertifiedLimiter<>::Config::standard();
  config.network = {{8.0f, 8.0f}, {80.0f, 80.0f}, 2.0f, 0.2f, 110.0f, 100.0f};
  config.use.heat =
      HeatBounds::ohmic(24.0f, 0.02f, {2.0f, 2.0f}, {0.0039f, 0.0039f}, 20.0f, 0.0f, 110.0f, 10.0f);
  config.use.highest_air_C = 40.0f;
  config.air_error_K = 0.0f;
  config.use.hold_s = static_cast<float>(0.1 + counted_s);
  config.use.horizon_s = static_cast<float>(1.0 + counted_s);
  CertifiedLimiter<> limiter(config);
  REQUIRE(limiter.validate() == ConfigError::none);
  limiter.start(25.1f, 25.1f, 25.0f);
  Plant plant = {8.0, 80.0, 2.0, 0.2, 2.0, 24.0, 25.0, 25.0, 25.0};
  std::deque<int> line(1 + static_cast<std::size_t>(delay_s / 0.1 + 0.5), 1);
  const double step_s = 0.0999;
  double over_K = -1e9;
  for (int i = 0; i < 18000; ++i) {
    // A supply that changes stays until every power that was planned with it has ceased to act.
    plant.supply_V = measured == Measured::supply && i / 400 % 2 == 1 ? 12.0 : 24.0;
    plant.run(line.front(), step_s);
    over_K = std::max(over_K, plant.winding_C - 110.0);
    const bool is_sagging_on = (i + 1) / 400 % 2 == 1 && (i + 1 + 40) / 400 % 2 == 1;
    const float told_V = measured == Measured::supply && is_sagging_on ? 12.0f : 24.0f;
    if (measured == Measured::temperatures)
      limiter.tighten(told::degrees(static_cast<float>(plant.winding_C) + 0.01f),
                      told::degrees(static_cast<float>(plant.body_C) + 0.01f));
    line.push_back(limiter.step({255, told_V, 25.0f}, static_cast<float>(step_s)).power);
    line.pop_front();
  }
  return over_K;
}

}  // namespace

TEST_CASE("a delay that is counted into hold_s passes no limit, whatever is measured") {
  for (const double delay_s : {0.0, 0.1, 0.5, 2.0})
    for (const Measured measured : {Measured::nothing, Measured::supply, Measured::temperatures}) {
      INFO("delay " << delay_s << " s, measured " << static_cast<int>(measured));
      CHECK(over_limit_K(measured, delay_s, delay_s) < 0.0);
    }
}

TEST_CASE("a delay that nobody counts only shifts time where nothing is measured") {
  CHECK(over_limit_K(Measured::nothing, 2.0, 0.0) < 0.0);
  CHECK(over_limit_K(Measured::temperatures, 2.0, 0.0) > 1.0);
}
