// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/control/axis_controller.hpp>

#include "motors.hpp"
#include "near.hpp"

#include <cstring>
#include <limits>
#include <random>

namespace tp = thermopower;
using tp::LimitReason;

namespace {
const float nan_ = std::numeric_limits<float>::quiet_NaN(), infinite = std::numeric_limits<float>::infinity();

template <class Motor>
using Axis = tp::AxisController<Motor>;

template <class Motor>
typename Axis<Motor>::Config config() {
  return Axis<Motor>::Config::with_gain({24.0f, 4.0f});
}

template <class Motor>
typename Axis<Motor>::Inputs inputs(float error_deg, float supply_V = 13.0f, float air_C = 25.0f,
                                    LimitReason fault = LimitReason::none) {
  return {error_deg, supply_V, air_C, fault};
}
}  // namespace

#define EVERY_MOTOR                                                                           \
  tp::motors::Bgm2606_90t, tp::motors::Bgm2606_90t::AsProgrammed, tp::motors::Bgm5208_200_12, \
      tp::motors::Bgm5208_200_12::AsProgrammed, motors_under_test::Servo,                     \
      motors_under_test::ServoWithWinding

TEMPLATE_TEST_CASE("until the first step the power is the least there is", "", EVERY_MOTOR) {
  const Axis<TestType> axis(config<TestType>());
  CHECK(axis.validate() == tp::ConfigError::none);
  CHECK(axis.state().power == tp::least_power());
  CHECK(axis.state().reason == LimitReason::no_telemetry_yet);
  CHECK(axis.state().p_gain == 24);
  CHECK(std::isnan(axis.state().motor_C));
}

TEMPLATE_TEST_CASE("the first valid step starts the motor at air temperature, section 4.2", "", EVERY_MOTOR) {
  Axis<TestType> axis(config<TestType>());
  const auto& state = axis.step(inputs<TestType>(0.5f, 13.0f, 21.0f), 0.0f);
  CHECK(state.motor_C == 21.0f);
  CHECK(state.demand == 125);
  CHECK(state.power == 125);
  CHECK(state.reason == LimitReason::none);
}

TEMPLATE_TEST_CASE("the estimate is the motor's models at the power of the step before", "", EVERY_MOTOR) {
  Axis<TestType> axis(config<TestType>());
  const typename TestType::Current current(TestType::current());
  typename TestType::Thermal thermal(TestType::thermal(), 25.0f);
  uint8_t power = tp::least_power();
  for (int i = 0; i < 2000; ++i) {
    const float error_deg = static_cast<float>(i % 30) * 0.04f;
    const auto drawn = current.at_power(static_cast<float>(power), 13.0f, thermal.hottest_C());
    thermal.step({drawn.winding_power_W, drawn.v_rms_V, {25.0f, 0.0f}}, 0.03f);
    const auto& state = axis.step(inputs<TestType>(error_deg), 0.03f);
    REQUIRE(state.motor_C == thermal.hottest_C());
    REQUIRE(state.rate_K_per_s == thermal.hottest_rate_K_per_s());
    REQUIRE(state.power_W == drawn.winding_power_W);
    REQUIRE(state.current_A == drawn.current_A);
    REQUIRE(state.v_rms_V == drawn.v_rms_V);
    power = state.power;
  }
}

TEMPLATE_TEST_CASE("a motor that is driven without end stays below its limit", "[law]",
                   tp::motors::Bgm2606_90t, tp::motors::Bgm2606_90t::AsProgrammed, tp::motors::Bgm5208_200_12,
                   motors_under_test::Servo, motors_under_test::ServoWithWinding) {
  Axis<TestType> axis(config<TestType>());
  float hottest_C = 0.0f;
  bool was_limited = false;
  for (int i = 0; i < 60 * 60 * 33; ++i) {
    const auto& state = axis.step(inputs<TestType>(30.0f), 0.03f);
    hottest_C = std::max(hottest_C, state.motor_C);
    was_limited = was_limited || state.reason == LimitReason::safety_temperature;
  }
  CHECK(was_limited);
  CHECK(hottest_C > 55.0f);
  CHECK(hottest_C < 60.05f);
}

TEST_CASE("as programmed, the 5208's estimate never comes near the limit it is to keep", "[law]") {
  Axis<tp::motors::Bgm5208_200_12::AsProgrammed> programmed(
      config<tp::motors::Bgm5208_200_12::AsProgrammed>());
  const tp::CurrentModel<tp::ThesisCurrent<float> > current(tp::motors::Bgm5208_200_12::current());
  tp::motors::Bgm5208_200_12::Thermal motor(tp::motors::Bgm5208_200_12::thermal(), 25.0f);
  for (int i = 0; i < 60 * 60 * 33; ++i) {
    const float power = static_cast<float>(
        programmed.step(inputs<tp::motors::Bgm5208_200_12::AsProgrammed>(30.0f), 0.03f).power);
    const auto drawn = current.at_power(power, 13.0f, motor.hottest_C());
    motor.step({drawn.winding_power_W, drawn.v_rms_V, {25.0f, 0.0f}}, 0.03f);
  }
  CHECK(programmed.state().reason == LimitReason::none);
  CHECK(programmed.state().motor_C < 45.0f);
  CHECK(motor.hottest_C() > 60.0f);
}

TEMPLATE_TEST_CASE("what cannot be true gives the least power and its reason", "[bad input]", EVERY_MOTOR) {
  struct Case {
    typename Axis<TestType>::Inputs inputs;
    float dt_s;
    LimitReason reason;
  };
  std::vector<Case> cases;
  for (const float bad : {nan_, infinite, -infinite, 1.0e7f, -3e38f})
    cases.push_back({inputs<TestType>(bad), 0.03f, LimitReason::error_not_finite});
  for (const float bad : {nan_, infinite, -infinite})
    cases.push_back({inputs<TestType>(3.0f, bad), 0.03f, LimitReason::supply_not_finite});
  for (const float bad : {-0.001f, -13.0f})
    cases.push_back({inputs<TestType>(3.0f, bad), 0.03f, LimitReason::supply_low});
  for (const float bad : {nan_, infinite, -infinite, -101.0f, 201.0f, -1e30f, 1e30f})
    cases.push_back({inputs<TestType>(3.0f, 13.0f, bad), 0.03f, LimitReason::air_implausible});
  for (const float bad : {nan_, infinite, -infinite, -0.03f})
    cases.push_back({inputs<TestType>(3.0f), bad, LimitReason::time_invalid});
  for (const LimitReason fault :
       {LimitReason::link_silent, LimitReason::supply_low, LimitReason::no_telemetry_yet})
    cases.push_back({inputs<TestType>(3.0f, 13.0f, 25.0f, fault), 0.03f, fault});

  for (const Case& bad : cases) {
    Axis<TestType> axis(config<TestType>());
    for (int i = 0; i < 50; ++i) axis.step(inputs<TestType>(3.0f), 0.03f);
    REQUIRE(axis.state().power > 200);
    const float before_C = axis.state().motor_C;
    const auto& state = axis.step(bad.inputs, bad.dt_s);
    CAPTURE(static_cast<int>(bad.reason), bad.inputs.error_deg, bad.inputs.supply_V, bad.inputs.air_C,
            bad.dt_s);
    CHECK(state.power == tp::least_power());
    CHECK(state.reason == bad.reason);
    CHECK(tp::is_fault(state.reason));
    CHECK(std::isfinite(state.motor_C));
    CHECK(state.motor_C >= before_C - 0.1f);
    // And it is over when the input is right again: the power comes back gradually.
    CHECK(axis.step(inputs<TestType>(3.0f), 0.03f).reason == LimitReason::recovering);
    CHECK(axis.state().power < 5);
    for (int i = 0; i < 100; ++i) axis.step(inputs<TestType>(0.3f), 0.03f);
    CHECK(axis.state().reason == LimitReason::none);
  }
}

TEMPLATE_TEST_CASE(
    "a fault in the first step keeps the least power, and the motor unstarted only without air",
    "[bad input]", EVERY_MOTOR) {
  Axis<TestType> no_air(config<TestType>()), no_error(config<TestType>());
  CHECK(no_air.step(inputs<TestType>(3.0f, 13.0f, nan_), 0.03f).reason == LimitReason::air_implausible);
  CHECK(std::isnan(no_air.state().motor_C));
  CHECK(no_air.state().power == tp::least_power());
  CHECK(no_air.step(inputs<TestType>(3.0f, 13.0f, 30.0f), 0.0f).motor_C == 30.0f);
  CHECK(no_error.step(inputs<TestType>(nan_), 0.03f).reason == LimitReason::error_not_finite);
  CHECK(no_error.state().motor_C == Near(25.0).margin(0.01));
}

TEMPLATE_TEST_CASE("through a fault the motor's temperature goes on with the last air that was known", "",
                   EVERY_MOTOR) {
  Axis<TestType> healthy(config<TestType>()), deaf(config<TestType>());
  for (int i = 0; i < 6000; ++i) {
    healthy.step(inputs<TestType>(3.0f), 0.03f);
    deaf.step(inputs<TestType>(3.0f), 0.03f);
  }
  const float hot_C = deaf.state().motor_C;
  REQUIRE(hot_C > 27.0f);
  for (int i = 0; i < 2000; ++i) {
    healthy.step(inputs<TestType>(0.0f, 13.0f, 25.0f, LimitReason::link_silent), 0.03f);
    deaf.step(inputs<TestType>(nan_, nan_, nan_), 0.03f);
    // Its supply is not known any more: in the first of these steps the highest heats, for 30 ms.
    REQUIRE(deaf.state().motor_C >= healthy.state().motor_C);
    REQUIRE(deaf.state().motor_C < healthy.state().motor_C + 2.0f);
  }
  CHECK(deaf.state().motor_C < hot_C);
  CHECK(deaf.state().motor_C > 25.0f);
}

TEST_CASE("a configuration that was refused never moves the motor, and names the first wrong field") {
  typedef Axis<tp::motors::Bgm2606_90t> Roll;
  using tp::ConfigError;
  struct Case {
    void (*spoil)(Roll::Config&);
    ConfigError field;
  };
  const Case cases[] = {
      {[](Roll::Config& c) { c.current.base_A = 0.0f; }, ConfigError::base_A},
      {[](Roll::Config& c) { c.thermal.heating.slope_V0_J_per_K2 = nan_; }, ConfigError::heating_J_per_K},
      {[](Roll::Config& c) { c.thermal.cooling.cooling_per_s = -1.0f; }, ConfigError::cooling_per_s},
      {[](Roll::Config& c) { c.power_law.full_power_error_deg = 0.0f; }, ConfigError::full_power_error_deg},
      {[](Roll::Config& c) { c.power_law.power_step = 0; }, ConfigError::power_step},
      {[](Roll::Config& c) { c.limiter.maximum_C = nan_; }, ConfigError::maximum_C},
      {[](Roll::Config& c) { c.limiter.safety_time_s = 0.0f; }, ConfigError::safety_time_s},
      {[](Roll::Config& c) { c.gain.gain_high_power = 300.0f; }, ConfigError::gain_high_power},
      {[](Roll::Config& c) { c.current.base_A = nan_, c.limiter.maximum_C = nan_; }, ConfigError::base_A},
  };
  for (const Case& bad : cases) {
    Roll::Config wrong = config<tp::motors::Bgm2606_90t>();
    bad.spoil(wrong);
    Roll axis(wrong);
    CAPTURE(static_cast<int>(bad.field));
    CHECK(wrong.validate() == bad.field);
    CHECK(axis.validate() == bad.field);
    for (int i = 0; i < 20; ++i) {
      const auto& state = axis.step(inputs<tp::motors::Bgm2606_90t>(3.0f), 0.03f);
      REQUIRE(state.power <= tp::least_power());
      REQUIRE(state.reason == LimitReason::config_invalid);
    }
  }
  // The gains are nobody's default: forgetting them is an error that names them.
  CHECK(Roll().validate() == ConfigError::gain_low_power);
}

TEST_CASE("a start temperature that is known replaces the air's") {
  Axis<motors_under_test::Servo> axis(config<motors_under_test::Servo>());
  axis.start(55.0f);
  CHECK(axis.state().motor_C == 55.0f);
  axis.step(inputs<motors_under_test::Servo>(0.0f), 0.03f);
  CHECK(axis.state().motor_C == Near(55.0).epsilon(1e-3));
  axis.start(nan_);
  axis.step(inputs<motors_under_test::Servo>(0.0f), 0.0f);
  CHECK(axis.state().motor_C == 25.0f);
}

TEMPLATE_TEST_CASE("no bit pattern in any input gives more than the demand, and every fault gives the least",
                   "[bad input]", EVERY_MOTOR) {
  std::mt19937 random(9);
  const auto any_float = [&random](float usual) {
    if (random() % 3 != 0) return usual;
    const uint32_t bits = static_cast<uint32_t>(random());
    float value;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  };
  Axis<TestType> axis(config<TestType>());
  for (int i = 0; i < 100000; ++i) {
    const auto given = inputs<TestType>(any_float(3.0f), any_float(13.0f), any_float(25.0f));
    const float dt_s = any_float(0.03f);
    const auto& state = axis.step(given, dt_s);
    const bool is_good = std::abs(given.error_deg) < 1e6f && given.supply_V >= 0.0f &&
                         std::isfinite(given.supply_V) && given.air_C >= -100.0f && given.air_C <= 200.0f &&
                         dt_s >= 0.0f && std::isfinite(dt_s);
    REQUIRE(state.power <= std::max(state.demand, tp::least_power()));
    if (!is_good) REQUIRE(state.power <= tp::least_power());
    if (!is_good) REQUIRE(tp::is_fault(state.reason));
    if (tp::is_fault(state.reason)) REQUIRE(state.power <= tp::least_power());
  }
  // Whatever that did to the estimate, a known temperature mends it.
  axis.start(30.0f);
  for (int i = 0; i < 300; ++i) axis.step(inputs<TestType>(0.3f), 0.03f);
  CHECK(axis.state().power == 75);
}

TEST_CASE("every policy can be exchanged: two nodes, hysteresis, per cycle, no gain") {
  typedef tp::AxisController<motors_under_test::ServoWithWinding, tp::StepPowerLaw<tp::HysteresisLevels>,
                             tp::SafetyLimiter<tp::PerCycle>, tp::NoGain>
      Valve;
  Valve valve;
  CHECK(valve.validate() == tp::ConfigError::none);
  const auto& state = valve.step({0.5f, 13.0f, 25.0f, LimitReason::none}, 0.03f);
  CHECK(state.power == 125);
  CHECK(state.p_gain == 0);
}
