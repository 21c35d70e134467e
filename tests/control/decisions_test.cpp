// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// What limiters and controllers decide on, one reason at a time: each fact alone decides, all others being as they should.

#include "../catch.hpp"

#include <limits>
#include <thermopower/thermopower.hpp>

#include "motors.hpp"

using namespace thermopower;

namespace {

const float nan_ = std::numeric_limits<float>::quiet_NaN(), infinite = std::numeric_limits<float>::infinity();

typedef AxisController<motors::Bgm2606_90t> Axis;
typedef GimbalController<Axis> Gimbal;

/// A limiter that vouches for a tenth of a second without a plan.
struct Impatient : SafetyLimiter<> {
  using SafetyLimiter<>::SafetyLimiter;
  float hold_s() const noexcept { return 0.1f; }
};
typedef AxisController<motors::Bgm2606_90t, StepPowerLaw<>, Impatient> ImpatientAxis;

Axis::Config axis_config() { return Axis::Config::with_gain({24.0f, 4.0f}); }
Gimbal::Inputs inputs(float supply_V, float air_C = 25.0f) { return {{0.5f}, air_C, air_C, supply_V}; }

}  // namespace

TEST_CASE("a cut never raises a demand below the least power") {
  CHECK(SafetyLimiter<>().cut(LimitReason::link_silent, 0).power == 0);
  CHECK(SafetyLimiter<>().cut(LimitReason::link_silent, 200).power == least_power());
  CHECK(NodeLimiter().cut(LimitReason::link_silent, 0).power == 0);
  CHECK(NodeLimiter().cut(LimitReason::link_silent, 200).power == least_power());
  CHECK(SensorLimiter().cut(LimitReason::link_silent, 0).power == 0);
  CHECK(SensorLimiter().cut(LimitReason::link_silent, 200).power == least_power());
}

TEST_CASE("a required sensor that is there lifts the ceiling, and a waiver does without") {
  SensorLimiter limiter;
  CHECK(limiter.ceiling() == least_power());
  limiter.measured();
  CHECK(limiter.ceiling() == 255);
  limiter.step({200}, 10.1f);
  CHECK(limiter.ceiling() == least_power());
  CHECK(SensorLimiter(SensorLimiter::Config::waived()).ceiling() == 255);
}

TEST_CASE("a fall of the air is believed at once where no time is known that it took") {
  for (const float dt_s : {-1.0f, nan_, infinite}) {
    AirTemperature air(AirTemperature::Config::believing());
    air.step(30.0f, 30.0f, 1.0f);
    CHECK(air.step(5.0f, 5.0f, dt_s).air_C == 5.0f);
  }
}

TEST_CASE("a utilisation's error level must be a number above its warning") {
  Utilisation::Config config = Utilisation::Config::standard();
  config.maximum_winding_C = 110.0f;
  config.maximum_body_C = 60.0f;
  REQUIRE(config.validate() == ConfigError::none);
  for (const float bad : {nan_, infinite, config.warning_percent}) {
    Utilisation::Config wrong = config;
    wrong.error_percent = bad;
    CHECK(wrong.validate() == ConfigError::error_percent);
  }
}

TEST_CASE("an axis that was never started is not warmed: its first air starts it") {
  Axis axis(axis_config());
  axis.warm_by(20.0f);
  axis.not_below(90.0f);
  CHECK(axis.state().motor_C != axis.state().motor_C);
  axis.step({0.5f, 12.0f, 25.0f, LimitReason::none}, 0.0f);
  CHECK(axis.state().motor_C == 25.0f);
  axis.start(50.0f);
  axis.not_below(40.0f);
  CHECK(axis.state().motor_C == 50.0f);
  axis.not_below(55.0f);
  CHECK(axis.state().motor_C == 55.0f);
  axis.warm_by(5.0f);
  CHECK(axis.state().motor_C == 60.0f);
}

TEST_CASE("a supply of 0 V is no supply: the highest that is declared heats, and it is a fault") {
  Axis axis(axis_config());
  axis.step({0.5f, 12.0f, 25.0f, LimitReason::none}, 0.0f);
  axis.step({0.5f, 12.0f, 25.0f, LimitReason::none}, 0.03f);
  CHECK(axis.state().reason == LimitReason::none);
  CHECK(axis.state().power == 125);
  const float before_C = axis.state().motor_C;
  axis.step({0.5f, 0.0f, 25.0f, LimitReason::none}, 0.03f);
  CHECK(axis.state().reason == LimitReason::supply_low);
  CHECK(axis.state().power == least_power());
  CHECK(axis.state().motor_C > before_C);
  axis.step({0.5f, -1.0f, 25.0f, LimitReason::none}, 0.03f);
  CHECK(axis.state().reason == LimitReason::supply_low);
  CHECK(axis.state().power == least_power());
}

TEST_CASE("a gimbal's highest supply must be a number above the nominal one") {
  GimbalConfig config = GimbalConfig::standard();
  for (const float bad : {nan_, infinite, config.supply_V, 1.0f}) {
    config.maximum_supply_V = bad;
    CHECK(config.validate() == ConfigError::maximum_supply_V);
  }
}

TEST_CASE("a supply that cannot be heats with the highest that the axis declares") {
  typedef BasicGimbalController<MeasuredSupply, Axis> Measured;
  const auto run = [](float first_V, float supply_V) {
    Measured gimbal(GimbalConfig::standard(), axis_config());
    gimbal.step(inputs(first_V), 0.0f);
    for (int i = 0; i < 2000; ++i) gimbal.step(inputs(supply_V), 0.03f);
    return gimbal.state().command.reason[0] == LimitReason::supply_implausible ||
                   gimbal.state().command.reason[0] == LimitReason::supply_low
               ? gimbal.axis<0>().state().v_rms_V
               : -1.0f;
  };
  const float highest_V = motors::Bgm2606_90t::supply().highest_V, least = 1.0f / 255.0f;
  for (const float first_V : {6.0f, 13.0f, 900.0f})
    for (const float bad_V : {900.0f, 1e30f, 0.0f, -5.0f})
      CHECK(run(first_V, bad_V) == Approx(highest_V * std::sqrt(least)));
}

TEST_CASE(
    "an air that jumps up after the start warms the motors, also when the messages have no time between") {
  for (const float dt_s : {0.0f, 0.03f}) {
    Gimbal gimbal(GimbalConfig::believing(), axis_config());
    gimbal.step(inputs(12.6f, 20.0f), dt_s);
    gimbal.step(inputs(12.6f, 20.0f), dt_s);
    CHECK(gimbal.axis<0>().state().motor_C < 21.0f);
    gimbal.step(inputs(12.6f, 40.0f), dt_s);
    CHECK(gimbal.axis<0>().state().motor_C > 39.0f);
  }
}

TEST_CASE("an order that is not followed counts only while time passes") {
  struct Telemetry {
    float error_deg(uint8_t) const { return 0.0f; }
    int imu_C() const { return 25; }
    int frame_imu_C() const { return 25; }
    float battery_V() const { return 12.6f; }
    uint8_t motor_power(uint8_t) const { return 200; }  // whatever it is told
  };
  Gimbal still(GimbalConfig::standard(), axis_config()), moving(GimbalConfig::standard(), axis_config());
  for (int i = 0; i < 1000; ++i) {
    still.step(Telemetry(), i % 2 ? 0.0f : -1.0f);
    moving.step(Telemetry(), 0.03f);
  }
  CHECK(still.state().command.reason[0] != LimitReason::not_obeyed);
  CHECK(moving.state().command.reason[0] == LimitReason::not_obeyed);
}

TEST_CASE(
    "an axis whose limiter vouches for less than the gimbal tolerates is cut first, for its own reason") {
  const GimbalController<Axis, ImpatientAxis>::Config config = GimbalConfig::standard();
  REQUIRE(config.timeout_s == 0.5f);
  GimbalController<Axis, ImpatientAxis> gimbal(config, axis_config(),
                                               ImpatientAxis::Config::with_gain({24.0f, 4.0f}));
  const auto message = [](float supply_V) {
    return GimbalController<Axis, ImpatientAxis>::Inputs{{0.5f, 0.5f}, 25.0f, 25.0f, supply_V};
  };
  for (int i = 0; i < 10; ++i) gimbal.step(message(12.6f), 0.03f);
  REQUIRE(gimbal.state().command.power[1] == 125);
  gimbal.step_silent(0.05f);
  gimbal.step_silent(0.04f);
  CHECK(gimbal.state().command.power[1] == 125);
  gimbal.step_silent(0.03f);
  CHECK(gimbal.state().command.power[0] == 125);
  CHECK(gimbal.state().command.power[1] == least_power());
  CHECK(gimbal.state().command.reason[1] == LimitReason::link_silent);
  // What was wrong before the silence is still what is wrong.
  gimbal.step(message(2.0f), 0.03f);
  for (int i = 0; i < 6; ++i) gimbal.step_silent(0.03f);
  CHECK(gimbal.state().command.reason[0] == LimitReason::supply_low);
  CHECK(gimbal.state().command.reason[1] == LimitReason::supply_low);
}
