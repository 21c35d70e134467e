// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Failures that other projects have had in the field. Each test is named after what went wrong;
// docs/explain/lessons-from-others.md tells where.

#include "../catch.hpp"
#include "limiter_inputs.hpp"

#include <cmath>

#include <thermopower/actuator/field_oriented.hpp>
#include <thermopower/actuator/temperature_observer.hpp>
#include <thermopower/control/air_temperature.hpp>
#include <thermopower/control/axis_controller.hpp>
#include <thermopower/control/certified/limiter.hpp>
#include <thermopower/control/node_limiter.hpp>
#include <thermopower/motors/bgm2606_90t.hpp>

using namespace thermopower;

namespace {
const float nan_C = detail::not_a_number();
}

TEST_CASE("full torque when the root of the limit is negative") {
  CHECK(highest_q_current_A(10.0f, 6.0f) == Approx(8.0f));
  CHECK(highest_q_current_A(10.0f, 10.0f) == 0.0f);
  CHECK(highest_q_current_A(10.0f, 10.01f) ==
        0.0f);  // not NaN, which a comparison would let through as "no limit"
  CHECK(highest_q_current_A(10.0f, -25.0f) == 0.0f);
  CHECK(highest_q_current_A(-10.0f, 0.0f) ==
        0.0f);  // a limit derated below zero is no limit squared positive
  CHECK(highest_q_current_A(nan_C, 0.0f) == 0.0f);
  CHECK(highest_q_current_A(10.0f, nan_C) == 0.0f);
  CHECK(highest_current_A(-1.0f, 0.1f) == 0.0f);
  CHECK(highest_current_A(1.0f, 0.0f) == 0.0f);
  CHECK(highest_current_A(nan_C, 0.1f) == 0.0f);
  // The same for limiters: far beyond the limit, where a budget is negative, the power is the least.
  NodeLimiter nodes;
  for (const float body_C : {60.0f, 61.0f, 100.0f, 1000.0f})
    CHECK(nodes.step(told::parts(255, body_C, body_C, 20.0f), 0.0f).power == 1);
  CertifiedLimiter<>::Config config = CertifiedLimiter<>::Config::standard();
  config.network = {{8.0f, 8.0f}, {80.0f, 80.0f}, 1.0f, 0.2f, 110.0f, 60.0f};
  config.use.heat = HeatBounds::ohmic(13.0f, 1.0f, {8.0f, 8.0f}, {0.0039f, 0.0039f}, 20.0f, 0.0f, 110.0f);
  config.use.highest_air_C = 30.0f;
  for (const float start_C : {61.0f, 111.0f, 300.0f, 900.0f}) {
    CertifiedLimiter<> certified(config);
    certified.start(start_C, start_C);
    CHECK(certified.step({255, 13.0f, 25.0f}, 0.01f).power == 1);
    CHECK_FALSE(certified.is_certified());
  }
}

TEST_CASE("a disconnected sensor read as cold") {
  // A pulled-up NTC reads like -100 degC or colder, a missing frame IMU as 0, a digital one as -128 or NaN.
  AirTemperature air(AirTemperature::Config::believing());
  CHECK(std::isnan(air.step(-128.0f, nan_C).air_C));
  CHECK(std::isnan(air.step(-99.0f, -99.0f).air_C));
  NodeLimiter nodes;
  for (const float gone_C : {nan_C, -300.0f, static_cast<float>(INFINITY), -static_cast<float>(INFINITY)}) {
    CHECK(nodes.step(told::parts(255, gone_C, 30.0f, 20.0f), 0.0f).power == 1);
    CHECK(nodes.step(told::parts(255, 30.0f, gone_C, 20.0f), 0.0f).power == 1);
    CHECK(is_fault(nodes.step(told::parts(255, 30.0f, gone_C, 20.0f), 0.0f).reason));
  }
  // An air thermometer that is gone makes the air as warm as it may ever be, not cold.
  CertifiedLimiter<>::Config config = CertifiedLimiter<>::Config::standard();
  config.network = {{8.0f, 8.0f}, {80.0f, 80.0f}, 1.0f, 0.2f, 110.0f, 60.0f};
  config.use.heat = HeatBounds::ohmic(13.0f, 1.0f, {8.0f, 8.0f}, {0.0039f, 0.0039f}, 20.0f, 0.0f, 110.0f);
  config.use.highest_air_C = 40.0f;
  CertifiedLimiter<> with_air(config), without_air(config);
  for (int i = 0; i < 20000; ++i) {
    with_air.step({255, 13.0f, 10.0f}, 0.1f);
    without_air.step({255, 13.0f, nan_C}, 0.1f);
  }
  CHECK(without_air.ceiling() < with_air.ceiling());
  // A winding whose current is gone is not a winding of infinite resistance, nor a cold one.
  WindingResistance::Config copper = WindingResistance::Config::standard();
  copper.resistance_ohm = 8.0f;
  CHECK_FALSE(WindingResistance(copper).measure(10.0f, 0.0f).is_valid);
}

TEST_CASE("a jump at the derating threshold") {
  NodeLimiter nodes;
  int last = nodes.step(told::parts(255, 30.0f, 30.0f, 20.0f), 0.0f).power;
  for (float body_C = 30.0f; body_C < 62.0f; body_C += 0.002f) {
    const int power = nodes.step(told::parts(255, body_C, body_C, 20.0f), 0.0f).power;
    if (last - power > 1) FAIL("jump from " << last << " to " << power << " at " << body_C << " degC");
    last = power;
  }
}

TEST_CASE("all-zero parameters accepted") {
  CertifiedLimiter<>::Config certified = {};
  CHECK(is_error(certified.validate()));
  CHECK(CertifiedLimiter<>(certified).step({255, 13.0f, 25.0f}, 0.01f).power == 1);
  CertifiedLimiter<CertifiedOneNode>::Config one_node = {};
  CHECK(is_error(one_node.validate()));
  CHECK(CertifiedLimiter<CertifiedOneNode>(one_node).step({255, 13.0f, 25.0f}, 0.01f).power == 1);
  NodeLimiter::Config nodes = {};
  CHECK(is_error(nodes.validate()));
  CHECK(NodeLimiter(nodes).step(told::parts(255, 25.0f, 25.0f, 25.0f), 0.0f).power == 1);
  TemperatureObserverConfig observer = {};
  CHECK(is_error(observer.validate()));
  WindingResistance::Config winding = {};
  CHECK(is_error(winding.validate()));
  typedef AxisController<motors::Bgm2606_90t, StepPowerLaw<>, SafetyLimiter<>, NoGain> Axis;
  Axis::Config axis = {};
  CHECK(is_error(axis.validate()));
  CHECK(Axis(axis).step({5.0f, 13.0f, 25.0f, LimitReason::none}, 0.01f).power == 1);
}

TEST_CASE("a limit that watches one current component only") {
  // All of the current on the d axis: no torque, all of the heat.
  CHECK(field_oriented_heat_W(10.0f, 0.0f, 0.1f) == field_oriented_heat_W(0.0f, 10.0f, 0.1f));
  CHECK(field_oriented_heat_W(6.0f, 8.0f, 0.1f) == Approx(15.0f));
  CHECK(current_squared_A2(-3.0, 4.0) == 25.0);
  // With the field weakened, less is left for torque.
  CHECK(highest_q_current_A(10.0f, -8.0f) == Approx(6.0f));
  for (float d_A = -12.0f; d_A <= 12.0f; d_A += 0.1f) {
    const float q_A = highest_q_current_A(10.0f, d_A);
    if (detail::magnitude(d_A) <= 10.0f) CHECK(current_squared_A2(d_A, q_A) <= 100.001f);
    else CHECK(q_A == 0.0f);
  }
}
