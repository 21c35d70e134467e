// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/control/limiter_chain.hpp>
#include <thermopower/control/node_limiter.hpp>
#include <thermopower/control/sensor_limiter.hpp>

#include "../catch.hpp"

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
  facts.motor_C = facts.body_C = facts.air_C = 25.0f;
  CHECK(chain.step(facts, 0.1f).reason == LimitReason::sensor_missing);
  chain.limiter<0>().measured();
  CHECK(chain.step(facts, 0.1f).power == 200);
  facts.motor_C = facts.body_C = 90.0f;
  CHECK(chain.step(facts, 0.1f).reason == LimitReason::over_temperature);
}
