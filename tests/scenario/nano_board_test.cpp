// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The emulated board speaks the real protocol at the real pace.
#include <limits>
#include <thermopower/simulation/emulated_board.hpp>
#include <vector>

#include "../catch.hpp"

namespace {

namespace sbgc = thermopower::sbgc;
namespace sim = thermopower::simulation;

/// The controller's end of the line.
template <class Protocol = sbgc::ProtocolV1>
struct Controller {
  explicit Controller(sim::EmulatedBoard& other_end) : board(other_end) {}

  sim::EmulatedBoard& board;
  thermopower::SbgcCodec<255, Protocol> codec;
  double first_us = 0, last_us = 0;  // of the frame found last

  template <class Message>
  void send(const Message& message, double end_us) {
    std::uint8_t bytes[261];
    const std::size_t size = codec.encode(message, bytes, sizeof bytes);
    REQUIRE(size > 0);
    for (std::size_t at = 0; at < size; ++at) board.receive(bytes[at], end_us);
  }

  /// The next frame that arrives by a time, or none.
  bool hear(double until_us) {
    sim::LineByte byte;
    bool is_first = true;
    while (board.transmit(until_us, byte)) {
      if (is_first) first_us = byte.end_us;
      is_first = false;
      last_us = byte.end_us;
      if (codec.receive(byte.value, static_cast<std::uint32_t>(byte.end_us))) return true;
    }
    return false;
  }
};

sim::BoardTruth some_truth() {
  sim::BoardTruth truth;
  truth.angle_deg[0] = 10.01;
  truth.angle_deg[2] = -500;
  truth.target_deg[0] = 12;
  truth.camera_air_C = 31.4;
  truth.frame_air_C = 28.6;
  truth.battery_V = 12.345;
  truth.current_A = 1.2346;
  return truth;
}

}  // namespace

TEST_CASE("telemetry has the board's resolution and takes 11.2 ms on the wire") {
  sim::EmulatedBoard board;
  Controller<> controller(board);
  controller.send(sbgc::Request(sbgc::command::realtime_data_4), 3000);
  board.step(7999, some_truth());
  CHECK_FALSE(controller.hear(1e9));
  board.step(8000, some_truth());
  REQUIRE(controller.hear(1e9));
  CHECK(controller.first_us == Approx(8000 + 1e6 * 10 / 115200));
  CHECK(controller.last_us - 8000 == Approx(129 * 1e6 * 10 / 115200));
  const sbgc::RealtimeData* data = controller.codec.realtime_data();
  REQUIRE(data != nullptr);
  CHECK(data->imu_angle(0) == 456);  // 10.01 deg is 455.57 units
  CHECK(data->imu_angle(2) == -22756);
  CHECK(data->target_angle(0) == 546);
  CHECK(data->imu_C() == 31);
  CHECK(data->frame_imu_C() == 29);
  CHECK(data->battery_cV() == 1235);
  CHECK(data->current_mA() == 1235);
  CHECK(data->motors_on());
}

TEST_CASE("what does not fit a field reads as its end, and NaN as 0") {
  sim::BoardTruth truth;
  truth.angle_deg[0] = 1e9;
  truth.camera_air_C = -500;
  truth.battery_V = std::numeric_limits<double>::quiet_NaN();
  const sbgc::RealtimeFields fields = sim::measured(truth, {});
  CHECK(fields.imu_angle[0] == 32767);
  CHECK(fields.imu_C == -128);
  CHECK(fields.battery_cV == 0);
}

TEST_CASE("variables are set, confirmed and reported, in either protocol version") {
  sim::EmulatedBoard board;
  Controller<sbgc::ProtocolV2> controller(board);
  const struct { std::uint8_t power[3], p_gain[3]; } command = {{25, 50, 75}, {22, 100, 36}};
  controller.send(sbgc::power_and_gain(command), 100);
  board.step(0, {});
  CHECK(board.power(1) == 150);
  board.step(8000, {});
  CHECK(board.power(1) == 50);
  CHECK(board.p_gain(2) == 36);
  REQUIRE(controller.hear(1e9));
  sbgc::Confirm confirmation;
  REQUIRE(controller.codec.read(confirmation));
  CHECK(confirmation.confirmed_id == sbgc::command::set_adj_vars_val);

  controller.send(sbgc::GetAdjVars<2>{{sbgc::variable::power_yaw, sbgc::variable::p_roll}}, 9000);
  board.step(16000, {});
  REQUIRE(controller.hear(1e9));
  sbgc::AdjVarsView vars;
  REQUIRE(controller.codec.read(vars));
  REQUIRE(vars.count() == 2);
  CHECK(vars[0].value == 75);
  CHECK(vars[1].value == 22);
}

TEST_CASE("values that no variable can hold are refused") {
  sim::EmulatedBoard board;
  Controller<> controller(board);
  sbgc::SetAdjVars<2> message = {{{sbgc::variable::power_roll, 256}, {200, 1}}};
  controller.send(message, 0);
  board.step(0, {});
  CHECK(board.power(0) == 150);
  CHECK(board.counters().refused_variables == 2);
}

TEST_CASE("board information, motors and streams") {
  sim::EmulatedBoard board;
  Controller<> controller(board);
  controller.send(sbgc::Request(sbgc::command::board_info), 0);
  controller.send(sbgc::MotorsOff(), 0);
  sbgc::DataStreamInterval stream;
  stream.streamed_id = sbgc::command::realtime_data_3;
  stream.interval_ms = 40;
  controller.send(stream, 0);
  for (double now_us = 0; now_us <= 400000; now_us += 8000) board.step(now_us, {});
  CHECK_FALSE(board.motors_on());
  CHECK(board.counters().confirmations == 2);
  CHECK(board.counters().telemetry_sent == 11);
  REQUIRE(controller.hear(1e9));
  sbgc::BoardInfo info;
  REQUIRE(controller.codec.read(info));
  CHECK(info.firmware_version == 2687);
}

TEST_CASE("faults: silence, deafness, a missing frame IMU, wrong scales, damage") {
  sim::EmulatedBoard board;
  Controller<> controller(board);
  const auto ask = [&] {
    controller.send(sbgc::Request(sbgc::command::realtime_data_4), board.next_parse_us());
    board.step(board.next_parse_us(), some_truth());
    return controller.hear(1e12);
  };
  CHECK(ask());
  board.faults.is_frame_imu_missing = true;
  board.faults.angle_scale = 2;
  REQUIRE(ask());
  CHECK(controller.codec.realtime_data()->frame_imu_C() == 0);
  CHECK(controller.codec.realtime_data()->target_angle(0) == 1092);
  board.faults = {};
  board.faults.is_silent = true;
  CHECK_FALSE(ask());
  CHECK(board.counters().telemetry_sent == 3);
  board.faults = {};
  board.faults.is_deaf = true;
  CHECK_FALSE(ask());
  CHECK(board.counters().telemetry_sent == 3);
  board.faults = {};
  board.faults.changed_byte_rate = 0.02;
  int whole = 0;
  for (int round = 0; round < 50; ++round) whole += ask();
  CHECK(whole > 0);
  CHECK(whole < 20);  // 129 bytes all unharmed: 7 %
}

TEST_CASE("a board that cannot be is refused by its field's name") {
  sim::BoardConfig config;
  config.baud = 0;
  CHECK_THROWS_WITH(sim::EmulatedBoard(config), ContainsSubstring("baud"));
  config = {};
  config.bits_per_byte = 9;
  CHECK_THROWS_WITH(sim::EmulatedBoard(config), ContainsSubstring("bits_per_byte"));
}
