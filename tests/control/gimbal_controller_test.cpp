// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/control/gimbal_controller.hpp>
#include <thermopower/sbgc/realtime_data.hpp>

#include "motors.hpp"
#include "near.hpp"

#include <limits>

namespace tp = thermopower;
using tp::LimitReason;

namespace {
const float nan_ = std::numeric_limits<float>::quiet_NaN();

typedef tp::AxisController<tp::motors::Bgm2606_90t> Small;
typedef tp::AxisController<tp::motors::Bgm5208_200_12> Large;
typedef tp::GimbalController<Small, Small, Large> Gimbal;

const Small::Config roll = Small::Config::with_gain({24.0f, 4.0f}),
                    pitch = Small::Config::with_gain({180.0f, 105.0f});
const Large::Config yaw = Large::Config::with_gain({40.0f, 2.0f});

Gimbal gimbal(const tp::GimbalConfig& config = tp::GimbalConfig::believing()) {
  return Gimbal(config, roll, pitch, yaw);
}

Gimbal::Inputs inputs(float error_deg, float supply_V = 12.6f, float camera_C = 26.0f,
                      float frame_C = 24.0f) {
  return {{error_deg, error_deg, error_deg}, camera_C, frame_C, supply_V};
}

template <class Command>
void check_all(const Command& command, uint8_t power, LimitReason reason) {
  for (int axis = 0; axis < 3; ++axis) {
    CAPTURE(axis, static_cast<int>(command.reason[axis]));
    CHECK(command.power[axis] == power);
    CHECK(command.reason[axis] == reason);
  }
}
}  // namespace

TEST_CASE("a gimbal is its axes, each with its own motor, error and gain") {
  Gimbal three = gimbal();
  Small alone_roll(roll), alone_pitch(pitch);
  Large alone_yaw(yaw);
  CHECK(three.validate().field == tp::ConfigError::none);
  for (int i = 0; i < 5000; ++i) {
    const float e = static_cast<float>(i % 100) * 0.01f;
    const auto& command = three.step(Gimbal::Inputs{{e, 2.0f * e, -3.0f * e}, 26.0f, 24.0f, 12.6f}, 0.03f);
    REQUIRE(command.power[0] == alone_roll.step({e, 13.0f, 25.0f, LimitReason::none}, 0.03f).power);
    REQUIRE(command.power[1] == alone_pitch.step({2.0f * e, 13.0f, 25.0f, LimitReason::none}, 0.03f).power);
    REQUIRE(command.power[2] == alone_yaw.step({-3.0f * e, 13.0f, 25.0f, LimitReason::none}, 0.03f).power);
    REQUIRE(command.p_gain[1] == alone_pitch.state().p_gain);
    REQUIRE(three.axis<2>().state().motor_C == alone_yaw.state().motor_C);
  }
  CHECK(three.state().air_C == 25.0f);
  CHECK(three.state().air_source == tp::AirSource::both);
}

namespace {
/// The roll motor in a room of which its own type says how warm it gets.
struct Indoors : tp::motors::Bgm2606_90t {
  static tp::AirRange air() { return {0.0f, 40.0f}; }
};
typedef tp::AxisController<Indoors> IndoorsAxis;
}  // namespace

TEST_CASE(
    "of two declarations of the air the colder one counts, and thermometers outside of a motor's are a fault") {
  typedef tp::GimbalController<IndoorsAxis> Indoors;
  const auto told = [](float declared_C, float camera_C, float frame_C) {
    tp::GimbalConfig config = tp::GimbalConfig::standard();
    config.air = tp::AirTemperature::Config::declared(declared_C);
    Indoors gimbal(config, IndoorsAxis::Config::with_gain({24.0f, 4.0f}));
    REQUIRE(gimbal.validate().field == tp::ConfigError::none);
    for (int i = 0; i < 60000; ++i) gimbal.step(Indoors::Inputs{{2.0f}, camera_C, frame_C, 12.6f}, 0.03f);
    return gimbal;
  };
  // The gimbal's default is 45 degC.
  const Indoors both = told(45.0f, 26.0f, 24.0f), same = told(40.0f, 26.0f, 24.0f),
                colder = told(30.0f, 26.0f, 24.0f);
  CHECK_FALSE(tp::is_fault(both.state().command.reason[0]));
  CHECK(both.axis<0>().state().motor_C == same.axis<0>().state().motor_C);
  CHECK(both.state().command.power[0] > tp::least_power());
  CHECK(colder.state().command.power[0] > both.state().command.power[0]);
  // A room that is warmer than the motor's range, declared by the gimbal or not; one that is colder.
  for (const float room_C : {42.0f, 50.0f})
    CHECK(told(45.0f, room_C, room_C).state().command.reason[0] == LimitReason::air_implausible);
  CHECK(told(-static_cast<float>(INFINITY), -10.0f, -10.0f).state().command.reason[0] ==
        LimitReason::air_implausible);
}

TEST_CASE("before the first telemetry the power is the least, however long that takes") {
  Gimbal three = gimbal();
  check_all(three.state().command, tp::least_power(), LimitReason::no_telemetry_yet);
  for (int i = 0; i < 100; ++i)
    check_all(three.step_silent(0.03f), tp::least_power(), LimitReason::no_telemetry_yet);
  check_all(three.step(inputs(0.5f), 0.03f), 2, LimitReason::recovering);
  for (int i = 0; i < 200; ++i) three.step(inputs(0.5f), 0.03f);
  check_all(three.state().command, 125, LimitReason::none);
}

TEST_CASE("a short silence is bridged, a long one cuts, and telemetry brings the power back") {
  Gimbal three = gimbal();
  for (int i = 0; i < 10; ++i) three.step(inputs(0.5f), 0.03f);
  check_all(three.state().command, 125, LimitReason::none);
  for (int i = 0; i < 16; ++i) check_all(three.step_silent(0.03f), 125, LimitReason::none);
  CHECK(three.state().silent_s == Near(0.48));
  check_all(three.step_silent(0.03f), tp::least_power(), LimitReason::link_silent);
  three.step(inputs(0.5f), 0.03f);
  CHECK(three.state().command.reason[0] == LimitReason::recovering);
  CHECK(three.state().silent_s == 0.0f);
}

TEST_CASE("time that is NaN counts as silence, and time that runs backwards buys none") {
  Gimbal broken = gimbal();
  broken.step(inputs(0.5f), 0.03f);
  check_all(broken.step_silent(nan_), tp::least_power(), LimitReason::link_silent);
  check_all(broken.step_silent(0.03f), tp::least_power(), LimitReason::link_silent);

  Gimbal backwards = gimbal();
  backwards.step(inputs(0.5f), 0.03f);
  for (int i = 0; i < 20; ++i) {
    backwards.step_silent(0.03f);
    backwards.step_silent(-1.0f);
  }
  check_all(backwards.step_silent(0.03f), tp::least_power(), LimitReason::link_silent);
}

TEST_CASE("temperatures go on through the silence, and rise when any power may be in force") {
  Gimbal three = gimbal();
  for (int i = 0; i < 4000; ++i) three.step(inputs(3.0f), 0.03f);
  const float hot_C = three.axis<0>().state().motor_C;
  for (int i = 0; i < 4000; ++i) three.step_silent(0.03f);
  CHECK(three.axis<0>().state().motor_C > hot_C + 10.0f);  // nobody knows what the board drives them with
  for (int i = 0; i < 20000; ++i) three.step(inputs(0.0f), 0.03f);
  CHECK(three.axis<0>().state().motor_C < hot_C + 10.0f);
}

TEST_CASE("an empty battery gives the least power, and a silent cycle after it does not undo that") {
  Gimbal three = gimbal();
  for (int i = 0; i < 10; ++i) three.step(inputs(0.5f), 0.03f);
  check_all(three.step(inputs(0.5f, 2.9f), 0.03f), tp::least_power(), LimitReason::supply_low);
  for (int i = 0; i < 10; ++i)
    check_all(three.step_silent(0.03f), tp::least_power(), LimitReason::supply_low);
  check_all(three.step(inputs(0.5f, nan_), 0.03f), tp::least_power(), LimitReason::supply_not_finite);
  check_all(three.step_silent(0.03f), tp::least_power(), LimitReason::supply_not_finite);
  CHECK(three.step(inputs(0.5f), 0.03f).reason[0] == LimitReason::recovering);
}

TEST_CASE("without a frame IMU the camera's thermometer counts; without both, the power is the least") {
  Gimbal three = gimbal();
  three.step(inputs(0.5f, 12.6f, 26.0f, nan_), 0.03f);
  CHECK(three.state().air_C == 26.0f);
  three.step(inputs(0.5f, 12.6f, 26.0f, 0.0f), 0.03f);
  CHECK(three.state().air_C == 26.0f);
  check_all(three.state().command, 125, LimitReason::none);
  check_all(three.step(inputs(0.5f, 12.6f, nan_, nan_), 0.03f), tp::least_power(),
            LimitReason::air_implausible);
  CHECK(three.state().air_source == tp::AirSource::neither);
  check_all(three.step_silent(0.03f), tp::least_power(), LimitReason::air_implausible);
}

TEST_CASE("one axis' broken error does not stop the others") {
  Gimbal three = gimbal();
  const auto& command = three.step(Gimbal::Inputs{{0.5f, nan_, 0.5f}, 26.0f, 24.0f, 12.6f}, 0.03f);
  CHECK(command.power[0] == 125);
  CHECK(command.power[1] == tp::least_power());
  CHECK(command.reason[1] == LimitReason::error_not_finite);
  CHECK(command.power[2] == 125);
}

TEST_CASE("a wrong field is named with its axis, and no axis moves") {
  Small::Config wrong = pitch;
  wrong.limiter.maximum_C = nan_;
  Gimbal three(tp::GimbalConfig::standard(), roll, wrong, yaw);
  CHECK(three.validate().axis == 1);
  CHECK(three.validate().field == tp::ConfigError::maximum_C);
  check_all(three.step(inputs(0.5f), 0.03f), tp::least_power(), LimitReason::config_invalid);
  check_all(three.step_silent(0.03f), tp::least_power(), LimitReason::config_invalid);

  Gimbal unset;
  CHECK(unset.validate().axis == 0);
  CHECK(unset.validate().field == tp::ConfigError::gain_low_power);

  tp::GimbalConfig own = tp::GimbalConfig::standard();
  own.timeout_s = 0.0f;
  CHECK(gimbal(own).validate().axis == 3);
  CHECK(gimbal(own).validate().field == tp::ConfigError::timeout_s);
}

TEST_CASE("a wrong constant of the gimbal is refused by name") {
  using tp::ConfigError;
  const float infinite = std::numeric_limits<float>::infinity();
  const auto error = [](float supply_V, float minimum_V, float timeout_s) {
    tp::GimbalConfig config = {supply_V, minimum_V, timeout_s, tp::AirTemperature::Config::standard(), 60.0f};
    return config.validate();
  };
  CHECK(tp::GimbalConfig::standard().validate() == ConfigError::none);
  for (const float bad : {nan_, infinite, -infinite, 0.0f, -13.0f})
    CHECK(error(bad, 3.0f, 0.5f) == ConfigError::supply_V);
  for (const float bad : {nan_, infinite, -infinite, -1.0f, 13.0f, 14.0f})
    CHECK(error(13.0f, bad, 0.5f) == ConfigError::minimum_supply_V);
  for (const float bad : {nan_, infinite, -infinite, 0.0f, -1.0f})
    CHECK(error(13.0f, 3.0f, bad) == ConfigError::timeout_s);
  tp::GimbalConfig air = tp::GimbalConfig::standard();
  air.air.maximum_difference_K = 0.0f;
  CHECK(air.validate() == ConfigError::maximum_difference_K);
}

TEST_CASE("on a nominal supply the estimate ignores the measured one; on a measured supply it follows") {
  tp::BasicGimbalController<tp::NominalSupply, Small> nominal(tp::GimbalConfig::standard(), roll);
  tp::BasicGimbalController<tp::MeasuredSupply, Small> measured(tp::GimbalConfig::standard(), roll);
  for (int i = 0; i < 3; ++i) {
    nominal.step({{3.0f}, 25.0f, 25.0f, 10.0f}, 0.03f);
    measured.step({{3.0f}, 25.0f, 25.0f, 10.0f}, 0.03f);
  }
  CHECK(nominal.axis<0>().state().v_rms_V == Near(13.0 * std::sqrt(250.0 / 255.0)));
  CHECK(measured.axis<0>().state().v_rms_V == Near(10.0 * std::sqrt(250.0 / 255.0)));
}

TEST_CASE("any telemetry with the four questions is taken, an SBGC message among them") {
  struct Telemetry {
    float error_deg(uint8_t axis) const { return axis == 1 ? 0.5f : 0.0f; }
    int imu_C() const { return 26; }
    int frame_imu_C() const { return 24; }
    float battery_V() const { return 12.6f; }
  };
  Gimbal three = gimbal();
  const auto& command = three.step(Telemetry(), 0.03f);
  CHECK(command.power[1] == 125);
  CHECK(command.power[0] == 25);
  CHECK(three.state().air_C == 25.0f);
}

TEST_CASE("a gimbal has as many axes as one gives it") {
  tp::GimbalController<Small> one(tp::GimbalConfig::standard(), roll);
  CHECK(one.axis_count() == 1);
  CHECK(one.step({{0.5f}, 25.0f, 25.0f, 12.6f}, 0.03f).power[0] == 125);
  typedef tp::GimbalController<Small, Large, Small, Large, Small> Five;
  Five five(tp::GimbalConfig::standard(), roll, yaw, roll, yaw, roll);
  CHECK(five.axis_count() == 5);
  CHECK(five.step({{0.1f, 0.2f, 0.3f, 0.4f, 0.5f}, 25.0f, 25.0f, 12.6f}, 0.03f).power[4] == 125);
}
