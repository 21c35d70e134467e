// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Problem:  talk to a SimpleBGC board: ask for telemetry, decide, send POWER and P of three axes back;
//           survive a damaged line.
// Model:    bytes -> SbgcCodec -> GimbalController -> SbgcCodec -> bytes, a byte at a time, without a heap.
// Notation: the board is another codec in the same process; angles on the wire are 360/16384 degree.
#include <thermopower/thermopower.hpp>

#include <stdio.h>

namespace tp = thermopower;
namespace sbgc = thermopower::sbgc;

// Stands for a serial port: what one end writes, the other reads. Arduino's Serial has the same write().
struct Line {
  uint8_t bytes[512];
  size_t used = 0;
  size_t write(const uint8_t* data, size_t size) {
    for (size_t i = 0; i < size; ++i) bytes[used + i] = data[i];
    used += size;
    return size;
  }
};

int main() {
  //! [gimbal]
  typedef tp::AxisController<tp::motors::Bgm2606_90t> Small;
  typedef tp::AxisController<tp::motors::Bgm5208_200_12> Large;
  typedef tp::GimbalController<Small, Small, Large> Gimbal;
  Gimbal gimbal(tp::GimbalConfig::standard(), Small::Config::with_gain({24.0f, 4.0f}),
                Small::Config::with_gain({180.0f, 105.0f}), Large::Config::with_gain({40.0f, 2.0f}));
  tp::SbgcCodec<> codec;
  //! [gimbal]
  if (tp::is_error(gimbal.validate().field)) return 1;

  tp::SbgcCodec<> board;
  Line to_board, to_host;
  uint32_t now_us = 0;
  int answered = 0;
  printf("  cycle   error/deg   roll P/POWER   pitch P/POWER   yaw P/POWER   reason\n");
  for (int cycle = 0; cycle < 6; ++cycle, now_us += 30000) {
    to_board.used = to_host.used = 0;
    codec.send(sbgc::Request(sbgc::command::realtime_data_4), to_board);

    // The board answers with an error that grows; in cycle 3 the line flips a bit.
    sbgc::RealtimeFields fields;
    for (int axis = 0; axis < 3; ++axis) fields.target_angle[axis] = static_cast<int16_t>(10 * cycle);
    fields.battery_cV = 1260;
    fields.imu_C = 26;
    fields.frame_imu_C = 24;
    for (size_t i = 0; i < to_board.used; ++i)
      for (bool got = board.receive(to_board.bytes[i], now_us); got; got = board.next())
        board.send(fields, to_host);
    if (cycle == 3) to_host.bytes[20] ^= 4;

    //! [cycle]
    bool has_telemetry = false;
    for (size_t i = 0; i < to_host.used; ++i) {
      for (bool got = codec.receive(to_host.bytes[i], now_us); got; got = codec.next()) {
        if (const sbgc::RealtimeData* telemetry = codec.realtime_data()) {
          gimbal.step(*telemetry, 0.03f);
          has_telemetry = true;
        }
      }
    }
    if (!has_telemetry) gimbal.step_silent(0.03f);  // holds for half a second, then the power is the least
    codec.send(sbgc::power_and_gain(gimbal.state().command), to_board);
    //! [cycle]

    answered += has_telemetry;
    const Gimbal::Command& command = gimbal.state().command;
    printf("  %5d   %9.2f   %4d / %5d   %5d / %5d   %4d / %4d   %d%s\n", cycle, 10 * cycle * 360.0 / 16384,
           command.p_gain[0], command.power[0], command.p_gain[1], command.power[1], command.p_gain[2],
           command.power[2], static_cast<int>(command.reason[0]), has_telemetry ? "" : "   (frame lost)");
  }
  return answered == 5 ? 0 : 1;
}
