// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// A board that obeys, but late, a count off or by a factor: the power comes back in the time that the documentation
// states, the estimate is never below the truth, and what is beyond the bounds is named.
#include <deque>

#include "../catch.hpp"
#include "failing_board.hpp"

namespace {

using namespace failing;

/// What a board makes of a command.
struct Habit {
  int late;        ///< Messages.
  double factor;   ///< In force, of the command.
  int more;        ///< Counts, besides.
  bool is_report;  ///< Only the report is so; in force is the command.
  int of(int sent) const {
    return std::min(255, std::max(1, static_cast<int>(std::lround(sent * factor)) + more));
  }
};

struct Outcome {
  double back_s = -1;          ///< From the end of the silence until full power is granted for good.
  double worst_below_K = 0;    ///< Most by which the estimate was below the truth.
  double disobeyed_share = 0;  ///< Share of the last half minute in which the reason was `not_obeyed`.
  double hottest_C = 0;
};

/// Full demand in air in which it is bearable, a second of silence after ten, a minute after that.
template <class Gimbal>
Outcome run(const Habit& habit, double dt_s, double minutes = 1.0, double supply_V = 8.0) {
  Gimbal under_test;
  Motor motor;
  Outcome outcome;
  std::deque<int> line(static_cast<std::size_t>(habit.late) + 1, 1);
  long cycles = 0, disobeyed = 0;
  const double end_s = 11.0 + 60.0 * minutes;
  for (double t = 0.0; t < end_s; t += dt_s) {
    const int in_force = habit.is_report ? line.back() : habit.of(line.front());
    motor.spend(in_force, supply_V, dt_s);
    Telemetry telemetry;
    telemetry.supply_V = supply_V;
    telemetry.reported = habit.of(line.front());
    const bool is_silent = t >= 10.0 && t < 11.0;
    const auto& command = is_silent ? under_test.step_silent(dt_s) : under_test.step(telemetry, dt_s);
    line.push_back(command.power[0]);
    line.pop_front();
    if (t > 1.0) outcome.worst_below_K = std::max(outcome.worst_below_K, motor.now_C - under_test.motor_C());
    outcome.hottest_C = std::max(outcome.hottest_C, motor.now_C);
    if (command.power[0] < 250) outcome.back_s = -1.0;
    else if (outcome.back_s < 0.0 && t > 11.0) outcome.back_s = t - 11.0;
    if (t < end_s - 30.0) continue;
    ++cycles;
    disobeyed += command.reason[0] == LimitReason::not_obeyed ? 1 : 0;
  }
  outcome.disobeyed_share = static_cast<double>(disobeyed) / static_cast<double>(cycles);
  return outcome;
}

/// From one end of the ceiling to the other at 33 counts a second, and a cycle or two.
constexpr double ramp_s = 7.6, timeout_s = 0.5;

}  // namespace

TEST_CASE("a board that is late by up to eight messages has its power back after the ramp") {
  for (const double dt_s : {0.01, 0.02, 0.03, 0.05, 0.1})
    for (int late = 0; late <= 8; ++late)
      for (const bool is_report : {false, true}) {
        CAPTURE(dt_s, late, is_report);
        const Outcome outcome = run<FloatGimbal>({late, 1.0, 0, is_report}, dt_s);
        // Should the delay be longer than what is tolerated, it is learned in the first fault.
        const double learned_s = late * dt_s > timeout_s ? timeout_s + 2 * late * dt_s + 1.0 : 0.0;
        CHECK(outcome.back_s >= 0.0);
        CHECK(outcome.back_s < ramp_s + learned_s + (late + 3) * dt_s);
        CHECK(outcome.disobeyed_share == 0.0);
        CHECK(outcome.worst_below_K < 0.1);
      }
}

TEST_CASE("a board that is a count or two off has its power back after the ramp") {
  for (const double dt_s : {0.02, 0.05})
    for (const int more : {-2, -1, 1, 2})
      for (const int late : {0, 1, 3, 5}) {
        CAPTURE(dt_s, more, late);
        const Outcome outcome = run<FloatGimbal>({late, 1.0, more, false}, dt_s);
        CHECK(outcome.back_s >= 0.0);
        CHECK(outcome.back_s < ramp_s + (late + 3) * dt_s);
        CHECK(outcome.disobeyed_share == 0.0);
        CHECK(outcome.worst_below_K < 0.1);
      }
}

TEST_CASE("a board that is off by a factor within the bounds is learned by one fault") {
  for (const double dt_s : {0.02, 0.05})
    for (const double factor : {0.26, 0.4, 0.5, 0.8, 0.95, 1.05, 1.25, 1.5, 1.95})
      for (const int late : {0, 2, 5})
        for (const bool is_report : {false, true}) {
          CAPTURE(dt_s, factor, late, is_report);
          const Outcome outcome = run<FloatGimbal>({late, factor, 0, is_report}, dt_s);
          CHECK(outcome.back_s >= 0.0);
          CHECK(outcome.back_s < ramp_s + (late + 3) * dt_s);
          CHECK(outcome.disobeyed_share == 0.0);
          CHECK(outcome.worst_below_K < 0.2);
        }
}

TEST_CASE("in whole numbers a late board, and one that is off, recover as well and are not believed cold") {
  for (const int late : {0, 1, 3, 8})
    for (const int more : {-1, 0, 1})
      for (const double factor : {0.5, 1.0, 1.5}) {
        CAPTURE(late, more, factor);
        const Outcome outcome = run<FixedGimbal>({late, factor, more, false}, 0.03, 1.0, 13.0);
        CHECK(outcome.disobeyed_share == 0.0);
        CHECK(outcome.worst_below_K < 0.1);
      }
}

TEST_CASE("what heats is what is in force: a board with a factor does not pass the limit") {
  for (const double factor : {1.25, 1.9})
    for (const int late : {0, 4}) {
      CAPTURE(factor, late);
      CHECK(run<FloatGimbal>({late, factor, 0, false}, 0.05, 10.0, 13.0).hottest_C < limit_C + 1.0);
    }
}

TEST_CASE("beyond the bounds a board is named: a factor of 0.1, and one that follows after a second") {
  CHECK(run<FloatGimbal>({0, 0.1, 0, false}, 0.03).disobeyed_share > 0.01);
  CHECK(run<FloatGimbal>({30, 1.0, 0, false}, 0.03).disobeyed_share > 0.01);
}

TEST_CASE("what is learned says so") {
  tp::PowerInForce<1> force;
  CHECK(force.delay() == 0);
  CHECK(force.scale_low(0) == 1.0f);
  CHECK(force.scale_high(0) == 1.0f);
  // Least power, then ramps of three counts a message up and down, three messages late, by 1.5.
  std::deque<int> line(4, 1);
  int sent = 1;
  bool is_obeyed = true;
  for (int message = 0; message < 200; ++message) {
    force.heard(0, static_cast<std::uint8_t>(line.front() * 1.5), static_cast<std::uint8_t>(sent));
    if (message > 20) is_obeyed = force.decided() && is_obeyed;
    else force.decided();
    line.push_back(sent);
    line.pop_front();
    if (message > 12) sent += message / 50 % 2 == 0 ? 3 : -2;
  }
  CHECK(is_obeyed);
  CHECK(force.delay() >= 3);
  CHECK(force.delay() <= 8);
  CHECK(force.scale_low(0) <= 1.5f);
  CHECK(force.scale_high(0) >= 1.49f);
  CHECK(force.scale_low(0) > 1.4f);
  CHECK(force.scale_high(0) < 1.6f);
}

TEST_CASE("a board that holds what it had is named within the time-out, whatever it had learned before") {
  for (const int late : {0, 3}) {
    CAPTURE(late);
    tp::PowerInForce<1> force;
    std::deque<int> line(static_cast<std::size_t>(late) + 1, 200);
    std::uint8_t sent = 200;
    for (int message = 0; message < 40; ++message) {
      force.heard(0, static_cast<std::uint8_t>(line.front()), sent);
      force.decided();
      sent = static_cast<std::uint8_t>(message % 20 < 10 ? 100 : 200);
      line.push_back(sent);
      line.pop_front();
    }
    // From here on it holds 200 and is told 150; then nothing it was told explains it.
    int disobeyed = 0;
    for (int message = 0; message < 20; ++message) {
      CHECK(force.heard(0, 200, 150) >= 200);
      disobeyed += force.decided() ? 0 : 1;
    }
    CHECK(disobeyed >= 20 - 8 - late);
  }
}

TEST_CASE("only the CONFIRM of a command that sets POWER says that the POWER is in force") {
  tp::PowerInForce<1> force;
  const auto of_power = confirm_of(tp::sbgc::command::set_adj_vars_val);
  for (int message = 0; message < 20; ++message) {
    force.confirmed(of_power);
    force.heard(0, 0, 250);
    REQUIRE(force.decided());
  }
  for (const std::uint8_t other : {tp::sbgc::command::control, tp::sbgc::command::motors_on,
                                   tp::sbgc::command::reset, tp::sbgc::command::data_stream_interval}) {
    force.confirmed(confirm_of(other));
    CHECK(force.heard(0, 0, 1) == 250);
    CHECK_FALSE(force.decided());
  }
  force.confirmed(of_power);
  force.heard(0, 0, 1);
  CHECK(force.decided());
  CHECK(force.expected(0, 1) == 1);
  // A program that sets variables of its own says so: the first CONFIRM is then not known to be of the POWER.
  force.other_sent();
  force.confirmed(of_power);
  force.heard(0, 0, 10);
  CHECK_FALSE(force.decided());
  force.other_sent();
  force.confirmed(of_power);
  force.confirmed(of_power);
  force.heard(0, 0, 10);
  CHECK(force.decided());
}

TEMPLATE_TEST_CASE("a board that loses POWER and confirms what else it is told is believed hot", "",
                   FloatGimbal, FixedGimbal) {
  // It reports no POWER, holds 250 after six seconds, and confirms a CONTROL with every message.
  TestType under_test;
  Motor motor;
  bool is_named = false;
  int power = 1;
  for (int cycle = 0; cycle < 10000; ++cycle) {
    Telemetry telemetry;
    telemetry.error = cycle < 200 ? 5.0 : 0.0;
    const bool is_lost = cycle >= 200;
    under_test.gimbal.confirmed(
        confirm_of(is_lost ? tp::sbgc::command::control : tp::sbgc::command::set_adj_vars_val));
    const auto& command = under_test.step(telemetry);
    if (!is_lost) power = command.power[0];
    motor.spend(power, 13.0);
    is_named = is_named || command.reason[0] == LimitReason::not_obeyed;
    if (cycle > 100) REQUIRE(under_test.motor_C() > motor.now_C - 0.5);
  }
  CHECK(is_named);
  CHECK(motor.now_C > 100.0);
}

TEMPLATE_TEST_CASE("a board that confirms POWER and does not obey is found by reading POWER back", "",
                   FloatGimbal, FixedGimbal) {
  // It reports no POWER, holds 250 after six seconds, and confirms every command.
  for (const bool is_asked : {true, false}) {
    TestType under_test;
    Motor motor;
    int power = 1;
    long named = 0;
    for (int cycle = 0; cycle < 10000; ++cycle) {
      Telemetry telemetry;
      telemetry.error = cycle < 200 ? 5.0 : 0.0;
      under_test.gimbal.confirmed(confirm_of(tp::sbgc::command::set_adj_vars_val));
      if (is_asked) {
        // The board's answer to GET_ADJ_VARS_VAL, as it comes over the wire.
        const std::uint8_t payload[] = {
            1, tp::sbgc::variable::power_roll, static_cast<std::uint8_t>(power), 0, 0, 0};
        const tp::sbgc::Frame answer = {tp::sbgc::command::set_adj_vars_val, sizeof payload, payload,
                                        tp::sbgc::Version::v1};
        REQUIRE(tp::sbgc::hear_power(answer, under_test.gimbal));
      }
      const auto& command = under_test.step(telemetry);
      if (cycle < 200) power = command.power[0];
      motor.spend(power, 13.0);
      named += cycle >= 200 && command.reason[0] == LimitReason::not_obeyed ? 1 : 0;
      if (is_asked && cycle > 100) REQUIRE(under_test.motor_C() > motor.now_C - 0.5);
    }
    CAPTURE(is_asked);
    CHECK(motor.now_C > 100.0);
    CHECK((named > 9000) == is_asked);
  }
}

TEST_CASE("once POWER was read back, CONFIRM no longer counts, and a board that obeys keeps its power") {
  tp::PowerInForce<1> force;
  const auto of_power = confirm_of(tp::sbgc::command::set_adj_vars_val);
  for (int message = 0; message < 20; ++message) {
    force.confirmed(of_power);
    force.read_back(0, 200);
    CHECK(force.heard(0, 0, 200) == 200);
    REQUIRE(force.decided());
  }
  force.confirmed(of_power);
  CHECK(force.heard(0, 0, 10) == 200);
  CHECK_FALSE(force.decided());
  force.read_back(0, 10);
  force.heard(0, 0, 10);
  CHECK(force.decided());
  force.read_back(7, 10);  // an axis that there is not
}

TEST_CASE("an answer of the board reaches a gimbal by hear_answer") {
  struct Heard {
    int confirms = 0, errors = 0;
    void confirmed(const tp::sbgc::Confirm& confirm) { confirms += confirm.is_of_power() ? 1 : 0; }
    void refused() { ++errors; }
  } heard;
  const std::uint8_t bytes[15] = {31};
  const auto frame = [&](std::uint8_t id, std::uint8_t size) {
    return tp::sbgc::Frame{id, size, bytes, tp::sbgc::Version::v1};
  };
  CHECK(tp::sbgc::hear_answer(frame(67, 1), heard));
  CHECK(heard.confirms == 1);
  CHECK_FALSE(tp::sbgc::hear_answer(frame(67, 15), heard));  // a CONTROL on a line that two listen to
  CHECK_FALSE(tp::sbgc::hear_answer(frame(25, 15), heard));
  CHECK(tp::sbgc::hear_answer(frame(255, 5), heard));
  CHECK(heard.confirms == 1);
  CHECK(heard.errors == 1);
}
