// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The faults of the original that nano_gimbal does not repeat, and its rules for a link, a sensor or a
// battery that fails. Both Nano programs obey them.
#include <algorithm>
#include <cmath>
#include <rig.hpp>

#include "../catch.hpp"
#include "journal_record.hpp"
#include "nano_original.hpp"

namespace {

using nano::Rig;

/// A steady demand: full, three levels and least; air as given.
Rig::Truth steady(double air_C) {
  Rig::Truth truth;
  truth.angle_deg[0] = -1.5;
  truth.angle_deg[1] = 0.32;
  truth.camera_air_C = air_C;
  truth.frame_air_C = air_C;
  return truth;
}

Rig make_rig(
    const std::string& program, Rig::World world = [](double, Rig::Board&) { return steady(26); }) {
  // Without a record gimbal_controller starts as hot as the limit: it is told that the motors were cool.
  const bool is_corrected = program == "gimbal_controller.elf";
  const auto record = journal_record(1, 10 + 60);
  const std::vector<std::uint8_t> cool(record.begin(), record.end());
  return Rig(std::string(NANO_PROGRAMS "/") + program, {}, std::move(world),
             is_corrected ? cool : std::vector<std::uint8_t>());
}

bool is_least(const std::uint8_t (&power)[3]) { return power[0] == 1 && power[1] == 1 && power[2] == 1; }
bool is_demand(const std::uint8_t (&power)[3]) { return power[0] == 250 && power[1] == 75 && power[2] == 25; }

}  // namespace

TEST_CASE("only frames are on the wire, and one request at a time") {
  const std::string program = GENERATE("nano_gimbal.elf", "gimbal_controller.elf");
  Rig rig = make_rig(program);
  rig.run_until(5);
  REQUIRE(rig.updates().size() > 150);
  CHECK(is_demand(rig.updates().back().power));
  CHECK(rig.stray_bytes() == 0);
  CHECK(rig.board().received().skipped_bytes == 0);
  CHECK(rig.unanswered() == 0);
  CHECK(rig.requests() - rig.updates().size() <= 1);
  CHECK(rig.board().counters().variables_set == rig.updates().size());
  CHECK(rig.board().counters().shortest_request_gap_us >= 10000);
  CHECK(rig.chip().bytes_overrun() == 0);
  REQUIRE(rig.sees_core_buffers());
  CHECK(rig.fullest_receive_buffer() < 63);
}

TEST_CASE("a slow board is not asked again before its answer") {
  const std::string program = GENERATE("nano_gimbal.elf", "gimbal_controller.elf");
  Rig rig = make_rig(program);
  rig.board().faults.answer_delay_us = 18000;
  rig.run_until(5);
  CHECK(rig.updates().size() > 80);
  CHECK(rig.requests() - rig.updates().size() <= 1);
  CHECK(rig.board().counters().shortest_request_gap_us > 29000);
}

TEST_CASE("the power is the least until the first valid telemetry, and then what it asks for") {
  const std::string program = GENERATE("nano_gimbal.elf", "gimbal_controller.elf");
  Rig rig = make_rig(program);
  rig.board().faults.is_silent = true;
  rig.run_until(3);
  REQUIRE(rig.unasked().size() > 20);
  for (const nano::UnaskedCommand& command : rig.unasked()) CHECK(is_least(command.power));
  CHECK(rig.board().counters().shortest_request_gap_us >= 50000);
  rig.board().faults.is_silent = false;
  rig.run_until(3.2);
  REQUIRE(!rig.updates().empty());
  CHECK(is_demand(rig.updates().front().power));
}

TEST_CASE("a silent link leaves the command for half a second, then cuts the power; it returns gradually") {
  const std::string program = GENERATE("nano_gimbal.elf", "gimbal_controller.elf");
  Rig rig = make_rig(program);
  rig.run_until(2);
  REQUIRE(is_demand(rig.updates().back().power));
  const double last_s = rig.updates().back().time_s();
  rig.board().faults.is_silent = true;
  rig.run_until(last_s + 0.49);
  CHECK(rig.board().power(0) == 250);
  rig.run_until(last_s + 0.7);
  for (int axis = 0; axis < 3; ++axis) CHECK(rig.board().power(axis) == 1);
  rig.run_until(last_s + 3);
  for (int axis = 0; axis < 3; ++axis) CHECK(rig.board().power(axis) == 1);

  const std::size_t before = rig.updates().size();
  rig.board().faults.is_silent = false;
  rig.run_until(last_s + 12);
  const auto& updates = rig.updates();
  REQUIRE(updates.size() > before + 260);
  CHECK(updates[before].power[0] < 10);
  for (std::size_t index = before + 1; index < updates.size(); ++index)
    CHECK(int(updates[index].power[0]) - int(updates[index - 1].power[0]) <= 3);
  CHECK(is_demand(updates.back().power));
}

TEST_CASE("a missing frame IMU does not halve the air temperature") {
  // Air that no motor may be driven in: the original would see 31 degC and go on.
  Rig rig = make_rig("nano_gimbal.elf", [](double, Rig::Board&) { return steady(62); });
  rig.board().faults.is_frame_imu_missing = true;
  rig.run_until(1);
  REQUIRE(!rig.updates().empty());
  original::Program<float> program;
  for (const nano::Update& update : rig.updates()) {
    CHECK(is_least(update.power));
    CHECK(program.update(update.telemetry, static_cast<std::uint32_t>(update.last_in_cycle / 16)).power[0] ==
          250);
  }
}

TEST_CASE("implausible temperatures cut the power") {
  const std::string program = GENERATE("nano_gimbal.elf", "gimbal_controller.elf");
  const double air_C = GENERATE(-60.0, 110.0);
  bool is_broken = false;
  Rig rig = make_rig(program, [&](double, Rig::Board&) { return steady(is_broken ? air_C : 26); });
  rig.run_until(1);
  CHECK(is_demand(rig.updates().back().power));
  is_broken = true;
  rig.run_until(1.1);
  CHECK(is_least(rig.updates().back().power));
}

TEST_CASE("one implausible thermometer leaves the other") {
  Rig rig = make_rig("nano_gimbal.elf", [](double, Rig::Board&) {
    Rig::Truth truth = steady(26);
    truth.frame_air_C = -100;
    return truth;
  });
  rig.run_until(1);
  CHECK(is_demand(rig.updates().back().power));
}

TEST_CASE("a low battery is told the least power, where the original stopped talking") {
  const std::string program = GENERATE("nano_gimbal.elf", "gimbal_controller.elf");
  bool is_low = false;
  Rig rig = make_rig(program, [&](double, Rig::Board&) {
    Rig::Truth truth = steady(26);
    truth.battery_V = is_low ? 2.5 : 12.6;
    return truth;
  });
  rig.run_until(1);
  CHECK(is_demand(rig.updates().back().power));
  is_low = true;
  rig.run_until(1.2);
  CHECK(is_least(rig.updates().back().power));
  CHECK(rig.board().power(0) == 1);
}

TEST_CASE("damage on the line costs the damaged answers only") {
  const std::string program = GENERATE("nano_gimbal.elf", "gimbal_controller.elf");
  // Air that is cold enough for full power all the time, also where the sketch declares 30 degC.
  Rig rig = make_rig(program, [](double, Rig::Board&) { return steady(16); });
  rig.board().faults.lost_byte_rate = 0.0005;
  rig.board().faults.changed_byte_rate = 0.0005;
  rig.board().faults.noise_byte_rate = 0.0005;
  rig.run_until(12);
  CHECK(rig.board().counters().telemetry_sent > rig.updates().size() + 10);  // damage there was
  CHECK(rig.unanswered() == 0);
  CHECK(rig.stray_bytes() == 0);
  for (const nano::Update& update : rig.updates()) CHECK(update.power[0] >= 240);
}

TEST_CASE("time does not wrap after 65 ms") {
  // One answer in three is lost, so that updates lie 75 ms and more apart, and the motor is heated until the
  // limiter acts. The original's arithmetic with its 16-bit time believes the motor cooler than it is; with
  // true time it agrees with the chip.
  Rig rig = make_rig("nano_gimbal.elf", [](double time_s, Rig::Board& board) {
    board.faults.is_silent = std::fmod(time_s, 0.12) > 0.05;
    return steady(30);
  });
  rig.run_until(30);
  original::Program<float> wrapping;
  original::Program<float, false> true_time;
  long agreeing = 0, agreeing_wrapped = 0, long_cycles = 0;
  std::uint64_t before = 0;
  for (const nano::Update& update : rig.updates()) {
    const auto micros = static_cast<std::uint32_t>(update.last_in_cycle / 16);
    agreeing +=
        std::abs(int(true_time.update(update.telemetry, micros).power[0]) - int(update.power[0])) <= 2;
    agreeing_wrapped +=
        std::abs(int(wrapping.update(update.telemetry, micros).power[0]) - int(update.power[0])) <= 2;
    long_cycles += before != 0 && update.first_out_cycle - before > 65536 * 16;
    before = update.first_out_cycle;
  }
  const auto count = static_cast<long>(rig.updates().size());
  REQUIRE(long_cycles > 100);
  CHECK(agreeing * 100 >= count * 99);
  CHECK(agreeing_wrapped * 100 < count * 90);
}

TEST_CASE("time goes on when micros() wraps after 71.6 minutes") {
  const std::string program = GENERATE("nano_gimbal.elf", "gimbal_controller.elf");
  Rig rig = make_rig(program, [](double, Rig::Board&) { return steady(45); });
  // The core counts overflows of its timer, 1024 us each; micros() wraps at 2^22 of them. Start three seconds
  // before.
  rig.run_until(0.002);
  const auto count = rig.chip().elf().symbols.find("timer0_overflow_count");
  REQUIRE(count != rig.chip().elf().symbols.end());
  const std::uint32_t overflows = (1u << 22) - 3000;
  for (unsigned byte = 0; byte < 4; ++byte)
    rig.chip().set_data(static_cast<std::uint16_t>((count->second.address & 0xFFFFu) + byte),
                        static_cast<std::uint8_t>(overflows >> (8 * byte) & 0xFFu));
  rig.run_until(6);
  CHECK(rig.unasked().empty());
  REQUIRE(rig.updates().size() > 230);
  for (std::size_t index = 1; index < rig.updates().size(); ++index) {
    const auto cycles = rig.updates()[index].last_in_cycle - rig.updates()[index - 1].last_in_cycle;
    REQUIRE(cycles < 40 * 16000);
    // The ceiling moves by a count per update, or by 33 per second: a wrong time would let it jump.
    REQUIRE(std::abs(int(rig.updates()[index].power[0]) - int(rig.updates()[index - 1].power[0])) <= 2);
  }
  CHECK(rig.updates().back().power[0] < 250);
}

TEST_CASE("the answer comes in time in the cycle in which all three axes turn out to disobey") {
  // Full demand and none by turns, and a board that refuses now and then: what is in force is larger than what
  // was foreseen, in three axes at once, again and again.
  Rig rig = make_rig("nano_gimbal.elf", [](double time_s, Rig::Board& board) {
    Rig::Truth truth = steady(26);
    const bool is_full = std::fmod(time_s, 0.7) < 0.35;
    for (double& angle_deg : truth.angle_deg) angle_deg = is_full ? -5.0 : 0.0;
    board.faults.refuses_power = std::fmod(time_s, 0.9) < 0.3;
    return truth;
  });
  rig.run_until(40);
  REQUIRE(rig.updates().size() > 1000);
  std::uint64_t slowest = 0;
  int surprises = 0;
  for (std::size_t index = 2; index < rig.updates().size(); ++index) {
    const nano::Update& update = rig.updates()[index];
    slowest = std::max(slowest, update.response_cycles());
    bool is_all = true;
    for (std::uint8_t axis = 0; axis < 3; ++axis)
      is_all = is_all && update.telemetry.motor_power[axis] > rig.updates()[index - 1].power[axis];
    surprises += is_all ? 1 : 0;
  }
  CHECK(surprises > 10);  // or the test asks for nothing
  CHECK(slowest <= 7000);
}

TEST_CASE(
    "a board that reports no power is believed when it confirms or is read back, and not when it answers ERROR or nothing") {
  const std::string program = GENERATE("nano_gimbal.elf", "gimbal_controller.elf");
  const bool says_error = GENERATE(true, false);
  INFO(program << (says_error ? ", ERROR" : ", no answer"));
  Rig rig = make_rig(program);
  rig.board().faults.hides_power = true;
  rig.run_until(10);
  REQUIRE(is_demand(rig.updates().back().power));
  REQUIRE(rig.board().counters().confirmations > 100);

  auto& fault = says_error ? rig.board().faults.refuses_with_error : rig.board().faults.ignores_commands;
  fault = true;
  rig.run_until(10.45);
  CHECK(!is_least(rig.updates().back().power));  // half a second of it is tolerated
  rig.run_until(11);
  // A program that reads POWER back knows better: what it has sent is in force.
  const bool is_read_back = program == "gimbal_controller.elf";
  CHECK(is_least(rig.updates().back().power) == !is_read_back);
  CHECK((rig.board().counters().errors > 0) == says_error);
  REQUIRE(rig.board().power(0) == 250);
  // All the while the board holds 250 on roll, which takes it above 60 degC: a program that believed the 1 it
  // sent would take roll for cool, and give it the power back within seconds.
  rig.run_until(130);
  CHECK(is_least(rig.updates().back().power));
  fault = false;
  const std::size_t before = rig.updates().size();
  rig.run_until(140);
  const auto& updates = rig.updates();
  REQUIRE(updates.size() > before + 250);
  for (std::size_t index = before + 2; index < updates.size(); ++index) REQUIRE(updates[index].power[0] == 1);
  CHECK(updates.back().power[1] == 75);  // pitch was held at 75, which it bears
}
