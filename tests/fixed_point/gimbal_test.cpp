// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The fixed-point gimbal beside the floating-point one with the same policies, on the same telemetry.
#include <cmath>
#include <cstdlib>
#include <thermopower/thermopower.hpp>

#include "../catch.hpp"

namespace tp = thermopower;
namespace fixed = thermopower::fixed_point;

namespace {

typedef tp::motors::Bgm2606_90t::AsProgrammed Small;
typedef tp::motors::Bgm5208_200_12::AsProgrammed Large;
typedef fixed::SafetyLimiter<fixed::ThesisLimit, fixed::PerCycle> WholeLimiter;
template <class Motor, class Gain>
using Whole = fixed::AxisController<fixed::ThermalModel<fixed::ThesisMotor<Motor> >,
                                    fixed::ProgrammedLevels<>, WholeLimiter, Gain>;
template <class Motor>
using Real = tp::AxisController<Motor, tp::StepPowerLaw<>, tp::SafetyLimiter<tp::PerCycle>,
                                tp::GainScheduler<tp::TruncatedGain> >;

typedef fixed::BasicGimbalController<fixed::BelievingGimbal, Whole<Small, fixed::TruncatedGain<24, 4> >,
                                     Whole<Small, fixed::TruncatedGain<180, 105> >,
                                     Whole<Large, fixed::TruncatedGain<40, 2> > >
    WholeGimbal;
typedef tp::GimbalController<Real<Small>, Real<Small>, Real<Large> > RealGimbal;

RealGimbal real_gimbal() {
  return RealGimbal(tp::GimbalConfig::believing(), Real<Small>::Config::with_gain({24, 4}),
                    Real<Small>::Config::with_gain({180, 105}), Real<Large>::Config::with_gain({40, 2}));
}

struct Telemetry {
  std::int16_t target[3] = {0, 0, 0}, angle[3] = {0, 0, 0};
  std::int8_t camera = 26, frame = 26;
  std::uint16_t battery = 1260;
  std::int16_t target_angle(std::uint8_t axis) const { return target[axis]; }
  std::int16_t imu_angle(std::uint8_t axis) const { return angle[axis]; }
  float error_deg(std::uint8_t axis) const { return tp::sbgc::angle_deg(target[axis] - angle[axis]); }
  std::int8_t imu_C() const { return camera; }
  std::int8_t frame_imu_C() const { return frame; }
  std::uint16_t battery_cV() const { return battery; }
  float battery_V() const { return static_cast<float>(battery) * 0.01f; }
};

struct Pair {
  WholeGimbal whole;
  RealGimbal real = real_gimbal();
  long steps = 0, agreeing = 0;
  int worst_power = 0;

  void compare() {
    bool agrees = true;
    for (int axis = 0; axis < 3; ++axis) {
      const int power = std::abs(int(whole.command().power[axis]) - int(real.state().command.power[axis]));
      const int gain = std::abs(int(whole.command().p_gain[axis]) - int(real.state().command.p_gain[axis]));
      worst_power = std::max(worst_power, power);
      agrees = agrees && power <= 2 && gain <= 1;
    }
    ++steps;
    agreeing += agrees;
  }
  void step(const Telemetry& telemetry) {
    whole.step(telemetry, 129);
    whole.prepare();
    real.step(telemetry, 129 * 256e-6f);
    compare();
  }
  void silent() {
    whole.step_silent(129);
    whole.prepare();
    real.step_silent(129 * 256e-6f);
    compare();
  }
  bool same_reasons() const {
    for (int axis = 0; axis < 3; ++axis)
      if (whole.command().reason[axis] != real.state().command.reason[axis]) return false;
    return true;
  }
};

}  // namespace

// Minutes of demand and minutes of rest. A motor that is held at its limit for long stays within millikelvins
// of it; whether it is above is then decided by a float's last digits, and any two computations part.
TEST_CASE("the same decisions for an hour of motion, heat and cold") {
  Pair pair;
  Telemetry telemetry;
  for (long count = 0; count < 108000; ++count) {
    const double time_s = static_cast<double>(count) * (129 * 256e-6);
    telemetry.camera = static_cast<std::int8_t>(std::lround(30 + 14 * std::sin(time_s / 400)));
    telemetry.frame = static_cast<std::int8_t>(telemetry.camera + 2);
    const double demand = std::sin(time_s / 90) > 0 ? 1.0 : 0.004;
    telemetry.angle[0] =
        static_cast<std::int16_t>(std::lround(60 * demand * std::sin(time_s * 2.1) * std::sin(time_s / 40)));
    telemetry.angle[1] = static_cast<std::int16_t>(std::lround(16384 + demand * 8000 * std::sin(time_s / 9)));
    telemetry.angle[2] = static_cast<std::int16_t>(std::lround(32767 * std::sin(time_s / 31)));
    telemetry.target[2] = static_cast<std::int16_t>(std::lround(32767 * std::cos(time_s / 31)));
    pair.step(telemetry);
  }
  INFO("worst difference " << pair.worst_power);
  CHECK(100 * pair.agreeing >= 99 * pair.steps);
}

TEST_CASE("the same power and reason for every fault, from the first call on") {
  Pair pair;
  const auto check_least = [&](tp::LimitReason reason) {
    for (int axis = 0; axis < 3; ++axis) {
      CHECK(pair.whole.command().power[axis] == 1);
      CHECK(pair.whole.command().reason[axis] == reason);
    }
    CHECK(pair.same_reasons());
  };
  check_least(tp::LimitReason::no_telemetry_yet);
  pair.silent();
  check_least(tp::LimitReason::no_telemetry_yet);

  Telemetry telemetry;
  telemetry.angle[0] = 300;
  telemetry.camera = telemetry.frame = 100;
  pair.step(telemetry);
  check_least(tp::LimitReason::air_implausible);
  pair.silent();
  check_least(tp::LimitReason::air_implausible);
  telemetry.camera = telemetry.frame = 26;
  telemetry.battery = 299;
  pair.step(telemetry);
  check_least(tp::LimitReason::supply_low);
  telemetry.battery = 1260;
  for (int count = 0; count < 300; ++count) pair.step(telemetry);
  CHECK(pair.whole.command().power[0] == 250);
  for (int count = 0; count < 14; ++count) pair.silent();
  CHECK(pair.whole.command().power[0] == 250);
  CHECK(pair.same_reasons());
  for (int count = 0; count < 3; ++count) pair.silent();
  check_least(tp::LimitReason::link_silent);
  pair.step(telemetry);
  CHECK(pair.whole.command().power[0] == 2);
  CHECK(pair.whole.command().reason[0] == tp::LimitReason::recovering);
  CHECK(pair.same_reasons());
  CHECK(pair.agreeing == pair.steps);
}

TEST_CASE(
    "a gimbal that goes on beside a running board counts the heat up to its first message, a new one none") {
  WholeGimbal fresh, restored;
  restored.restore(26 * 128, 26 * 128);
  REQUIRE(restored.is_restored());
  REQUIRE_FALSE(fresh.is_restored());
  const Telemetry telemetry;
  fresh.step(telemetry, 60000);  // 15 s in which the board may have driven the motors with anything
  restored.step(telemetry, 60000);
  CHECK(fresh.hottest_C() == 27);  // 26 and its fraction, rounded up
  CHECK(restored.hottest_C() > 28);
}

TEST_CASE(
    "a clock that stands still in most of the messages is a fault, one that is slow beside silent cycles is none") {
  const auto reason_after = [](int messages, auto ticks_of) {
    WholeGimbal gimbal;
    Telemetry telemetry;
    telemetry.target[0] = 2000;
    tp::LimitReason worst = tp::LimitReason::none;
    for (int i = 0; i < messages; ++i) {
      if (ticks_of(i) < 0)
        gimbal.step_silent(129);  // the time before this message was told with a silent cycle
      gimbal.step(telemetry, ticks_of(i) > 0 ? static_cast<fixed::Ticks>(ticks_of(i)) : fixed::Ticks(0));
      gimbal.prepare();
      worst = tp::is_fault(gimbal.command().reason[0]) ? gimbal.command().reason[0] : worst;
    }
    return worst;
  };
  CHECK(reason_after(40, [](int) { return 0; }) == tp::LimitReason::time_stands_still);
  CHECK(reason_after(200, [](int i) { return i % 11 == 0 ? 129 : 0; }) == tp::LimitReason::time_stands_still);
  CHECK(reason_after(200, [](int i) { return i % 3 == 0 ? 129 : 0; }) == tp::LimitReason::time_stands_still);
  CHECK(reason_after(2000, [](int i) { return i % 2 == 0 ? 129 : 0; }) == tp::LimitReason::none);  // in pairs
  CHECK(reason_after(2000, [](int) { return -1; }) == tp::LimitReason::none);
  CHECK(reason_after(2000, [](int) { return 129; }) == tp::LimitReason::none);
}
