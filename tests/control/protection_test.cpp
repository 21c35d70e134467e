// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// What a board, a link, a thermometer or a supply that fails does to motors that are protected by what the
// controller believes. The motors here are written out from the thesis's tables and share no code with the
// library; each case is a failure that once overheated them or took the power for an hour.
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "../catch.hpp"
#include "failing_board.hpp"

namespace {

using namespace failing;

/// A board at the other end, with what may be wrong with it.
struct Board {
  int power = 150;
  bool ignores = false, is_dead = false, reports = true, confirms = false;
};

struct Run {
  double hottest_C = 0, worst_below_K = 0;  ///< Hottest; most by which the estimate was below the truth.
  double power = 0;                         ///< Granted last.
  LimitReason reason = LimitReason::none;
  double first_reason_s = -1;  ///< When the reason asked for came first.
};

/// @param happens  called before every cycle with the time
template <class Gimbal>
Run run(double seconds, Gimbal& under_test, Motor& motor, Board& board,
        const std::function<void(double, Board&, Telemetry&)>& happens,
        LimitReason wanted = LimitReason::none) {
  Run result;
  for (double t = 0.0; t < seconds; t += cycle_s) {
    Telemetry telemetry;
    happens(t, board, telemetry);
    telemetry.reported = board.reports ? board.power : 0;
    const auto& command = board.is_dead ? under_test.step_silent() : under_test.step(telemetry);
    if (!board.ignores && !board.is_dead) {
      board.power = command.power[0];
      if (board.confirms) under_test.gimbal.confirmed(confirm_of(tp::sbgc::command::set_adj_vars_val));
    }
    motor.spend(board.power, 13.0);
    result.hottest_C = std::max(result.hottest_C, motor.now_C);
    if (t > 1.0) result.worst_below_K = std::max(result.worst_below_K, motor.now_C - under_test.motor_C());
    result.power = command.power[0];
    result.reason = command.reason[0];
    if (result.first_reason_s < 0 && command.reason[0] == wanted) result.first_reason_s = t;
  }
  return result;
}

void nothing(double, Board&, Telemetry&) {}

}  // namespace

TEMPLATE_TEST_CASE("a board that obeys: the limit holds and no fault is named", "", FloatGimbal,
                   FixedGimbal) {
  TestType under_test;
  Motor motor;
  Board board;
  const Run result = run(600, under_test, motor, board, nothing, LimitReason::not_obeyed);
  CHECK(result.hottest_C < limit_C + 1.0);
  CHECK(result.hottest_C > limit_C - 6.0);
  CHECK(result.worst_below_K < 0.5);
  CHECK(result.first_reason_s < 0);
}

TEMPLATE_TEST_CASE("a board that ignores its commands is named, and its motor is believed as hot as it is",
                   "", FloatGimbal, FixedGimbal) {
  TestType under_test;
  Motor motor;
  Board board;
  const auto stuck = [](double t, Board& at, Telemetry& telemetry) {
    if (t >= 10.0 && !at.ignores) at.ignores = true, at.power = 250;
    if (t >= 10.0) telemetry.error = 0.1;  // so that 25 would do
  };
  const Run result = run(150, under_test, motor, board, stuck, LimitReason::not_obeyed);
  CHECK(result.first_reason_s > 10.0);
  CHECK(result.first_reason_s < 10.7);
  CHECK(result.power == 1);
  CHECK(result.worst_below_K < 0.5);
  REQUIRE(motor.now_C > limit_C);
  // It obeys again: the power stays away until the motor is cool, and comes back.
  board.ignores = false;
  double first_power_C = 0.0;
  const Run after = run(900, under_test, motor, board, [&](double t, Board& at, Telemetry&) {
    if (first_power_C == 0.0 && t > 1.0 && at.power > 100) first_power_C = motor.now_C;
  });
  CHECK(after.reason != LimitReason::not_obeyed);
  CHECK(first_power_C < limit_C + 1.0);
}

TEMPLATE_TEST_CASE("a board that reports no power is believed when it confirms, and not when it stops to", "",
                   FloatGimbal, FixedGimbal) {
  TestType under_test;
  Motor motor;
  Board board;
  board.reports = false;
  board.confirms = true;
  const Run well = run(60, under_test, motor, board, nothing, LimitReason::not_obeyed);
  CHECK(well.first_reason_s < 0);
  board.ignores = true;  // holds what it had
  const Run refused = run(
      60, under_test, motor, board, [](double, Board&, Telemetry& telemetry) { telemetry.error = 0.1; },
      LimitReason::not_obeyed);
  CHECK(refused.first_reason_s > 0.4);
  CHECK(refused.first_reason_s < 0.7);
  CHECK(refused.worst_below_K < 0.5);
}

TEMPLATE_TEST_CASE("a dead link may leave any power in force, and the estimate says so", "", FloatGimbal,
                   FixedGimbal) {
  TestType under_test;
  Motor motor;
  Board board;
  run(10, under_test, motor, board, nothing);
  // The board restarts behind the dead link, with its own POWER.
  board.is_dead = true;
  board.power = 255;
  const Run dead = run(240, under_test, motor, board, nothing, LimitReason::link_silent);
  CHECK(dead.first_reason_s < 0.6);
  CHECK(dead.worst_below_K < 0.5);
  REQUIRE(motor.now_C > limit_C + 20.0);
  board.is_dead = false;
  const double before_C = motor.now_C;
  const Run back = run(60, under_test, motor, board, nothing);
  CHECK(back.hottest_C < before_C + 0.5);
  CHECK(back.power == 1);
}

TEMPLATE_TEST_CASE("a board that restarts with a POWER of its own heats by that", "", FloatGimbal,
                   FixedGimbal) {
  TestType under_test;
  Motor motor;
  Board board;
  // Every second cycle: between two commands the POWER is the board's own.
  long cycle = 0;
  const Run result = run(600, under_test, motor, board, [&](double, Board& at, Telemetry& telemetry) {
    telemetry.error = 0.1;
    if (++cycle % 2 == 0) at.power = 255;
  });
  CHECK(result.worst_below_K < 0.5);
}

TEMPLATE_TEST_CASE("thermometers that wake up late do not make a motor cold", "", FloatGimbal, FixedGimbal) {
  for (const int first_C : {0, -3}) {
    INFO("first answers read " << first_C << " degC");
    TestType under_test;
    Motor motor;
    Board board;
    long answers = 0;
    const Run result = run(600, under_test, motor, board, [&](double, Board&, Telemetry& telemetry) {
      if (++answers <= 3) telemetry.camera = telemetry.frame = first_C;
    });
    CHECK(result.hottest_C < limit_C + 1.0);
    CHECK(result.worst_below_K < 1.0);
  }
}

TEMPLATE_TEST_CASE("a frame thermometer that wakes up late, or breaks in motion, does not cool the air", "",
                   FloatGimbal, FixedGimbal) {
  TestType under_test;
  Motor motor;
  Board board;
  const Run result = run(600, under_test, motor, board, [&](double t, Board&, Telemetry& telemetry) {
    if (t < 5.0 || t > 300.0) telemetry.frame = 0;
  });
  CHECK(result.hottest_C < limit_C + 1.0);
  CHECK(result.worst_below_K < 0.5);
}

TEST_CASE("an absurd supply reading is named and costs seconds, not an hour") {
  FloatGimbal under_test;
  Motor motor;
  Board board;
  double full_again_s = -1.0;
  const Run result = run(
      60, under_test, motor, board,
      [&](double t, Board& at, Telemetry& telemetry) {
        if (t >= 10.0 && t < 10.0 + cycle_s) telemetry.supply_V = 655.35;
        if (t > 10.2 && full_again_s < 0.0 && at.power == 250) full_again_s = t;
      },
      LimitReason::supply_implausible);
  CHECK(result.first_reason_s == Approx(10.0).margin(0.05));
  CHECK(full_again_s > 10.0);
  CHECK(full_again_s < 19.0);
  CHECK(result.worst_below_K < 0.5);
}

TEST_CASE("a certified axis has its limiter's time without a plan, whatever the gimbal tolerates") {
  typedef tp::CertifiedLimiter<tp::CertifiedOneNode> Limiter;
  typedef tp::AxisController<tp::motors::Bgm2606_90t, tp::StepPowerLaw<>, Limiter> Axis;
  Axis::Config config = Axis::Config::with_gain({24.0f, 4.0f});
  config.limiter.use.hold_s = 0.1f;
  tp::GimbalController<Axis> gimbal(tp::GimbalConfig::believing(), config);
  config.limiter.use.hold_s = 2.0f;
  tp::GimbalController<Axis> patient(tp::GimbalConfig::believing(), config);
  // Whatever the limiter itself says: the bounds are not set here, and an axis that is refused stays cut.
  CHECK(gimbal.axis<0>().limiter().hold_s() == 0.1f);
  CHECK(patient.axis<0>().limiter().hold_s() == 2.0f);
}

TEST_CASE("in the cold: the corrected laws heat where the programmed law is blind") {
  // Air of 1 degC: 1/r = 0.2435 T - 0.4952 as programmed is negative, and the motor never warms.
  const auto blind = tp::motors::Bgm5208_200_12::AsProgrammed::heating_law<double>();
  CHECK(blind.rise_K_per_J(12.9, 1.0) == 0.0);
  for (double motor_C = -40.0; motor_C <= 100.0; motor_C += 0.5)
    for (double v_rms_V = 4.0; v_rms_V <= 13.0; v_rms_V += 0.05) {
      CAPTURE(motor_C, v_rms_V);
      REQUIRE(tp::motors::Bgm5208_200_12::heating_law<double>().rise_K_per_J(v_rms_V, motor_C) > 0.0);
      REQUIRE(tp::motors::Bgm2606_90t::heating_law<double>().rise_K_per_J(v_rms_V, motor_C) > 0.0);
      // And in whole numbers.
      const auto level = static_cast<std::uint8_t>(v_rms_V * v_rms_V / 169.0 * 255.0);
      const auto coarse = static_cast<fixed::CoarseTemperature>(motor_C * 128.0);
      REQUIRE(fixed::Heating<fixed::ThesisMotor<tp::motors::Bgm2606_90t>>::rate(level, coarse) > 0);
      // (Below 8 V the current law of the larger motor, not its heating, ends in zero when warm: under 0.2 W.)
      if (v_rms_V >= 8.0)
        REQUIRE(fixed::Heating<fixed::ThesisMotor<tp::motors::Bgm5208_200_12>>::rate(level, coarse) > 0);
    }
}

TEST_CASE("three axes that disobey at once are never believed colder than they are, nor much hotter") {
  typedef fixed::AxisController<fixed::ThermalModel<fixed::ThesisMotor<tp::motors::Bgm2606_90t>>> Axis;
  fixed::BasicGimbalController<fixed::BelievingGimbal, Axis, Axis, Axis> gimbal;
  fixed::Clock clock;
  std::uint32_t now_us = 0;
  Motor motor;
  int power = 1;
  double worst_below_K = 0.0, worst_above_K = 0.0;
  // The demand goes up and down every half a second, and the board refuses every third of them.
  for (int cycle = 0; cycle < 4000; ++cycle) {
    Telemetry telemetry;
    telemetry.error = cycle / 16 % 2 == 0 ? 5.0 : 0.0;
    telemetry.reported = power;
    gimbal.step(telemetry, clock.elapsed(now_us += static_cast<std::uint32_t>(cycle_s * 1e6)));
    gimbal.prepare();
    if (cycle / 16 % 3 != 0) power = gimbal.command().power[0];
    const double believed_C[] = {static_cast<double>(gimbal.axis<0>().thermal().motor_C()),
                                 static_cast<double>(gimbal.axis<1>().thermal().motor_C()),
                                 static_cast<double>(gimbal.axis<2>().thermal().motor_C())};
    for (const double one_C : believed_C) {
      worst_below_K = std::max(worst_below_K, motor.now_C - one_C);
      worst_above_K = std::max(worst_above_K, one_C - motor.now_C);
    }
    motor.spend(power, 13.0);
  }
  INFO("below by " << worst_below_K << " K, above by " << worst_above_K << " K, motor " << motor.now_C);
  CHECK(worst_below_K < 0.1);  // what the arithmetic is off by, and a cycle
  CHECK(worst_above_K < 10.0);
  CHECK(motor.now_C > air_C + 5.0);
}

// The figures of docs/explain/faults-and-reasons.md: `control_protection "what a declared air costs" -s`.
TEST_CASE("what a declared air costs: each kelvin that the air is declared warmer than it is takes power") {
  typedef tp::AxisController<tp::motors::Bgm2606_90t> Axis;
  double before = 1e9;
  std::string table;
  for (const float warmest_C : {-1.0f, 30.0f, 35.0f, 40.0f, 45.0f}) {
    tp::GimbalConfig config = tp::GimbalConfig::believing();
    if (warmest_C > 0.0f) config.air = tp::AirTemperature::Config::declared(warmest_C);
    tp::GimbalController<Axis> gimbal(config, Axis::Config::with_gain({24.0f, 4.0f}));
    Motor motor;
    Telemetry telemetry;
    double granted = 0.0;
    const int steps = static_cast<int>(3600.0 / cycle_s);
    for (int i = 0; i < steps; ++i) {
      telemetry.reported = i == 0 ? 1 : gimbal.state().command.power[0];
      motor.spend(telemetry.reported, 13.0);
      granted += gimbal.step(telemetry, static_cast<float>(cycle_s)).power[0];
    }
    CHECK(motor.now_C < limit_C + 0.5);
    CHECK(granted < before);
    before = granted;
    table += (warmest_C > 0.0f ? "declared " + std::to_string(static_cast<int>(warmest_C))
                               : std::string("believed")) +
             ": mean POWER " + std::to_string(granted / steps) + ", motor " + std::to_string(motor.now_C) +
             " degC\n";
  }
  INFO(table);
  CHECK(before > 0.0);
}
