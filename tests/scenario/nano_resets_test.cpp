// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Resets and losses of power in the middle of anything, a board that goes on driving meanwhile, and motors
// that are as hot as their own heat makes them: the two Nano programs on a simulated chip. The motor is the
// thesis's roll motor, written out; it shares no code with the library.
#include <algorithm>
#include <cmath>
#include <random>
#include <rig.hpp>

#include "../catch.hpp"
#include "journal_record.hpp"

namespace {

using nano::Rig;

constexpr double air_C = 40.0, limit_C = 60.0;

/// As the program has it (rounded constants) or as the regression does.
struct Motor {
  bool is_programmed;
  double now_C = air_C, hottest_C = air_C, before_s = 0.0;

  void spend(double time_s, int power) {
    const double seconds = time_s - before_s;
    before_s = time_s;
    const double volt = 13.0 * std::sqrt(power / 255.0);
    double rate_per_min = -0.11 * (now_C - air_C);
    if (volt > 1.0) {
      const double slope = is_programmed ? -0.0134 * volt * volt + 0.0156 * volt + 0.0167
                                         : -0.013445 * volt * volt + 0.015576 * volt + 0.016839;
      const double base =
          is_programmed ? 0.1551 * std::pow(volt, 3.4591) : 0.155098 * std::pow(volt, 3.459071);
      const double capacity =
          is_programmed ? (-0.0002 * volt + 0.0062) * now_C + 0.0255 * volt - 0.105
                        : (-0.00024249 * volt + 0.00620096) * now_C + 0.02545869 * volt - 0.10495822;
      rate_per_min += volt * std::max(0.0, slope * now_C + base) / 1000.0 / capacity;
    }
    now_C += rate_per_min / 60.0 * seconds;
    hottest_C = std::max(hottest_C, now_C);
  }
};

struct Gimbal {
  Motor motor;
  double angle_deg = -5.0;  // full demand
  Rig rig;

  explicit Gimbal(const std::string& program)
      : motor{program == "nano_gimbal.elf"},
        rig(std::string(NANO_PROGRAMS "/") + program, {}, [this](double time_s, Rig::Board& board) {
          motor.spend(time_s, board.power(0));
          Rig::Truth truth;
          truth.angle_deg[0] = angle_deg;
          truth.camera_air_C = truth.frame_air_C = air_C;
          return truth;
        }) {}
};

}  // namespace

TEST_CASE("resets and losses of power every 3 to 12 s at full demand do not overheat a motor") {
  const std::string program = GENERATE("nano_gimbal.elf", "gimbal_controller.elf");
  const bool is_power_lost = GENERATE(false, true);
  Gimbal gimbal(program);
  std::mt19937 random(7);
  double time_s = 0.0;
  while (time_s < 70.0) {
    time_s += std::uniform_real_distribution<double>(3.0, 12.0)(random);
    gimbal.rig.run_until(time_s);
    gimbal.rig.reset_chip(is_power_lost);
  }
  INFO(program << (is_power_lost ? ", power lost" : ", reset"));
  CHECK(gimbal.motor.hottest_C < limit_C + 1.0);
  // The corrected program, which starts from the worst case, waits; the other one drove it.
  if (gimbal.motor.is_programmed) CHECK(gimbal.motor.hottest_C > limit_C - 15.0);
}

TEST_CASE("twenty resets within four seconds cost less than a minute of power, and not nine") {
  const std::string program = GENERATE("nano_gimbal.elf", "gimbal_controller.elf");
  Gimbal gimbal(program);
  const auto record = journal_record(1, 42 + 60);
  for (std::uint16_t at = 0; at < 5; ++at) gimbal.rig.chip().set_eeprom(at, record[at]);
  // Little is asked for, so that the limit holds nothing back: 25 counts.
  gimbal.angle_deg = 0.0;
  gimbal.rig.run_until(20.0);
  for (int reset = 1; reset <= 20; ++reset) {
    gimbal.rig.run_until(20.0 + 0.2 * reset);
    gimbal.rig.reset_chip(false);
  }
  double back_s = 0.0;
  while (back_s < 60.0 && gimbal.rig.board().power(0) < 25) {
    back_s += 1.0;
    gimbal.rig.run_until(24.0 + back_s);
  }
  INFO(program << ": back after " << back_s << " s");
  CHECK(back_s < 60.0);
  CHECK(gimbal.motor.hottest_C < limit_C + 1.0);
}

TEST_CASE(
    "a motor that was hot when the power went starts hot; one whose store is empty as each program says") {
  Gimbal original("nano_gimbal.elf");
  original.rig.run_until(1.0);
  CHECK(original.rig.board().power(0) == 250);
  Gimbal corrected("gimbal_controller.elf");
  corrected.rig.run_until(1.0);
  CHECK(corrected.rig.board().power(0) < 60);

  const std::string program = GENERATE("nano_gimbal.elf", "gimbal_controller.elf");
  for (const int hottest_C : {42, 59, 75}) {
    Gimbal gimbal(program);
    const int code = hottest_C + 60;
    const auto record = journal_record(9, code);
    for (std::uint16_t at = 0; at < 5; ++at)
      gimbal.rig.chip().set_eeprom(static_cast<std::uint16_t>(30 + at), record[at]);
    gimbal.rig.run_until(2.0);
    INFO(program << " after " << hottest_C << " degC");
    if (hottest_C == 42) CHECK(gimbal.rig.board().power(0) >= 60);
    else CHECK(gimbal.rig.board().power(0) < 60);
  }
}

TEST_CASE("the watchdog is on, and a loop that goes round keeps it quiet") {
  const std::string program = GENERATE("nano_gimbal.elf", "gimbal_controller.elf");
  Gimbal gimbal(program);
  gimbal.rig.run_until(5.0);
  constexpr std::uint16_t wdtcsr = 0x60;
  CHECK((gimbal.rig.chip().data(wdtcsr) & 0x08) != 0);  // WDE: a reset, not an interrupt
  CHECK(gimbal.rig.updates().size() > 150);
  CHECK(gimbal.rig.unasked().empty());  // a restart would have sent one
}

TEST_CASE("a board that ignores commands is noticed") {
  const std::string program = "nano_gimbal.elf";
  Gimbal gimbal(program);
  gimbal.rig.run_until(20.0);
  gimbal.rig.board().faults.refuses_power = true;
  gimbal.rig.run_until(40.0);
  INFO(program);
  for (std::size_t axis = 0; axis < 3; ++axis) CHECK(gimbal.rig.updates().back().power[axis] == 1);
}
