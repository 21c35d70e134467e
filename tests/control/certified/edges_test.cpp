// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The certified limiter where something is missing: a start, a time, the air, a constant. In each case the bounds stay above the
// truth, which is integrated here with the constants of an actuator inside the declared bounds.

#include "../../catch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <thermopower/control/certified/limiter.hpp>
#include <thermopower/control/gimbal_controller.hpp>

using namespace thermopower;

namespace {

const float nan_ = std::numeric_limits<float>::quiet_NaN(), infinite = std::numeric_limits<float>::infinity();

HeatBounds heat(float limit_C) {
  return HeatBounds::ohmic(12.0f, 1.0f, Bounds::around(6.0f, 0.1f), {0.0038f, 0.0040f}, 20.0f, -10.0f,
                           limit_C);
}
CertifiedUse use(float limit_C) { return {heat(limit_C), 35.0f, 0.1f, 30.0f, 1, 0}; }

typedef CertifiedLimiter<CertifiedOneNode> One;
typedef CertifiedLimiter<CertifiedTwoNode> Two;
typedef CertifiedLimiter<CertifiedChain<3>> Three;
typedef CertifiedLimiter<CertifiedCoupledTwoNode> Both;

One::Config one() { return {{Bounds::around(20.0f, 0.1f), 0.18f, 60.0f}, use(60.0f), 5.0f}; }
Two::Config two() {
  return {{Bounds::around(8.0f, 0.1f), Bounds::around(80.0f, 0.1f), 0.9f, 0.18f, 110.0f, 60.0f},
          use(110.0f),
          5.0f};
}
Both::Config both() { return {{two().network, 1.1f}, use(110.0f), 5.0f}; }
Three::Config three() {
  Three::Config config = Three::Config::standard();
  config.network.nodes[0] = {Bounds::around(5.0f, 0.1f), 0.5f, 120.0f};
  config.network.nodes[1] = {Bounds::around(20.0f, 0.1f), 0.3f, 90.0f};
  config.network.nodes[2] = {Bounds::around(60.0f, 0.1f), 0.2f, 60.0f};
  config.use = use(120.0f);
  return config;
}
void set(One::Config& config) { config = one(); }
void set(Two::Config& config) { config = two(); }
void set(Three::Config& config) { config = three(); }
void set(Both::Config& config) { config = both(); }

/// The worst actuator that is declared: least capacities, couplings and resistance, in the hottest air.
struct Worst {
  double node_C[3], capacity_J[3], coupling_W[3];
  int count;
  double tempco;

  static Worst of(const One&) { return {{25.0, 0.0, 0.0}, {18.0, 1.0, 1.0}, {0.18, 0.0, 0.0}, 1, 0.0038}; }
  static Worst of(const Two&) { return {{25.0, 25.0, 0.0}, {7.2, 72.0, 1.0}, {0.9, 0.18, 0.0}, 2, 0.0038}; }
  static Worst of(const Both&) { return {{25.0, 25.0, 0.0}, {7.2, 72.0, 1.0}, {0.9, 0.18, 0.0}, 2, 0.0038}; }
  static Worst of(const Three&) {
    return {{25.0, 25.0, 25.0}, {4.5, 18.0, 54.0}, {0.5, 0.3, 0.2}, 3, 0.0038};
  }
  double supply_V = 12.0;
  double heat_W(double power) const {
    return power / 255.0 * supply_V * supply_V / 5.4 / (1.0 + tempco * (node_C[0] - 20.0));
  }
  void run(double power, double seconds, double air_C = 35.0) {
    const int parts = std::max(1, static_cast<int>(seconds / 0.001 + 0.5));
    for (int i = 0; i < parts; ++i) {
      double into_W = heat_W(power), before_C[3] = {node_C[0], node_C[1], node_C[2]};
      for (int k = 0; k < count; ++k) {
        const double out_W = coupling_W[k] * (before_C[k] - (k + 1 < count ? before_C[k + 1] : air_C));
        node_C[k] += (into_W - out_W) / capacity_J[k] * (seconds / parts);
        into_W = out_W;
      }
    }
  }
  void start(double at_C) { std::fill(node_C, node_C + 3, at_C); }
};

}  // namespace

TEST_CASE("a bound of the heat that cannot be is refused by name") {
  const auto with = [](float HeatBounds::*field, float value) {
    HeatBounds changed = heat(110.0f);
    changed.*field = value;
    return changed.validate();
  };
  REQUIRE(heat(110.0f).validate() == ConfigError::none);
  for (const float bad : {0.0f, -1.0f, nan_})
    CHECK(with(&HeatBounds::highest_supply_V, bad) == ConfigError::highest_supply_V);
  for (const float bad : {-0.01f, nan_, infinite})
    CHECK(with(&HeatBounds::supply_error, bad) == ConfigError::supply_error);
  for (const float bad : {-61.0f, 101.0f, nan_})
    CHECK(with(&HeatBounds::coldest_C, bad) == ConfigError::coldest_C);
  for (const float bad : {0.0f, -1.0f, nan_})
    CHECK(with(&HeatBounds::heat_when_cold_W, bad) == ConfigError::heat_when_cold_W);
  for (const float bad : {0.0f, -1.0f, nan_, 1000.0f})  // a copper draws most when it is cold
    CHECK(with(&HeatBounds::heat_when_hot_W, bad) == ConfigError::heat_when_hot_W);
}

TEMPLATE_TEST_CASE(
    "a limiter with a wrong constant names it, grants the least, and shows nothing that it does not know", "",
    One, Two, Three, Both) {
  typename TestType::Config good;
  set(good);
  REQUIRE(good.validate() == ConfigError::none);
  const auto refused = [&](auto spoil, ConfigError name) {
    typename TestType::Config config;
    set(config);
    spoil(config);
    CHECK(config.validate() == name);
    TestType limiter(config);
    CHECK(limiter.validate() == name);
    CHECK(limiter.step({200, 12.0f, 25.0f}, 0.1f).power == least_power());
    CHECK(limiter.cut_after(LimitReason::link_silent, 200, 0.1f).power == least_power());
    CHECK(limiter.cut_after(LimitReason::link_silent, 0, 0.1f).power ==
          0);  // nobody gets more than was asked for
    const typename TestType::State state = limiter.state();
    CHECK(std::isnan(state.winding_upper_C));
    CHECK(std::isnan(state.body_upper_C));
    CHECK(state.ceiling == least_power());
    CHECK_FALSE(state.is_certified);
  };
  typedef typename TestType::Config Config;
  // Not a kelvin below the heated node's limit.
  refused(
      [](Config& c) {
        c.use.heat.coldest_C = c.network.hottest_C() > 101.0f ? 100.5f : c.network.hottest_C();
      },
      ConfigError::coldest_C);
  refused([](Config& c) { c.use.hold_s = 10.5f; }, ConfigError::hold_s);
  for (const float bad : {nan_, infinite, 0.05f})
    refused([&](Config& c) { c.use.horizon_s = bad; }, ConfigError::horizon_s);
  refused([](Config& c) { c.use.every = 0; }, ConfigError::every);
  refused([](Config& c) { c.use.phase = 1; }, ConfigError::every);
  for (const float bad : {-1.0f, nan_})
    refused([&](Config& c) { c.air_error_K = bad; }, ConfigError::air_error_K);
}

TEST_CASE("one node whose coldest air is at its limit is refused, though either is possible") {
  One::Config config = one();
  config.use.heat.coldest_C = 59.5f;
  CHECK(config.validate() == ConfigError::coldest_C);
}

TEMPLATE_TEST_CASE("a start that is not known is one at the limits; the hotter of two is believed of both",
                   "", One, Two, Three, Both) {
  typename TestType::Config config;
  set(config);
  const TestType untold(config);
  for (const float known_C : {30.0f, nan_}) {
    TestType limiter(config);
    limiter.start(nan_, known_C);
    CHECK(limiter.winding_upper_C() == Approx(untold.winding_upper_C()).margin(0.01));
    limiter.start(known_C, nan_);
    CHECK(limiter.body_upper_C() == Approx(untold.body_upper_C()).margin(0.01));
    CHECK(limiter.step({255, 12.0f, 25.0f}, 0.0f).power < 255);
  }
  TestType limiter(config);
  limiter.start(40.0f, 55.0f);  // a body that is hotter than the winding warms it
  CHECK(limiter.winding_upper_C() >= 55.0f);
  CHECK(limiter.body_upper_C() >= 55.0f);
  limiter.start(55.0f, 40.0f);
  CHECK(limiter.winding_upper_C() >= 55.0f);
}

TEMPLATE_TEST_CASE("air that is said to be colder than the coldest counts as the coldest", "", One, Two,
                   Three, Both) {
  typename TestType::Config config;
  set(config);
  TestType told(config), at_coldest(config);
  told.start(40.0f, 40.0f);
  at_coldest.start(40.0f, 40.0f);
  for (int i = 0; i < 6000; ++i) {
    const int absurd = told.step({255, 12.0f, -200.0f}, 0.1f).power;
    CHECK(absurd == at_coldest.step({255, 12.0f, -10.0f - 5.0f - 1.0f}, 0.1f).power);
  }
}

TEMPLATE_TEST_CASE(
    "cuts of an unknown time, late steps and late cuts: the bounds stay above the worst actuator", "", One,
    Two, Three, Both) {
  typename TestType::Config config;
  set(config);
  config.use.every = GENERATE(std::uint8_t(1), std::uint8_t(4));  // a plan in each step, or in one of four
  config.use.hold_s = 0.1f * static_cast<float>(config.use.every);
  TestType limiter(config);
  CHECK(limiter.hold_s() == config.use.hold_s);
  Worst truth = Worst::of(limiter);
  truth.start(30.0);
  limiter.start(30.0f, 30.0f);
  std::uint32_t random = 7;
  int cuts = 0, late = 0;
  const float late_s = 2.5f * config.use.hold_s;
  double closest_K = 1e9;
  for (int i = 0; i < 3000; ++i) {
    random = random * 1664525u + 1013904223u;
    const unsigned what = (random >> 24) % 8u;
    const float dt_s = what == 7 ? late_s : 0.1f;
    const LimitedPower granted = what == 0   ? limiter.cut(LimitReason::link_silent)
                                 : what == 1 ? limiter.cut_after(LimitReason::link_silent, 255, nan_)
                                 : what == 2 ? limiter.cut_after(LimitReason::link_silent, 255, -1.0f)
                                             : limiter.step({255, 12.0f, 35.0f}, dt_s);
    const std::size_t last = static_cast<std::size_t>(truth.count - 1);
    if (what < 3 || config.use.every == 1) {  // what this call was told of is in the bounds now
      REQUIRE(static_cast<double>(limiter.winding_upper_C()) >= truth.node_C[0]);
      REQUIRE(static_cast<double>(limiter.body_upper_C()) >= truth.node_C[last]);
    }
    cuts += what < 3;
    late += what == 7;
    // What is granted acts until the next call: at most a hold, but where that will be late.
    const unsigned next = ((random * 1664525u + 1013904223u) >> 24) % 8u;
    truth.run(granted.power, next == 7 ? static_cast<double>(late_s) : 0.1);
    TestType seen = limiter;  // what it would say after the time that has passed
    seen.cut_after(LimitReason::link_silent, 1, next == 7 ? late_s : 0.1f);
    closest_K = std::min(closest_K, static_cast<double>(seen.winding_upper_C()) - truth.node_C[0]);
    REQUIRE(static_cast<double>(seen.winding_upper_C()) >= truth.node_C[0]);
    REQUIRE(static_cast<double>(seen.body_upper_C()) >= truth.node_C[last]);
  }
  CHECK(cuts > 500);
  CHECK(late > 200);
  CHECK(limiter.state().late_steps > 200);
  CHECK(closest_K < 30.0);  // and not by being absurdly high
}

TEMPLATE_TEST_CASE("one cut of an unknown time counts a whole hold of the power before it, from cold", "",
                   One, Two, Three, Both) {
  typename TestType::Config config;
  set(config);
  TestType limiter(config);
  Worst truth = Worst::of(limiter);
  truth.start(30.0);
  limiter.start(30.0f, 30.0f, 30.0f);
  double warmest_K = 0.0;
  for (int i = 0; i < 200; ++i) {
    const LimitedPower granted = limiter.step({255, 12.0f, 30.0f}, 0.0f);
    truth.run(granted.power, 0.1, 35.0);
    limiter.cut(LimitReason::link_silent);
    REQUIRE(static_cast<double>(limiter.winding_upper_C()) >= truth.node_C[0]);
    warmest_K = std::max(warmest_K, truth.node_C[0] - 30.0);
  }
  CHECK(warmest_K > 10.0);
}

TEMPLATE_TEST_CASE("the time to the limit is never longer than the worst actuator takes", "", One, Two, Three,
                   Both) {
  typename TestType::Config config;
  set(config);
  TestType limiter(config);
  // For ever what is sustainable bears.
  limiter.start(30.0f, 30.0f);
  limiter.step({1, 12.0f, 35.0f}, 0.0f);
  CHECK(std::isinf(limiter.state().seconds_to_limit));
  // More than that is granted to a cold actuator, for as long as it says.
  const LimitedPower granted = limiter.step({255, 12.0f, 35.0f}, 0.1f);
  REQUIRE(granted.power > limiter.state().sustainable);
  const double claimed_s = static_cast<double>(limiter.state().seconds_to_limit);
  REQUIRE(std::isfinite(claimed_s));
  Worst truth = Worst::of(limiter);
  truth.start(30.0);
  double taken_s = 0.0;
  const double limits_C[3][3] = {{60.0, 0.0, 0.0}, {110.0, 60.0, 0.0}, {120.0, 90.0, 60.0}};
  const auto is_below = [&] {
    for (int k = 0; k < truth.count; ++k)
      if (truth.node_C[k] >= limits_C[truth.count - 1][k]) return false;
    return true;
  };
  for (; is_below() && taken_s < 1e4; taken_s += 0.05) truth.run(granted.power, 0.05);
  CHECK(claimed_s <= taken_s + 0.05);
  CHECK(claimed_s > 0.1);
  // At its limit there is none left.
  limiter.start(300.0f, 300.0f);
  CHECK(limiter.state().seconds_to_limit == 0.0f);
  CHECK_FALSE(limiter.state().is_certified);
}

TEMPLATE_TEST_CASE(
    "a supply that is measured low is granted more power, and the bounds stay above the worst actuator", "",
    One, Two, Three, Both) {
  typename TestType::Config config;
  set(config);
  config.use.heat.supply_error = 0.02f;
  config.use.heat.lowest_supply_V = 5.0f;
  TestType measured(config), unknown(config);
  Worst truth = Worst::of(measured);
  truth.supply_V = 6.0 * 1.02;  // of a reading of 6 V
  truth.start(30.0);
  measured.start(30.0f, 30.0f);
  unknown.start(30.0f, 30.0f);
  long granted = 0, granted_blind = 0;
  for (int i = 0; i < 20000; ++i) {
    const int power = measured.step({255, 6.0f, 35.0f}, 0.1f).power;
    granted += power;
    granted_blind += unknown.step({255, nan_, 35.0f}, 0.1f).power;
    truth.run(power, 0.1);
    REQUIRE(static_cast<double>(measured.winding_upper_C()) >=
            truth.node_C[0] - 0.1 * truth.heat_W(power) / truth.capacity_J[0]);
  }
  const double limits_C[3] = {60.0, 110.0, 120.0};
  CHECK(truth.node_C[0] <= limits_C[truth.count - 1]);
  CHECK(truth.node_C[truth.count - 1] <= 60.0);
  // A quarter of the heat for each count: two to four times the power.
  CHECK(granted > 2 * granted_blind);
}

TEST_CASE("a power that acted besides the one granted is carried as heat, the largest of several") {
  Two limiter(two()), same(two()), other(two());
  limiter.start(30.0f, 30.0f);
  same.start(30.0f, 30.0f);
  other.start(30.0f, 30.0f);
  for (int i = 0; i < 50; ++i) {
    limiter.acted(200);
    limiter.acted(100);  // the smaller one adds nothing
    same.acted(200);
    other.acted(0);  // as the least
    for (Two* each : {&limiter, &same, &other}) each->step({1, 12.0f, 30.0f}, 0.1f);
  }
  CHECK(limiter.winding_upper_C() == same.winding_upper_C());
  CHECK(limiter.winding_upper_C() > other.winding_upper_C() + 5.0f);
}

TEST_CASE("as many steps between two plans as a byte counts lose no time") {
  Two::Config config = two();
  config.use.every = 255;
  config.use.hold_s = 10.0f;
  Two often(config);
  config.use.every = 1;
  Two once(config);
  often.start(50.0f, 50.0f);
  once.start(50.0f, 50.0f);
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 250; ++k) often.step({1, 12.0f, 35.0f}, 0.04f);
    once.step({1, 12.0f, 35.0f}, 10.0f);
  }
  often.cut_after(LimitReason::link_silent, 1, 0.0f);
  once.cut_after(LimitReason::link_silent, 1, 0.0f);
  CHECK(often.winding_upper_C() == Approx(once.winding_upper_C()).margin(0.5));
}

TEST_CASE("the count of late steps stops at its largest instead of starting again") {
  One limiter(one());
  for (long i = 0; i < 65600L; ++i) limiter.step({1, 12.0f, 30.0f}, 0.2f);
  CHECK(limiter.state().late_steps == 65535u);
}

TEST_CASE("numbers too large for the arithmetic end at its ends, on the safe side") {
  CHECK(detail::rounded_down(1.0e12f) == 0x7fffffffL);
  CHECK(detail::rounded_up(1.0e12f) == 0x7fffffffL);
  CHECK(detail::rounded_down(-1.0f) == 0);
  CHECK(detail::fraction_down(1.5f) == detail::whole_fraction());
  CHECK(detail::fraction_up(1.5f) == detail::whole_fraction());
  CHECK(detail::fraction_down(0.5f) <= detail::fraction_up(0.5f));
}

TEST_CASE("a bound is raised to the higher of two, also where they differ in what no unit shows") {
  detail::UpperBound low, high;
  low.set(1000);
  high.set(1000);
  high.advance(1, 0x80000000u);  // half a unit
  REQUIRE(low.below() == high.below());
  detail::UpperBound raised = low;
  raised.raise(high);
  raised.advance(1, 0x80000000u);  // the other half: one unit more, which shows that the first was kept
  CHECK(raised.below() == 1001);
  detail::UpperBound kept = high;
  kept.raise(low);
  kept.advance(1, 0x80000000u);
  CHECK(kept.below() == 1001);
}

TEST_CASE("a measurement is kept to 1/64 K and never below what was told; what is none changes nothing") {
  const detail::KelvinUnits known = detail::celsius_units(600.0f);
  for (float told_C = -100.0f; told_C <= 500.0f; told_C += 0.0137f) {
    CAPTURE(told_C);
    const CertifiedMeasurement measured(told_C, nan_);
    REQUIRE(measured.is_any());
    REQUIRE(measured.winding(known) >= static_cast<double>(told_C) * 262144.0);
    REQUIRE(measured.winding(known) <= (static_cast<double>(told_C) + 1.0 / 32.0) * 262144.0);
    REQUIRE(measured.body(known) == known);
    REQUIRE(measured.winding(-200 * 262144) == -200 * 262144);
    REQUIRE(CertifiedMeasurement(nan_, told_C).body(known) == measured.winding(known));
  }
  for (const float none_C : {nan_, infinite, -infinite, -100.01f, 500.01f, 1e9f})
    CHECK_FALSE(CertifiedMeasurement(none_C, none_C).is_any());
  CHECK_FALSE(CertifiedMeasurement().is_any());
}

TEST_CASE("the heat of a warm winding is never taken below Ohm's law, nor far above it") {
  for (const float end_C : {40.0f, 60.3f, 110.0f, 200.0f})
    for (const float coldest_C : {-40.0f, -10.3f, 0.0f, 20.0f}) {
      CAPTURE(end_C, coldest_C);
      const HeatBounds heat =
          HeatBounds::ohmic(12.0f, 1.0f, {6.0f, 6.0f}, {0.0039f, 0.0039f}, 20.0f, coldest_C, 200.0f);
      CertifiedRelief relief;
      relief.set(heat, 200.0f, end_C);
      const auto ratio = [&](double T) { return 1.0 + 0.0039 * (T - 20.0); };
      for (double T = static_cast<double>(coldest_C); T <= 250.0; T += 0.173) {
        // Of the whole, which stands for 1 + 2^-15 of it; above its end the relief stays.
        const double truth =
            ratio(static_cast<double>(coldest_C)) / ratio(std::min(T, static_cast<double>(end_C)));
        const double taken = static_cast<double>(relief.at(static_cast<detail::KelvinUnits>(
                                 (T - static_cast<double>(coldest_C)) * 262144.0))) /
                             65536.0 * static_cast<double>(detail::whole_margin());
        REQUIRE(taken >= truth);
        if (T > static_cast<double>(end_C)) REQUIRE(taken < truth + 2e-4);
      }
    }
}
