// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Several limiters over one actuator, and limiters of either kind of step().

#include "../catch.hpp"
#include "limiter_inputs.hpp"

#include <cmath>
#include <cstdint>

#include <thermopower/actuator/ohmic_current.hpp>
#include <thermopower/actuator/current_model.hpp>
#include <thermopower/actuator/two_node_thermal_model.hpp>
#include <thermopower/control/axis_controller.hpp>
#include <thermopower/control/certified/limiter.hpp>
#include <thermopower/control/limiter_chain.hpp>
#include <thermopower/control/node_limiter.hpp>

using namespace thermopower;

namespace {

const float not_known = detail::not_a_number();

/// Grants what it is told to, whatever it is asked.
template <int number>
struct Puppet {
  struct Config {
    uint8_t ceiling;
    LimitReason reason;
    static Config standard() { return {255, LimitReason::none}; }
    ConfigError validate() const { return ceiling == 0 ? ConfigError::user_defined : ConfigError::none; }
  };
  explicit Puppet(const Config& config) : config_(config) {}
  LimitedPower step(const AxisFacts& facts, float) noexcept {
    asked = facts.demand;
    if (facts.demand <= config_.ceiling && !is_fault(config_.reason))
      return {facts.demand, LimitReason::none};
    return {config_.ceiling < facts.demand ? config_.ceiling : facts.demand, config_.reason};
  }
  LimitedPower cut(LimitReason, uint8_t = 255) noexcept {
    ++cuts;
    return {1, LimitReason::none};
  }
  uint8_t ceiling() const noexcept { return config_.ceiling; }
  Config config_;
  uint8_t asked = 0;
  int cuts = 0;
};

typedef LimiterChain<Puppet<0>, Puppet<1>, Puppet<2>> Three;

Three three(Puppet<0>::Config first, Puppet<1>::Config second, Puppet<2>::Config third) {
  return Three(Three::Config{first, {second, {third}}});
}

AxisFacts at(float motor_C, uint8_t demand = 255) {
  AxisFacts facts = AxisFacts::unknown();
  facts.demand = demand;
  facts.motor_C = facts.body_C = told::degrees(motor_C);
  facts.rate_K_per_s = 0.0f;
  facts.air_C = 25.0f;
  facts.supply_V = 13.0f;
  return facts;
}

}  // namespace

TEST_CASE("the strictest limiter of a chain wins in every order, and its reason is kept") {
  const LimitReason reasons[] = {LimitReason::winding_limit, LimitReason::body_limit,
                                 LimitReason::node_limit};
  const uint8_t ceilings[] = {40, 90, 200};
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) {
      if (a == b) continue;
      const int c = 3 - a - b;
      Three chain = three({ceilings[a], reasons[a]}, {ceilings[b], reasons[b]}, {ceilings[c], reasons[c]});
      for (int demand = 1; demand <= 255; ++demand) {
        const LimitedPower granted = chain.step(at(30.0f, static_cast<uint8_t>(demand)), 0.01f);
        CHECK(granted.power == (demand < 40 ? demand : 40));
        CHECK(granted.reason == (demand <= 40 ? LimitReason::none : LimitReason::winding_limit));
      }
      CHECK(chain.ceiling() == 40);
    }
}

TEST_CASE("of two limiters that grant the same the first is named; a fault always") {
  Three same = three({40, LimitReason::body_limit}, {40, LimitReason::node_limit}, {255, LimitReason::none});
  CHECK(same.step(at(30.0f), 0.01f).reason == LimitReason::body_limit);
  Three broken =
      three({1, LimitReason::body_limit}, {1, LimitReason::temperature_not_finite}, {255, LimitReason::none});
  CHECK(broken.step(at(30.0f), 0.01f).reason == LimitReason::temperature_not_finite);
  CHECK(broken.step(at(30.0f), 0.01f).power == 1);
  // Each is asked with what those before it left.
  Three asked =
      three({100, LimitReason::body_limit}, {60, LimitReason::node_limit}, {255, LimitReason::none});
  asked.step(at(30.0f), 0.01f);
  CHECK(asked.limiter<0>().asked == 255);
  CHECK(asked.limiter<1>().asked == 100);
  CHECK(asked.limiter<2>().asked == 60);
}

TEST_CASE("a fault found elsewhere cuts every limiter of a chain, with a time or without") {
  Three chain =
      three({100, LimitReason::body_limit}, {60, LimitReason::node_limit}, {255, LimitReason::none});
  CHECK(chain.cut(LimitReason::link_silent).power == 1);
  CHECK(chain.cut_after(LimitReason::link_silent, 0, 0.1f).power == 0);
  CHECK(chain.cut_after(LimitReason::link_silent, 9, 0.1f).reason == LimitReason::link_silent);
  CHECK(chain.limiter<0>().cuts == 3);
  CHECK(chain.limiter<1>().cuts == 3);
  CHECK(chain.limiter<2>().cuts == 3);
}

TEST_CASE("every limiter of a chain is told what acted, and the shortest time vouched for is the chain's") {
  struct Accountant : Puppet<0> {
    explicit Accountant(const Config& config) : Puppet<0>(config) {}
    void acted(uint8_t power) noexcept { told = power; }
    float hold_s() const noexcept { return 0.2f; }
    int told = -1;
  };
  struct Hasty : Accountant {
    explicit Hasty(const Config& config) : Accountant(config) {}
    float hold_s() const noexcept { return 0.05f; }
  };
  typedef LimiterChain<Puppet<1>, Hasty, Puppet<2>, Accountant> Chain;
  Chain chain;
  chain.acted(77);
  CHECK(chain.limiter<1>().told == 77);
  CHECK(chain.limiter<3>().told == 77);
  CHECK(chain.hold_s() == 0.05f);
  // As the controllers ask.
  detail::tell_acted(chain, 78, 0);
  CHECK(chain.limiter<1>().told == 78);
  CHECK(detail::hold_of(chain, 0) == 0.05f);
  Three none = three({255, LimitReason::none}, {255, LimitReason::none}, {255, LimitReason::none});
  none.acted(9);
  CHECK(std::isinf(none.hold_s()));
}

TEST_CASE(
    "a certified limiter in a chain stays above a motor whose board drives it with more than it was told") {
  struct Motor {
    typedef CurrentModel<OhmicCurrent<float>> Current;
    typedef TwoNodeThermalModel<float> Thermal;
    static Current::Config current() { return {8.0f, 0.0039f, 20.0f}; }
    static SupplyRange supply() { return {1.0f, 30.0f}; }
    static Thermal::Config thermal() { return {8.0f, 80.0f, 1.0f, {0.2f}}; }
  };
  typedef LimiterChain<CertifiedLimiter<>, NodeLimiter> Chain;
  typedef AxisController<Motor, StepPowerLaw<>, Chain, NoGain> Axis;
  Axis::Config config = Axis::Config::standard();
  auto& certified = config.limiter.first;
  certified.network = CertifiedTwoNode::Config::around(Motor::thermal(), 0.1f, 110.0f, 60.0f);
  certified.use.heat = HeatBounds::ohmic(13.0f, 0.02f, Bounds::around(8.0f, 0.03f), {0.0038f, 0.004f}, 20.0f,
                                         0.0f, 110.0f, 5.0f);
  certified.use.highest_air_C = 35.0f;
  REQUIRE(config.validate() == ConfigError::none);
  Axis axis(config);
  axis.start(25.0f);
  axis.limiter().limiter<0>().start(25.0f, 25.0f);
  double body_C = 25.0, winding_C = 25.0;  // a plant of its own, always at full power
  for (int i = 0; i < 3000; ++i) {
    axis.heated_by(255);
    axis.step({0.0f, 13.0f, 25.0f, LimitReason::none}, 0.02f);
    CHECK(winding_C <= static_cast<double>(axis.limiter().limiter<0>().winding_upper_C()) + 1e-3);
    const double heat_W = 13.0 * 13.0 / (8.0 * (1.0 + 0.0039 * (winding_C - 20.0)));
    const double across_W = 1.0 * (winding_C - body_C);
    winding_C += 0.02 * (heat_W - across_W) / 8.0;
    body_C += 0.02 * (across_W - 0.2 * (body_C - 25.0)) / 80.0;
  }
  CHECK(winding_C > 45.0);  // or nothing was asked
}

TEST_CASE("a wrong field anywhere in a chain is named and keeps the power at its least") {
  Three chain = three({100, LimitReason::none}, {0, LimitReason::none}, {255, LimitReason::none});
  CHECK(chain.validate() == ConfigError::user_defined);
  CHECK(chain.step(at(30.0f), 0.01f).power == 1);
  CHECK(chain.step(at(30.0f), 0.01f).reason == LimitReason::config_invalid);
}

TEST_CASE("what is not a number counts as hot for the whole chain") {
  typedef LimiterChain<SafetyLimiter<>, NodeLimiter> Chain;
  for (const float bad : {not_known, -300.0f, static_cast<float>(INFINITY), -static_cast<float>(INFINITY)}) {
    Chain chain;
    REQUIRE(chain.validate() == ConfigError::none);
    CHECK(chain.step(at(30.0f), 0.01f).power == 255);
    AxisFacts facts = at(30.0f);
    facts.motor_C = told::degrees(bad);
    CHECK(chain.step(facts, 0.01f).power == 1);
    CHECK(is_fault(chain.step(facts, 0.01f).reason));
    facts = at(30.0f);
    facts.body_C = told::degrees(bad);  // the second limiter's alone
    CHECK(chain.step(facts, 0.01f).power == 1);
    CHECK(is_fault(chain.step(facts, 0.01f).reason));
    CHECK(chain.step(at(30.0f), bad < 0.0f || bad != bad || bad > 1e30f ? bad : -1.0f).power == 1);
  }
}

TEST_CASE(
    "a chain on an axis holds the limits of each: a hotter motor never gets more than each alone grants") {
  struct Motor {
    typedef CurrentModel<OhmicCurrent<float>> Current;
    typedef TwoNodeThermalModel<float> Thermal;
    static Current::Config current() { return {8.0f, 0.0039f, 20.0f}; }
    static SupplyRange supply() { return {1.0f, 30.0f}; }
    static Thermal::Config thermal() { return {8.0f, 80.0f, 1.0f, {0.2f}}; }
  };
  typedef LimiterChain<NodeLimiter, CertifiedLimiter<>> Chain;
  typedef AxisController<Motor, StepPowerLaw<>, Chain, NoGain> Axis;
  Axis::Config config = Axis::Config::standard();
  auto& certified = config.limiter.rest.first;
  certified.network = CertifiedTwoNode::Config::around(Motor::thermal(), 0.1f, 110.0f, 60.0f);
  certified.use.heat = HeatBounds::ohmic(13.0f, 0.02f, Bounds::around(8.0f, 0.03f), {0.0038f, 0.004f}, 20.0f,
                                         0.0f, 110.0f, 5.0f);
  certified.use.highest_air_C = 35.0f;
  REQUIRE(config.validate() == ConfigError::none);
  Axis axis(config);
  axis.start(25.0f);
  axis.limiter().limiter<1>().start(25.0f, 25.0f);
  bool by_node = false, by_proof = false;
  double body_C = 25.0, winding_C = 25.0;  // a plant of its own
  for (int i = 0; i < 400000; ++i) {
    const Axis::State& state = axis.step({5.0f, 13.0f, 25.0f, LimitReason::none}, 0.02f);
    by_node = by_node || state.reason == LimitReason::node_limit;
    by_proof =
        by_proof || state.reason == LimitReason::body_limit || state.reason == LimitReason::winding_limit;
    const double heat_W = 13.0 * 13.0 * state.power / 255.0 / (8.0 * (1.0 + 0.0039 * (winding_C - 20.0)));
    const double across_W = 1.0 * (winding_C - body_C);
    winding_C += 0.02 * (heat_W - across_W) / 8.0;
    body_C += 0.02 * (across_W - 0.2 * (body_C - 25.0)) / 80.0;
    REQUIRE(body_C < 60.0);
    REQUIRE(winding_C < 110.0);
    REQUIRE(body_C <= static_cast<double>(axis.limiter().limiter<1>().body_upper_C()) + 1e-3);
    CHECK(state.power <= axis.limiter().limiter<0>().ceiling());
  }
  CHECK((by_node || by_proof));
  CHECK(body_C > 45.0);
}

TEST_CASE("a limiter that grants more than it was asked for raises nothing, whatever its reason") {
  struct Generous : Puppet<0> {
    explicit Generous(const Config& config) : Puppet<0>(config) {}
    LimitedPower step(const AxisFacts&, float) noexcept { return {255, LimitReason::temperature_not_finite}; }
  };
  LimiterChain<Puppet<1>, Generous> chain({{60, LimitReason::body_limit}, {{255, LimitReason::none}}});
  const LimitedPower granted = chain.step(at(30.0f), 0.01f);
  CHECK(granted.power == 60);
  CHECK(granted.reason == LimitReason::temperature_not_finite);
}

TEST_CASE("a chain in which nobody limits grants all, and one of a single limiter is that limiter") {
  Three open = three({255, LimitReason::none}, {255, LimitReason::none}, {255, LimitReason::none});
  CHECK(open.ceiling() == 255);
  CHECK(open.validate() == ConfigError::none);
  CHECK(open.step(at(30.0f), 0.01f).power == 255);
  CHECK(open.step(at(30.0f, 0), 0.01f).power == 0);
  CHECK(open.cut(LimitReason::link_silent).power == least_power());
  CHECK(open.cut(LimitReason::link_silent).reason == LimitReason::link_silent);
  CHECK(open.cut(LimitReason::link_silent, 0).power == 0);
  CHECK(open.cut(LimitReason::link_silent, 2).power == least_power());
  for (int wrong = 0; wrong < 3; ++wrong) {
    CAPTURE(wrong);
    const auto ceiling = [&](int place) { return static_cast<uint8_t>(place == wrong ? 0 : 255); };
    Three chain = three({ceiling(0), LimitReason::none}, {ceiling(1), LimitReason::none},
                        {ceiling(2), LimitReason::none});
    CHECK(chain.validate() == ConfigError::user_defined);
  }

  CHECK(LimiterChainConfig<>::standard().validate() == ConfigError::none);
  typedef LimiterChain<NodeLimiter> Alone;
  CHECK(Alone::Config::standard().first.derating_K == NodeLimiter::Config::standard().derating_K);
  Alone alone;
  const Three& seen = open;
  CHECK(&seen.limiter<0>() == &open.limiter<0>());
  CHECK(&seen.limiter<2>() == &open.limiter<2>());
  NodeLimiter limiter;
  for (float body_C = 30.0f; body_C < 70.0f; body_C += 0.25f) {
    AxisFacts facts = at(body_C);
    const LimitedPower granted = alone.step(facts, 0.01f),
                       own = limiter.step(NodeLimiter::read(facts), 0.01f);
    CHECK(granted.power == own.power);
    CHECK(granted.reason == own.reason);
    CHECK(alone.ceiling() == limiter.ceiling());
  }
}
