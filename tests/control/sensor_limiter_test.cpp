// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/control/limiter_chain.hpp>
#include <thermopower/control/node_limiter.hpp>
#include <thermopower/control/sensor_limiter.hpp>

#include "../catch.hpp"
#include "limiter_inputs.hpp"

using namespace thermopower;

TEST_CASE("a required sensor: no power before the first measurement, nor after the last for too long") {
  SensorLimiter limiter;
  REQUIRE(limiter.validate() == ConfigError::none);
  CHECK(limiter.step({200}, 0.0f).power == least_power());
  CHECK(limiter.step({200}, 0.1f).reason == LimitReason::sensor_missing);
  CHECK(is_fault(LimitReason::sensor_missing));
  CHECK(limiter.ceiling() == least_power());
  for (int round = 0; round < 3; ++round) {
    limiter.measured();
    double granted_s = 0.0;
    while (limiter.step({200}, 0.1f).power == 200 && granted_s < 20.0) granted_s += 0.1;
    CHECK(granted_s == Approx(10.0).margin(0.11));
    CHECK(limiter.step({200}, 0.1f).reason == LimitReason::sensor_missing);
    for (int i = 0; i < 1000; ++i) CHECK(limiter.step({200}, 1.0e6f).power == least_power());  // and stays so
  }
}

TEST_CASE("a waiver is a configuration of its own name; what is no time or no configuration is cut") {
  SensorLimiter waived(SensorLimiter::Config::waived());
  CHECK(waived.step({200}, 1000.0f).power == 200);
  CHECK(waived.ceiling() == 255);
  SensorLimiter limiter;
  limiter.measured();
  CHECK(limiter.step({200}, detail::not_a_number()).reason == LimitReason::time_invalid);
  CHECK(limiter.step({200}, -1.0f).reason == LimitReason::time_invalid);
  CHECK(limiter.step({200}, 0.1f).power == 200);
  SensorLimiter::Config wrong = SensorLimiter::Config::standard();
  wrong.is_waived = 2;
  CHECK(wrong.validate() == ConfigError::is_waived);
  wrong = SensorLimiter::Config::waived();
  wrong.timeout_s = 0.0f;
  CHECK(wrong.validate() == ConfigError::timeout_s);
  CHECK(SensorLimiter(wrong).step({200}, 0.1f).reason == LimitReason::config_invalid);
}

TEST_CASE("in a chain it asks for the sensor, and the other limiter for the temperature") {
  typedef LimiterChain<SensorLimiter, NodeLimiter> Chain;
  Chain chain(Chain::Config::standard());
  AxisFacts facts = AxisFacts::unknown();
  facts.demand = 200;
  facts.motor_C = facts.body_C = told::degrees(25.0f);
  facts.air_C = 25.0f;
  CHECK(chain.step(facts, 0.1f).reason == LimitReason::sensor_missing);
  chain.limiter<0>().measured();
  CHECK(chain.step(facts, 0.1f).power == 200);
  facts.motor_C = facts.body_C = told::degrees(90.0f);
  CHECK(chain.step(facts, 0.1f).reason == LimitReason::over_temperature);
}

TEST_CASE("the time-out is ten seconds, the tenth still granted") {
  SensorLimiter limiter;
  limiter.measured();
  CHECK(limiter.ceiling() == 255);
  CHECK(limiter.step({200}, 0.0f).power == 200);  // no time has passed: no fault
  CHECK(limiter.step({200}, 10.0f).power == 200);
  CHECK(limiter.step({200}, 0.001f).reason == LimitReason::sensor_missing);
  CHECK(limiter.ceiling() == least_power());
  limiter.measured();
  CHECK(limiter.step({200}, 10.001f).reason == LimitReason::sensor_missing);
  // A waiver waives the sensor and nothing else.
  CHECK(SensorLimiter::Config::waived().timeout_s == SensorLimiter::Config::standard().timeout_s);
  SensorLimiter waived(SensorLimiter::Config::waived());
  CHECK(waived.step({200}, -1.0f).reason == LimitReason::time_invalid);
}

TEST_CASE("a sensor's cut leaves the least power, or the demand if that is less") {
  SensorLimiter limiter;
  CHECK(limiter.cut(LimitReason::link_silent).power == least_power());
  CHECK(limiter.cut(LimitReason::link_silent).reason == LimitReason::link_silent);
  CHECK(limiter.cut(LimitReason::link_silent, 0).power == 0);
  CHECK(limiter.cut(LimitReason::link_silent, 2).power == least_power());
  CHECK(limiter.step({0}, 0.1f).power == 0);
  CHECK(limiter.validate() == ConfigError::none);
  CHECK(limiter.config().timeout_s == 10.0f);
  SensorLimiter::Config wrong = SensorLimiter::Config::standard();
  wrong.timeout_s = 0.0f;
  CHECK(SensorLimiter(wrong).validate() == ConfigError::timeout_s);
}
