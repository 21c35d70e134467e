// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "../../catch.hpp"

#include <cstdio>
#include <vector>

#include "two_node_plant.hpp"

using namespace certified_test;
using namespace thermopower;

namespace {

typedef CertifiedLimiter<CertifiedCoupledTwoNode> Coupled;

/// A motor with a printed bracket: +-20 % on every constant.
CertifiedLimiter<>::Config bench_motor(float fraction = 0.2f) {
  CertifiedLimiter<>::Config config = CertifiedLimiter<>::Config::standard();
  config.network = {Bounds::around(8.0f, fraction),
                    Bounds::around(80.0f, fraction),
                    1.0f * (1.0f - fraction),
                    0.2f * (1.0f - fraction),
                    110.0f,
                    60.0f};
  config.use.heat = HeatBounds::ohmic(13.0f, 1.0f, Bounds::around(8.0f, 0.25f * fraction), {0.0038f, 0.0040f},
                                      20.0f, 0.0f, 110.0f);
  config.use.highest_air_C = 30.0f;
  config.use.hold_s = 0.1f;
  config.use.horizon_s = 30.0f;
  config.air_error_K = 1.0f;
  return config;
}

Truth nominal_truth() { return {8.0, 80.0, 1.0, 0.2, 13.0, 8.0, 0.0039, 20.0, 25.0}; }

/// The best anyone could do: the largest power that, with the true constants known, can be followed by the
/// least power for ever.
std::uint8_t best_power(const Plant& now, const Truth& truth, double limit_winding, double limit_body,
                        double dt) {
  int low = 1, high = 255;
  while (low < high) {
    const int power = (low + high + 1) / 2;
    Plant then = now;
    then.step(truth, truth.heat_W(power, now.winding_C), dt);
    double peak = then.body_C;
    bool is_safe = then.winding_C <= limit_winding && then.body_C <= limit_body;
    for (int i = 0; is_safe && i < 400; ++i) {  // the free response, until the body falls
      const double before = then.body_C;
      then.step(truth, truth.heat_W(1, then.winding_C), 0.5);
      peak = std::max(peak, then.body_C);
      if (then.body_C < before) break;
    }
    is_safe = is_safe && peak <= limit_body;
    if (is_safe) low = power;
    else high = power - 1;
  }
  return static_cast<std::uint8_t>(low);
}

/// The largest power that an actuator bears if the air may be at its highest at the next plan, and body and winding and
/// body and air as closely coupled as they like, because nothing declared bounds that from above.
std::uint8_t best_power_in_bounds(const Plant& now, const Truth& worst, double limit_winding,
                                  double limit_body, double highest_air_C, double dt) {
  const double mu = worst.winding_J_per_K / (worst.winding_J_per_K + worst.body_J_per_K);
  int low = 1, high = 255;
  while (low < high) {
    const int power = (low + high + 1) / 2;
    Plant then = now;
    then.step(worst, worst.heat_W(power, now.winding_C), dt);
    const double equalised_C = mu * then.winding_C + (1.0 - mu) * std::max(then.body_C, highest_air_C);
    if (then.winding_C <= limit_winding && equalised_C <= limit_body) low = power;
    else high = power - 1;
  }
  return static_cast<std::uint8_t>(low);
}

}  // namespace

TEST_CASE("no actuator inside its bounds ever exceeds a limit") {
  Random random(20260101);
  double winding_K = -1e9, body_K = -1e9, over_bound_K = -1e9;
  long limited = 0, total = 0;
  int close = 0, lost = 0;
  for (int i = 0; i < 100000; ++i) {
    const Declared declared = draw_bounds(random);
    const double dangers[] = {0.3, 0.9, 1.0};
    const double danger = dangers[random() % 3];
    const int steps = static_cast<int>(log_uniform(random, 20.0, 300.0));
    const Excess excess =
        run(random, declared, draw_truth(random, declared, danger), i % 2 ? danger : -1.0, steps);
    winding_K = std::max(winding_K, excess.winding_K);
    body_K = std::max(body_K, excess.body_K);
    over_bound_K = std::max(over_bound_K, excess.over_bound_K);
    limited += excess.limited;
    total += steps;
    if (excess.lost_certificate) ++lost;
    if (std::max(excess.winding_K, excess.body_K) > -1.0) ++close;
  }
  std::printf(
      "100000 actuators: winding at most %.4f K, body at most %.4f K from its limit; %.0f %% of the steps "
      "limited; %d within 1 K\n",
      winding_K, body_K, 100.0 * static_cast<double>(limited) / static_cast<double>(total), close);
  CHECK(winding_K <= 0.0);
  CHECK(body_K <= 0.0);
  CHECK(over_bound_K <= 0.0);  // nor is its own upper bound ever wrong
  CHECK(lost == 0);            // once inside the safe set, always inside
  CHECK(close > 500);          // the test bites: many come close
}

TEST_CASE("outside the bounds the excess grows with the distance") {
  double last_K = -1e9;
  std::printf("true heat / declared heat -> excess of the body, K\n");
  for (const double factor : {1.0, 1.05, 1.1, 1.2, 1.5}) {
    CertifiedLimiter<>::Config config = bench_motor(0.0f);
    config.use.heat.coldest_C = 20.0f;
    config.use.highest_air_C = 25.0f;
    CertifiedLimiter<> limiter(config);
    REQUIRE(limiter.validate() == ConfigError::none);
    limiter.start(25.0f, 25.0f);
    Truth truth = nominal_truth();
    truth.resistance_ohm /= factor;
    Plant plant = {25.0, 25.0};
    double excess_K = -1e9;
    for (int i = 0; i < 60000; ++i) {
      const LimitedPower granted = limiter.step({255, 13.0f, 25.0f}, 0.1f);
      plant.step(truth, truth.heat_W(granted.power, plant.winding_C), 0.1);
      excess_K = std::max(excess_K, plant.body_C - 60.0);
    }
    std::printf("  %.2f %8.3f\n", factor, excess_K);
    CHECK(excess_K > last_K);
    CHECK(excess_K <= (factor - 1.0) * (60.0 - 25.0) +
                          1e-9);  // a body that takes x % more heat ends x % of its rise higher, no worse
    last_K = excess_K;
  }
}

TEST_CASE("a constant demand above the ceiling gives a power that falls, settles and stays") {
  for (const float horizon_s : {1.0f, 10.0f, 30.0f, 200.0f}) {
    CertifiedLimiter<>::Config config = bench_motor();
    config.use.horizon_s = horizon_s;
    CertifiedLimiter<> limiter(config);
    limiter.start(25.0f, 25.0f);
    int changes = 0, turns = 0, last = 256;
    bool is_rising = false;
    for (int i = 0; i < 400000; ++i) {
      const int power = limiter.step({255, 13.0f, 25.0f}, 0.02f).power;
      if (power != last && (power > last) != is_rising) {
        is_rising = power > last;
        ++turns;
      }
      if (power != last && i > 300000) ++changes;
      last = power;
    }
    INFO("horizon " << horizon_s << " s");
    CHECK(changes == 0);
    CHECK(turns <= 1);  // it falls; after a short horizon it may then rise to what is bearable for ever; it
                        // never falls again
    CHECK(last == limiter.state().sustainable);
    CHECK(last > 20);
  }
}

TEST_CASE("authority falls count by count, never in a jump") {
  CertifiedLimiter<> limiter(bench_motor());
  limiter.start(25.0f, 25.0f);
  int last = 255, largest_fall = 0;
  for (int i = 0; i < 60000; ++i) {
    const int power = limiter.step({255, 13.0f, 25.0f}, 0.02f).power;
    largest_fall = std::max(largest_fall, last - power);
    last = power;
  }
  CHECK(last < 128);
  CHECK(largest_fall <= 2);
}

TEST_CASE("the result does not depend on the loop rate") {
  std::vector<double> powers[3];
  const double rates_s[] = {0.002, 0.01, 0.1};
  for (int r = 0; r < 3; ++r) {
    CertifiedLimiter<> limiter(bench_motor());
    limiter.start(25.0f, 25.0f);
    const int every = static_cast<int>(std::lround(5.0 / rates_s[r]));
    for (int i = 0; i < every * 200; ++i) {
      const bool is_resting = i * rates_s[r] > 400.0 && i * rates_s[r] < 600.0;
      const LimitedPower granted = limiter.step(
          {static_cast<std::uint8_t>(is_resting ? 1 : 255), 13.0f, 25.0f}, static_cast<float>(rates_s[r]));
      if (i % every == 0) powers[r].push_back(granted.power);
    }
  }
  for (std::size_t i = 0; i < powers[0].size(); ++i) {
    INFO("at " << 5 * i << " s");
    CHECK(std::abs(powers[0][i] - powers[1][i]) <= 2.0);
    CHECK(std::abs(powers[0][i] - powers[2][i]) <= 3.0);
  }
}

TEST_CASE("little is wasted against the best possible with the true actuator known") {
  std::printf(
      "tolerance | heat granted / best possible, same bounds' worst actuator | the same, nominal actuator | "
      "steady power, limiter / best (worst actuator)\n");
  for (const float fraction : {0.0f, 0.05f, 0.1f, 0.2f}) {
    double share[2];
    double steady = 0.0;
    for (int is_nominal = 0; is_nominal < 2; ++is_nominal) {
      CertifiedLimiter<>::Config config = bench_motor(fraction);
      config.use.highest_air_C = 25.0f;
      config.air_error_K = 0.0f;
      CertifiedLimiter<> limiter(config);
      REQUIRE(limiter.validate() == ConfigError::none);
      limiter.start(25.0f, 25.0f);
      Truth truth = nominal_truth();
      if (!is_nominal) {
        const double f = static_cast<double>(fraction);
        truth = {8.0 * (1 - f),        80.0 * (1 - f), 1.0 * (1 - f), 0.2 * (1 - f), 13.0,
                 8.0 * (1 - 0.25 * f), 0.0038,         20.0,          25.0};
      }
      Plant ours = {25.0, 25.0}, best = {25.0, 25.0};
      double ours_J = 0.0, best_J = 0.0, ours_late_J = 0.0, best_late_J = 0.0;
      for (int i = 0; i < 20000; ++i) {
        const std::uint8_t last = limiter.step({255, 13.0f, 25.0f}, 0.1f).power;
        const double ours_W = truth.heat_W(last, ours.winding_C);
        ours.step(truth, ours_W, 0.1);
        ours_J += ours_W;
        const std::uint8_t last_best = best_power(best, truth, 110.0, 60.0, 0.1);
        const double best_W = truth.heat_W(last_best, best.winding_C);
        best.step(truth, best_W, 0.1);
        best_J += best_W;
        if (i >= 15000) {
          ours_late_J += ours_W;
          best_late_J += best_W;
        }
      }
      share[is_nominal] = ours_J / best_J;
      if (!is_nominal) steady = ours_late_J / best_late_J;
    }
    std::printf("  +-%4.0f %% | %.3f | %.3f | %.3f\n", 100.0 * static_cast<double>(fraction), share[0],
                share[1], steady);
    CHECK(share[0] > 0.85);
    CHECK(share[0] <= 1.0);
    if (fraction == 0.0f) CHECK(share[1] > 0.9);
  }
}

TEST_CASE("what is wasted over random motors, the median and the worst of them") {
  const int told = GENERATE(0, 1, 2, 3, 4, 5);
  // The air is measured at every plan, and where start() is told it, from the start on.
  const bool is_air_told = told > 0;
  // A winding whose resistance does not rise: what is missing then is not the heat taken at the mean (6).
  const bool is_heat_constant = told == 2;
  // Heat and cooling taken at one winding; then also how closely winding and body are coupled at most.
  const bool is_coupled = told >= 3, is_coupling_told = told == 4;
  // Resistance known no better than the rest; otherwise four times as well, as a meter tells it.
  const double resistance_part = told == 5 ? 1.0 : 0.25;
  std::printf(
      "%s\ntolerance | heat granted / best possible, random motors: median | worst || best within the bounds / "
      "best possible: median || granted / best within the bounds: median | worst\n",
      told == 5
          ? "air told at the start, CertifiedCoupledTwoNode, the whole tolerance on the resistance, too:"
      : is_heat_constant ? "air told at the start, resistance does not rise:"
      : is_coupling_told ? "air told at the start, CertifiedCoupledTwoNode, highest coupling declared:"
      : is_coupled       ? "air told at the start, CertifiedCoupledTwoNode:"
      : is_air_told      ? "air told at the start:"
                         : "air known from the first plan on:");
  const float tempco_per_K = is_heat_constant ? 0.0f : 0.0039f;
  for (const double fraction : {0.0, 0.1, 0.2}) {
    Random random(97);
    std::vector<double> shares, known, ours_of_known;
    while (shares.size() < 20) {
      // A motor in the middle of its bounds: a minute to an hour to warm up, one to fifteen times what it bears.
      Truth truth = nominal_truth();
      truth.tempco_per_K = is_heat_constant ? 0.0 : truth.tempco_per_K;
      truth.conductance_W_per_K = log_uniform(random, 0.05, 2.0);
      truth.coupling_W_per_K = truth.conductance_W_per_K * log_uniform(random, 1.0, 10.0);
      truth.body_J_per_K = truth.conductance_W_per_K * log_uniform(random, 100.0, 1000.0);
      truth.winding_J_per_K = truth.body_J_per_K * log_uniform(random, 0.03, 0.4);
      truth.air_C = uniform(random, 0.0, 30.0);
      const double body_C = uniform(random, 50.0, 100.0), winding_C = body_C + uniform(random, 10.0, 60.0);
      const double bearable_W = truth.conductance_W_per_K * (body_C - truth.air_C);
      truth.resistance_ohm = 13.0 * 13.0 / (bearable_W * log_uniform(random, 1.0, 15.0));
      const auto around = [&](double value, double part) {
        return Bounds::around(static_cast<float>(value), static_cast<float>(part * fraction));
      };
      CertifiedLimiter<>::Config config = bench_motor(0.0f);
      config.network = {around(truth.winding_J_per_K, 1.0),
                        around(truth.body_J_per_K, 1.0),
                        around(truth.coupling_W_per_K, 1.0).lowest,
                        around(truth.conductance_W_per_K, 1.0).lowest,
                        static_cast<float>(winding_C),
                        static_cast<float>(body_C)};
      config.use.heat =
          HeatBounds::ohmic(13.0f, 1.0f, around(truth.resistance_ohm, resistance_part),
                            {tempco_per_K, tempco_per_K}, 20.0f, 0.0f, static_cast<float>(winding_C));
      config.use.highest_air_C = 35.0f;  // it is measured: that is what bounds it
      config.air_error_K = 0.0f;
      CertifiedLimiter<> limiter(config);
      if (is_error(limiter.validate())) continue;
      const auto air_C = static_cast<float>(truth.air_C);
      Coupled::Config both = {{config.network, is_coupling_told ? around(truth.coupling_W_per_K, 1.0).highest
                                                                : static_cast<float>(INFINITY)},
                              config.use,
                              0.0f};
      Coupled coupled(both);
      REQUIRE(coupled.validate() == ConfigError::none);
      coupled.start(air_C, air_C, air_C);
      if (is_air_told) limiter.start(air_C, air_C, air_C);
      else limiter.start(air_C, air_C);
      Truth hottest = truth;  // one of the actuators that may be behind these bounds
      hottest.conductance_W_per_K *= 1.0 - fraction;
      hottest.coupling_W_per_K *= 1.0 - fraction;
      hottest.winding_J_per_K *= 1.0 - fraction;
      hottest.body_J_per_K *= 1.0 - fraction;
      hottest.resistance_ohm *= 1.0 - resistance_part * fraction;
      Truth closest = hottest;  // another: a winding as warm as the body draws more
      closest.coupling_W_per_K *= is_coupling_told ? (1.0 + fraction) / (1.0 - fraction) : 1000.0;
      Plant ours = {truth.air_C, truth.air_C}, best = ours, of_hottest = ours, of_closest = ours,
            in_bounds = ours;
      double ours_J = 0.0, best_J = 0.0, best_W = 0.0, in_bounds_J = 0.0;
      std::uint8_t allowed = 1;
      const int steps = static_cast<int>(30.0 * truth.body_J_per_K / truth.conductance_W_per_K);  // of 0.1 s
      std::uint8_t held = 1;
      for (int i = 0; i < steps; ++i) {
        const int power = is_coupled ? coupled.step({255, 13.0f, air_C}, 0.1f).power
                                     : limiter.step({255, 13.0f, air_C}, 0.1f).power;
        const double ours_W = truth.heat_W(power, ours.winding_C);
        ours.step(truth, ours_W, 0.1);
        ours_J += ours_W;
        if (i % 10 == 0) held = best_power(best, truth, winding_C, body_C, 1.0);
        // Whoever knows the bounds alone must be safe for both at least.
        if (i % 10 == 0)
          allowed = std::min(best_power_in_bounds(of_hottest, hottest, winding_C, body_C, 35.0, 1.0),
                             best_power_in_bounds(of_closest, closest, winding_C, body_C, 35.0, 1.0));
        of_hottest.step(hottest, hottest.heat_W(allowed, of_hottest.winding_C), 0.1);
        of_closest.step(closest, closest.heat_W(allowed, of_closest.winding_C), 0.1);
        const double allowed_W = truth.heat_W(allowed, in_bounds.winding_C);
        in_bounds.step(truth, allowed_W, 0.1);
        in_bounds_J += allowed_W;
        best_W = truth.heat_W(held, best.winding_C);
        best.step(truth, best_W, 0.1);
        best_J += best_W;
      }
      CHECK(ours.winding_C <= winding_C);
      CHECK(ours.body_C <= body_C);
      shares.push_back(ours_J / best_J);
      known.push_back(in_bounds_J / best_J);
      ours_of_known.push_back(ours_J / in_bounds_J);
    }
    for (std::vector<double>* each : {&shares, &known, &ours_of_known}) std::sort(each->begin(), each->end());
    const auto median = [](const std::vector<double>& sorted) { return 0.5 * (sorted[9] + sorted[10]); };
    std::printf("  +-%4.0f %% | %.3f | %.3f || %.3f || %.3f | %.3f\n", 100.0 * fraction, median(shares),
                shares[0], median(known), median(ours_of_known), ours_of_known[0]);
    CHECK(ours_of_known.back() <= 1.001);
    CHECK(shares.back() <= 1.001);  // the best is planned once a second
    CHECK(shares.front() > 0.3);    // what it grants is worth having
    if (is_coupling_told) CHECK(median(shares) > (fraction < 0.05 ? 0.95 : fraction < 0.15 ? 0.85 : 0.75));
  }
}

TEST_CASE("headroom and time to the limit say what happens next") {
  CertifiedLimiter<>::Config config = bench_motor(0.0f);
  config.use.highest_air_C = 25.0f;
  config.air_error_K = 0.0f;
  CertifiedLimiter<> limiter(config);
  limiter.start(25.0f, 25.0f);
  limiter.step({200, 13.0f, 25.0f}, 0.0f);
  CHECK(limiter.state().headroom_W > 0.0f);
  const double promised_s = static_cast<double>(limiter.state().seconds_to_limit);
  Truth truth = nominal_truth();
  truth.tempco_per_K = 0.0;  // constant heat, as at the start
  Plant plant = {25.0, 25.0};
  const double heat_W = truth.heat_W(200, 25.0);
  double taken_s = 0.0;
  while (plant.body_C < 60.0 && plant.winding_C < 110.0) {
    plant.step(truth, heat_W, 0.1);
    taken_s += 0.1;
  }
  CHECK(promised_s <= taken_s);  // pessimistic, by construction
  CHECK(promised_s > 0.7 * taken_s);
  limiter.step({5, 13.0f, 25.0f}, 0.1f);
  CHECK(std::isinf(limiter.state().seconds_to_limit));
}

TEST_CASE("a start that is told the air keeps a cold actuator cold") {
  CertifiedLimiter<>::Config config = bench_motor(0.1f);
  config.use.highest_air_C = 45.0f;
  config.air_error_K = 2.0f;
  const auto body_after = [&](bool is_air_told, float told_C) {
    CertifiedLimiter<> limiter(config);
    REQUIRE(limiter.validate() == ConfigError::none);
    if (is_air_told) limiter.start(10.0f, 10.0f, told_C);
    else limiter.start(10.0f, 10.0f);
    limiter.step({1, 13.0f, 10.0f}, 0.1f);
    return limiter.body_upper_C();
  };
  CHECK(body_after(false, 0.0f) > 45.0f);   // as warm as the hottest air would have made it by the first plan
  CHECK(body_after(true, 10.0f) < 14.0f);   // the least power warms it by less than 2 K
  CHECK(body_after(true, 10.0f) >= 12.0f);  // the air may be 2 K warmer than measured
  CHECK(body_after(true, thermopower::detail::not_a_number()) == body_after(false, 0.0f));
  CHECK(body_after(true, 200.0f) == body_after(false, 0.0f));
}

TEST_CASE("an unknown start counts as the limits, and gives the sustainable power at once") {
  CertifiedLimiter<> limiter(bench_motor());
  const LimitedPower granted = limiter.step({255, 13.0f, 25.0f}, 0.0f);
  CHECK(granted.power > 1);
  CHECK(granted.power <= limiter.state().sustainable + 1);
  CHECK(granted.reason == LimitReason::body_limit);
  CHECK(limiter.state().body_upper_C == Approx(60.0f).margin(0.01));
}

TEST_CASE("a fault gives the least power and forgets no heat") {
  CertifiedLimiter<> known(bench_motor()), unknown(bench_motor());
  for (auto* limiter : {&known, &unknown}) {
    limiter->start(25.0f, 25.0f);
    for (int i = 0; i < 100; ++i) limiter->step({255, 13.0f, 25.0f}, 0.1f);
  }
  const float before_C = known.winding_upper_C();
  CHECK(known.cut_after(LimitReason::link_silent, 255, 0.05f).power == 1);
  CHECK(unknown.cut(LimitReason::link_silent).power == 1);
  CHECK(known.winding_upper_C() > before_C);  // the last power acted until the fault
  CHECK(unknown.winding_upper_C() >= known.winding_upper_C());
  const float at_cut_C = unknown.winding_upper_C();
  for (int i = 0; i < 100; ++i) unknown.cut(LimitReason::link_silent);
  CHECK(unknown.winding_upper_C() <=
        at_cut_C + 1.0f);  // no time is known to have passed: nothing cooled, nothing heated
  CHECK(unknown.winding_upper_C() >= at_cut_C);
  CHECK(known.step({255, 13.0f, 25.0f}, detail::not_a_number()).reason == LimitReason::time_invalid);
  CHECK(known.step({255, 13.0f, 25.0f}, -0.1f).power == 1);
}

TEST_CASE("a step that comes late is carried soundly and counted") {
  Random random(7);
  double over_bound_K = -1e9;
  for (int i = 0; i < 2000; ++i) {
    Declared declared = draw_bounds(random);
    declared.config.use.every = 1;
    declared.config.use.phase = 0;
    CertifiedLimiter<> limiter(declared.config);
    Truth truth = draw_truth(random, declared, 1.0);
    const double start_C = truth.air_C;
    Plant plant = {start_C, start_C};
    limiter.start(static_cast<float>(start_C) + 1e-3f, static_cast<float>(start_C) + 1e-3f);
    for (int step = 0; step < 20; ++step) {
      const LimitedPower granted = limiter.step({255, detail::not_a_number(), detail::not_a_number()}, 0.0f);
      const double dt = static_cast<double>(static_cast<float>(
          static_cast<double>(declared.config.use.hold_s) * log_uniform(random, 1.1, 2000.0)));
      const double heat_W = truth.heat_W(granted.power, plant.winding_C);
      // Heat at the coldest the winding may become meanwhile: more than it can really take.
      plant.step(truth, std::max(heat_W, truth.heat_W(granted.power, std::min(plant.winding_C, truth.air_C))),
                 dt);
      limiter.step({1, detail::not_a_number(), detail::not_a_number()}, static_cast<float>(dt));
      over_bound_K = std::max({over_bound_K, plant.winding_C - static_cast<double>(limiter.winding_upper_C()),
                               plant.body_C - static_cast<double>(limiter.body_upper_C())});
    }
    CHECK(limiter.state().late_steps >= 20);
  }
  CHECK(over_bound_K <= 0.0);
}

TEST_CASE("one node: the same promises") {
  Random random(99);
  double worst_K = -1e9;
  for (int i = 0; i < 20000; ++i) {
    CertifiedLimiter<CertifiedOneNode>::Config config =
        CertifiedLimiter<CertifiedOneNode>::Config::standard();
    const double hold = log_uniform(random, 0.005, 1.0), tau = hold * log_uniform(random, 10.0, 1000.0);
    const double conductance = log_uniform(random, 0.05, 5.0), spread = uniform(random, 0.0, 0.4);
    const double limit = uniform(random, 40.0, 120.0), air = uniform(random, 0.0, limit - 10.0);
    const double full_W = conductance * (limit - air) * log_uniform(random, 1.0, 50.0);
    config.network = {Bounds::around(static_cast<float>(conductance * tau), static_cast<float>(spread)),
                      static_cast<float>(conductance * (1.0 - spread)), static_cast<float>(limit)};
    const double resistance = 144.0 / full_W;
    config.use.heat = HeatBounds::ohmic(12.0f, 1.0f, Bounds::around(static_cast<float>(resistance), 0.1f),
                                        {0.0038f, 0.0041f}, 20.0f, static_cast<float>(air) - 20.0f,
                                        static_cast<float>(limit));
    config.use.highest_air_C = static_cast<float>(air);
    config.use.hold_s = static_cast<float>(hold);
    config.use.every = 1;
    config.use.horizon_s = static_cast<float>(hold * log_uniform(random, 1.0, 500.0));
    CertifiedLimiter<CertifiedOneNode> limiter(config);
    if (is_error(limiter.validate())) continue;
    limiter.start(static_cast<float>(air), static_cast<float>(air));
    double node_C = air;
    const double capacity = conductance * tau * (chance(random, 0.5) ? 1.0 - spread : 1.0 + spread);
    for (int step = 0; step < 300; ++step) {
      const double g =
          conductance * (1.0 - spread) * (chance(random, 0.7) ? 1.0 : log_uniform(random, 1.0, 10.0));
      const std::uint8_t demand = step % 40 < 20 ? 255 : static_cast<std::uint8_t>(random() & 0xff);
      const LimitedPower granted =
          limiter.step({demand, 12.0f, detail::not_a_number()}, static_cast<float>(hold));
      const double heat_W =
          144.0 * granted.power / 255.0 /
          (resistance * static_cast<double>(1.0f - 0.1f) * (1.0 + 0.0038 * (node_C - 20.0)));
      const double settled_C = air + heat_W / g;
      if (settled_C > node_C || node_C > air)
        node_C = settled_C +
                 (node_C - settled_C) * std::exp(-g / capacity * static_cast<double>(config.use.hold_s));
      worst_K = std::max(worst_K, node_C - limit);
    }
  }
  CHECK(worst_K <= 0.0);
  CHECK(worst_K > -0.5);
}

TEST_CASE("a heat that rises with the square of POWER is inverted without a root, downwards") {
  for (int power = 1; power <= 255; ++power) {
    const std::uint8_t count = SquareHeat::count(static_cast<std::uint8_t>(power));
    CHECK(count * 255 >= power * power);
    CHECK(SquareHeat::power(count) >= power);
    CHECK(SquareHeat::power(count) * SquareHeat::power(count) <= count * 255);
  }
}

TEST_CASE("what cannot be certified is refused by name") {
  const auto refused = [](void (*spoil)(CertifiedLimiter<>::Config&)) {
    CertifiedLimiter<>::Config config = bench_motor();
    spoil(config);
    const ConfigError error = config.validate();
    CertifiedLimiter<> limiter(config);
    CHECK(limiter.step({255, 13.0f, 25.0f}, 0.1f).power == 1);
    CHECK(limiter.step({255, 13.0f, 25.0f}, 0.1f).reason == LimitReason::config_invalid);
    return error;
  };
  CHECK(bench_motor().validate() == ConfigError::none);
  CHECK(is_error(CertifiedLimiter<>::Config::standard().validate()));
  CHECK(refused([](CertifiedLimiter<>::Config& c) {
          c.network.winding_heat_capacity_J_per_K.lowest = 0.0f;
        }) == ConfigError::winding_heat_capacity_J_per_K);
  CHECK(refused([](CertifiedLimiter<>::Config& c) { c.network.body_heat_capacity_J_per_K.highest = 1.0f; }) ==
        ConfigError::body_heat_capacity_J_per_K);
  CHECK(refused([](CertifiedLimiter<>::Config& c) { c.network.least_coupling_W_per_K = 0.0f; }) ==
        ConfigError::coupling_W_per_K);
  CHECK(refused([](CertifiedLimiter<>::Config& c) { c.network.least_conductance_W_per_K = -1.0f; }) ==
        ConfigError::conductance_W_per_K);
  CHECK(refused([](CertifiedLimiter<>::Config& c) { c.use.highest_air_C = 60.0f; }) ==
        ConfigError::highest_air_C);
  CHECK(refused([](CertifiedLimiter<>::Config& c) { c.use.heat.heat_when_hot_W = 1000.0f; }) ==
        ConfigError::heat_when_hot_W);
  CHECK(refused([](CertifiedLimiter<>::Config& c) { c.use.heat.heat_when_cold_W = 1e6f; }) ==
        ConfigError::heat_when_cold_W);
  CHECK(refused([](CertifiedLimiter<>::Config& c) { c.use.hold_s = 0.0f; }) == ConfigError::hold_s);
  CHECK(refused([](CertifiedLimiter<>::Config& c) { c.use.horizon_s = 0.01f; }) == ConfigError::horizon_s);
  CHECK(refused([](CertifiedLimiter<>::Config& c) { c.network.maximum_body_C = detail::not_a_number(); }) ==
        ConfigError::maximum_body_C);
}
