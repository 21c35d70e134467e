// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Another battery than the one that was configured, and a board that says its motors are too hot.

#include "../catch.hpp"
#include "failing_board.hpp"

namespace {

using namespace failing;

/// FloatGimbal on the supply that was configured, 13 V.
struct NominalGimbal {
  typedef tp::GimbalController<tp::AxisController<tp::motors::Bgm2606_90t>> Gimbal;
  Gimbal gimbal{tp::GimbalConfig::believing(),
                tp::AxisController<tp::motors::Bgm2606_90t>::Config::with_gain({24.0f, 4.0f})};
  const Gimbal::Command& step(const Telemetry& telemetry) {
    return gimbal.step(telemetry, static_cast<float>(cycle_s));
  }
  double motor_C() { return static_cast<double>(gimbal.axis<0>().state().motor_C); }
};

struct Outcome {
  double hottest_C = 0, worst_below_K = 0, mean_power = 0;
  LimitReason reason = LimitReason::none;  // after the first message
  bool is_named_throughout = true;
};

/// Full demand for half an hour from a battery of so many volts, which the board measures.
template <class Gimbal>
Outcome run(double volt) {
  Gimbal under_test;
  Motor motor;
  Outcome outcome;
  int power = 1;
  const int cycles = 24000;
  for (int cycle = 0; cycle < cycles; ++cycle) {
    motor.spend(power, volt);
    Telemetry telemetry;
    telemetry.supply_V = volt;
    telemetry.reported = power;
    const auto& command = under_test.step(telemetry);
    power = command.power[0];
    if (cycle == 0) outcome.reason = command.reason[0];
    outcome.is_named_throughout =
        outcome.is_named_throughout && command.reason[0] == LimitReason::supply_above_nominal;
    outcome.hottest_C = std::max(outcome.hottest_C, motor.now_C);
    if (cycle > 30)
      outcome.worst_below_K = std::max(outcome.worst_below_K, motor.now_C - under_test.motor_C());
    outcome.mean_power += power / static_cast<double>(cycles);
  }
  return outcome;
}

}  // namespace

TEMPLATE_TEST_CASE("a battery of another voltage than configured does not heat the motor past its limit", "",
                   NominalGimbal, FixedGimbal) {
  for (double volt = 9.0; volt <= 26.0; volt += 1.3) {
    CAPTURE(volt);
    const Outcome outcome = run<TestType>(volt);
    CHECK(outcome.hottest_C < limit_C + 1.0);
    CHECK(outcome.worst_below_K < 0.5);
    const bool is_another = volt > 13.0 * 1.1 + 0.01;
    CHECK(outcome.is_named_throughout == is_another);
    // Within the margin the motor is used nearly as much as it bears.
    if (!is_another && volt >= 12.8) CHECK(outcome.hottest_C > limit_C - 6.0);
    CHECK((outcome.mean_power > 30.0) == !is_another);
  }
}

TEMPLATE_TEST_CASE("another battery is named at power-up, in the first message, and when it is changed later",
                   "", NominalGimbal, FixedGimbal) {
  CHECK(run<TestType>(16.8).reason == LimitReason::supply_above_nominal);
  TestType under_test;
  Telemetry telemetry;
  telemetry.error = 1.0;
  telemetry.reported = under_test.step(telemetry).power[0];
  under_test.step(telemetry);
  CHECK(under_test.step(telemetry).reason[0] == LimitReason::none);
  telemetry.supply_V = 16.8;
  CHECK(under_test.step(telemetry).reason[0] == LimitReason::supply_above_nominal);
  CHECK(under_test.step(telemetry).power[0] == 1);
  telemetry.supply_V = 12.6;
  CHECK(under_test.step(telemetry).reason[0] != LimitReason::supply_above_nominal);
}

TEST_CASE("in whole numbers no POWER is granted that the table does not know at the supply there is") {
  for (double volt = 13.0; volt < 14.3; volt += 0.1) {
    FixedGimbal under_test;
    Telemetry telemetry;
    telemetry.supply_V = volt;
    telemetry.camera = telemetry.frame = 5;
    for (int cycle = 0; cycle < 20; ++cycle) telemetry.reported = under_test.step(telemetry).power[0];
    CAPTURE(volt, telemetry.reported);
    CHECK(telemetry.reported * volt * volt <= 255.0 * 13.0 * 13.0);
    CHECK(telemetry.reported * volt * volt > 0.95 * 250.0 * 13.0 * 13.0);
    const bool is_less = telemetry.reported < 250;
    CHECK((under_test.gimbal.command().reason[0] == LimitReason::supply_headroom) == is_less);
  }
}

TEST_CASE("a supply reading that fails does not cool the estimate of a board that holds what it had") {
  // MeasuredSupply; the board is deaf and holds 250 while its own measurement of the battery fails.
  for (const double reads_V : {0.0, 2.0, 655.35}) {
    CAPTURE(reads_V);
    FloatGimbal under_test;
    Motor motor;
    double worst_below_K = 0.0;
    for (int cycle = 0; cycle < 6000; ++cycle) {
      Telemetry telemetry;
      telemetry.supply_V = cycle < 100 ? 13.0 : reads_V;
      telemetry.reported = cycle == 0 ? 1 : 250;
      motor.spend(telemetry.reported, 13.0);
      under_test.step(telemetry);
      if (cycle > 30) worst_below_K = std::max(worst_below_K, motor.now_C - under_test.motor_C());
    }
    CHECK(worst_below_K < 0.5);
    CHECK(motor.now_C > 70.0);
  }
}

namespace {
/// A board that stops its motors because of heat.
struct HotBoard : Telemetry {
  bool is_hot = false;
  bool is_overheated() const { return is_hot; }
};
}  // namespace

TEMPLATE_TEST_CASE("a board that says that it is overheated is told the least power, and why", "",
                   NominalGimbal, FixedGimbal) {
  TestType under_test;
  HotBoard telemetry;
  const auto step = [&] { return &under_test.gimbal.step(telemetry, 100); };
  step();
  CHECK(step()->reason[0] != LimitReason::board_overheated);
  telemetry.is_hot = true;
  CHECK(step()->reason[0] == LimitReason::board_overheated);
  CHECK(step()->power[0] == 1);
  telemetry.is_hot = false;
  CHECK(step()->reason[0] != LimitReason::board_overheated);
  CHECK(step()->power[0] < 250);  // and back at the ceiling's own pace
}
