// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The examples on the pages of the wire's classes, and what each of them must give.

#include "../../catch.hpp"

#include <thermopower/thermopower.hpp>

#include <vector>

namespace tp = thermopower;
namespace sbgc = thermopower::sbgc;

namespace {

/// Stands for a serial port: what one end writes, the other reads.
struct Port {
  std::vector<uint8_t> bytes;
  size_t write(const uint8_t* data, size_t size) {
    bytes.insert(bytes.end(), data, data + size);
    return size;
  }
};

/// Everything in a port through a codec; each frame is shown to `seen`.
template <class Codec, class Seen>
void read_all(const Port& port, Codec& codec, Seen&& seen) {
  for (const uint8_t byte : port.bytes)
    for (bool got = codec.receive(byte, 0); got; got = codec.next()) seen(codec);
}

}  // namespace

TEST_CASE("a codec at each end of a line") {
  Port serial, answer;
  //! [codec]
  tp::SbgcCodec<> codec;  // protocol 1; tp::SbgcCodec<124, sbgc::ProtocolV2> for boards that speak 2
  codec.send(sbgc::Request(sbgc::command::realtime_data_4), serial);  // anything with write(bytes, size)
  //! [codec]
  //! [emulated]
  sbgc::RealtimeFields fields;  // what a board would say, to try a controller without one
  fields.imu_C = 26;
  fields.battery_cV = 1260;
  fields.target_angle[0] = 23;  // 360/16384 degree
  tp::SbgcCodec<> board;
  board.send(fields, answer);
  //! [emulated]
  float error_deg = 0.0f, battery_V = 0.0f;
  //! [telemetry]
  const auto on_byte = [&](uint8_t byte, uint32_t now_us) {
    for (bool got = codec.receive(byte, now_us); got; got = codec.next())
      if (const sbgc::RealtimeData* telemetry = codec.realtime_data()) {  // a view: nothing is copied
        error_deg = telemetry->error_deg(0);
        battery_V = telemetry->battery_V();
      }
  };
  //! [telemetry]
  for (const uint8_t byte : answer.bytes) on_byte(byte, 0);
  CHECK(error_deg == Approx(23.0 * 360.0 / 16384.0));
  CHECK(battery_V == Approx(12.6));
  int asked = 0;
  read_all(serial, board, [&](auto& end) {
    sbgc::Request request;
    if (end.read(request) && request.requested_id == sbgc::command::realtime_data_4) ++asked;
  });
  CHECK(asked == 1);
}

TEST_CASE("POWER and P of three axes, and what the board says to them") {
  Port serial;
  struct Command {
    uint8_t power[3], p_gain[3];
  };
  tp::SbgcCodec<> codec;
  //! [power and gain]
  const Command command = {{125, 25, 200}, {14, 22, 8}};  // a gimbal controller's command has these members
  codec.send(sbgc::PowerAndGain<Command>(command), serial);
  //! [power and gain]
  //! [adjustable variables]
  sbgc::SetAdjVars<2> set = {
      {{sbgc::variable::power_roll, 125}, {sbgc::variable::p_roll, 14}}};  // each an AdjVar
  codec.send(set, serial);
  sbgc::GetAdjVars<1> get = {{sbgc::variable::power_roll}};
  codec.send(get, serial);
  //! [adjustable variables]
  std::vector<int32_t> told;
  int asked = 0;
  tp::SbgcCodec<> board;
  read_all(serial, board, [&](auto& end) {
    //! [views of variables]
    sbgc::AdjVarsView variables;  // any number of them, not copied
    sbgc::GetAdjVarsView wanted;
    int32_t power = 0;
    if (end.read(variables) && variables.find(sbgc::variable::power_roll, power)) told.push_back(power);
    else if (end.read(wanted)) asked += wanted.ids.size;
    //! [views of variables]
  });
  CHECK(told == std::vector<int32_t>{125, 125});
  CHECK(asked == 1);
}

TEST_CASE("short commands, motion, answers") {
  Port serial;
  tp::SbgcCodec<> codec;
  //! [commands]
  codec.send(sbgc::MotorsOn(), serial);
  codec.send(sbgc::MotorsOff(), serial);
  codec.send(sbgc::Reset(), serial);
  sbgc::DataStreamInterval stream;  // telemetry without asking
  stream.streamed_id = sbgc::command::realtime_data_4;
  stream.interval_ms = 30;
  codec.send(stream, serial);
  const uint8_t payload[2] = {1, 2};
  codec.send(sbgc::Raw{200, {payload, 2}}, serial);  // any command that has no type here
  //! [commands]
  //! [control]
  sbgc::Control move;
  move.axis[2].mode = sbgc::control_mode::angle;
  move.axis[2].angle = sbgc::angle_units(30.0f);  // yaw to 30 degrees
  codec.send(move, serial);
  //! [control]
  int raw = 0, moves = 0, frames = 0;
  tp::SbgcCodec<> board;
  read_all(serial, board, [&](auto& end) {
    ++frames;
    sbgc::Control control;
    if (end.read(control)) moves += control.axis[2].angle;
    if (end.frame().id == 200) raw = end.frame().size;
  });
  CHECK(frames == 6);
  CHECK(raw == 2);
  CHECK(moves == Approx(30.0 * 16384.0 / 360.0).margin(0.5));

  Port answers;
  sbgc::Confirm confirm = {};
  confirm.confirmed_id = sbgc::command::motors_on;
  board.send(confirm, answers);
  sbgc::Error refused = {};
  board.send(refused, answers);
  board.send(sbgc::BoardInfo(), answers);
  int confirmed = 0, errors = 0, boards = 0;
  read_all(answers, codec, [&](auto& end) {
    //! [answers]
    sbgc::Confirm done;
    sbgc::Error error;
    sbgc::BoardInfo info;
    if (end.read(done)) confirmed = done.confirmed_id;  // which command was carried out
    else if (end.read(error)) ++errors;                 // error.code says why not
    else if (end.read(info)) ++boards;                  // version and features
    //! [answers]
  });
  CHECK(confirmed == sbgc::command::motors_on);
  CHECK(errors == 1);
  CHECK(boards == 1);
}

TEST_CASE("a receiver and its protocol, a poller, check sums") {
  Port serial;
  //! [receiver]
  // Frames of protocol 2 with payloads up to 40 bytes; ProtocolV1 as every board speaks it, ProtocolAuto takes both.
  sbgc::Receiver<40, sbgc::ProtocolV2> receiver;
  sbgc::send<sbgc::ProtocolV2>(sbgc::Request(sbgc::command::board_info), serial);
  int frames = 0;
  for (const uint8_t byte : serial.bytes)
    for (bool got = receiver.receive(byte, 0); got; got = receiver.next()) ++frames;  // receiver.frame()
  const uint32_t lost = receiver.counters().skipped_bytes;
  //! [receiver]
  CHECK(frames == 1);
  CHECK(lost == 0);
  sbgc::Receiver<40, sbgc::ProtocolV1> older;
  sbgc::Receiver<40, sbgc::ProtocolAuto> either;
  int by_older = 0, by_either = 0;
  for (const uint8_t byte : serial.bytes) {
    by_older += older.receive(byte, 0);
    by_either += either.receive(byte, 0);
  }
  CHECK(by_older == 0);
  CHECK(by_either == 1);

  int asked = 0, missed = 0;
  //! [poller]
  sbgc::BasicPoller<sbgc::StandardPolling> poller;  // sbgc::Poller: asks every 10 ms, waits 50 for an answer
  const auto loop = [&](uint32_t now_us) {
    switch (poller.turn(now_us)) {
      case sbgc::Turn::ask:
        ++asked;
        break;  // send the request
      case sbgc::Turn::missed:
        ++missed;
        break;  // gimbal.step_silent(...)
      case sbgc::Turn::wait:
        break;
    }
  };
  // where an answer came: poller.answered()
  //! [poller]
  for (uint32_t now_us = 0; now_us < 100000; now_us += 1000) loop(now_us);
  CHECK(asked >= 1);
  CHECK(missed == 1);
  CHECK(sbgc::StandardPolling::answer_timeout_us() == 50000);

  //! [checksum]
  sbgc::Sum8 sum;   // protocol 1: the sum of the bytes
  sbgc::Crc16 crc;  // protocol 2: a CRC of 16 bits
  for (const char digit : {'1', '2', '3', '4', '5', '6', '7', '8', '9'}) {
    sum.add(static_cast<uint8_t>(digit));
    crc.add(static_cast<uint8_t>(digit));
  }
  //! [checksum]
  CHECK(sum.value() == (0x31 + 0x39) * 9 / 2 % 256);
  CHECK(crc.value() == 0xBCDD);
}

TEST_CASE("angles alone, chosen fields, a profile's parameters") {
  struct Wire {
    size_t write(const uint8_t*, size_t size) { return size; }
  } serial;
  tp::SbgcCodec<> codec;
  //! [angles]
  codec.send(sbgc::Request(sbgc::command::get_angles), serial);  // or get_angles_ext
  sbgc::Angles angles;
  sbgc::AnglesExt with_frame;
  if (codec.read(angles) && angles.error_deg(0) > 10.0f) return;
  if (codec.read(with_frame) && with_frame.frame_cam_angle(2) > 16384) return;  // yaw is a turn away
  //! [angles]
  //! [custom telemetry]
  sbgc::RealtimeCustomRequest request;
  request.fields = sbgc::custom::imu_angles | sbgc::custom::power_state;
  codec.send(request, serial);
  sbgc::RealtimeCustom custom(request.fields);  // the answer does not say what is in it
  const bool is_hot = codec.read(custom) && custom.motor_C(0) > 80;
  //! [custom telemetry]
  //! [parameters]
  codec.send(sbgc::ReadParams3(), serial);
  sbgc::Params3 params;
  if (codec.read(params)) {
    params.set_power(0, 100);    // what roll starts with
    codec.send(params, serial);  // kept in the board's EEPROM
  }
  //! [parameters]
  CHECK_FALSE(is_hot);
}
