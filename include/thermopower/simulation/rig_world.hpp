// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/simulation/emulated_board.hpp>
#include <thermopower/simulation/rig_run.hpp>

/// @file rig_world.hpp
/// The rig behind an emulated board: a controller then sees nothing but bytes.

namespace thermopower::simulation {

/// The rig as the world of an `EmulatedBoard`: called before each look of the board at its input, it lets the
/// time since the last call pass under the board's POWER and P, and says what there is to be measured. Call
/// it at multiples of the rig's parse interval.
///
/// @snippet simulation_examples.cpp emulated board
/// How to: @ref rig.
class RigWorld {
public:
  /// @param config, scenario  as for `Rig`; the board's own faults are the emulated board's
  RigWorld(const RigConfig& config, const Scenario& scenario) : rig_(config, scenario) {}

  /// Advances to a time. @param time_s  not before the last one
  BoardTruth operator()(double time_s, const EmulatedBoard& board) {
    std::uint8_t power[3], p_gain[3];
    for (int axis = 0; axis < 3; ++axis) power[axis] = board.power(axis), p_gain[axis] = board.p_gain(axis);
    rig_.command(power, p_gain);
    // Half a cycle of grace: times are sums of parts that binary fractions cannot hold.
    while (rig_.time_s() + 0.5 * rig_.config().board_cycle_s < time_s) {
      rig_.cycle();
      meter_.cycle(rig_);
    }
    BoardTruth truth;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      truth.target_deg[axis] = rig_.scenario().axes[axis].target_deg;
      truth.angle_deg[axis] = rig_.plant(axis).angle_deg();
    }
    truth.camera_air_C = truth.frame_air_C = rig_.scenario().air_C;
    truth.battery_V = rig_.battery().state().supply_V;
    truth.current_A = rig_.supply_A();
    return truth;
  }

  const Rig& rig() const noexcept { return rig_; }  ///< What is behind the board.
  /// Of the run so far; without limiting times.
  RigMetrics figures() const noexcept { return meter_.figures(rig_); }

private:
  Rig rig_;
  RigMeter meter_;
};

/// How a controller on a PC talks to the emulated board: as the firmware's loop does.
struct ByteLoop {
  double request_interval_us = 10000.0;  ///< Between requests for telemetry.
  double answer_timeout_us = 50000.0;    ///< After which a request is repeated.
  double silence_us = 500000.0;          ///< After which the controller is told of the silence.
  double byte_us = 1e6 / 11520.0;        ///< One byte on the wire, 115200 baud 8N1.
  double poll_us = 100.0;                ///< The loop's own cycle.
  double compute_us = 0.0;  ///< From an answer's last byte to the command's first: 4400 on an ATmega328P.
  double start_us = 0.0;    ///< When the controller starts; the board runs from 0 on.
  double open_us = 0.0;     ///< Before the start: what the first step covers besides, as after a restart.
};

/// Runs a gimbal controller against the rig through an emulated board, byte by byte. @return the figures of
/// the run
/// @param gimbal  a `GimbalController`, as firmware has it
/// @param sink    called with (time, telemetry, command) after every telemetry message
template <class Gimbal, class Sink>
RigMetrics run_rig_bytes(const RigConfig& config, const Scenario& scenario, EmulatedBoard& board,
                         Gimbal& gimbal, Sink&& sink, const ByteLoop& loop = {}) {
  RigWorld world(config, scenario);
  SbgcCodec<> codec;
  double wire_free_us = 0.0, requested_us = -1e9, stepped_us = loop.start_us - loop.open_us,
         busy_until_us = loop.start_us;
  bool is_waiting = false, has_telemetry = false;
  struct Wire {
    EmulatedBoard& board;
    double& free_us;
    double now_us, byte_us;
    std::size_t write(const std::uint8_t* bytes, std::size_t size) {
      for (std::size_t i = 0; i < size; ++i) {
        free_us = std::fmax(free_us, now_us) + byte_us;
        board.receive(bytes[i], free_us);
      }
      return size;
    }
  };
  const double end_us = scenario.duration_s * 1e6;
  for (double now_us = 0.0; now_us < end_us; now_us += loop.poll_us) {
    while (board.next_parse_us() <= now_us) {
      const double parse_us = board.next_parse_us();
      board.step(parse_us, world(parse_us * 1e-6, board));
    }
    if (now_us < busy_until_us) continue;
    Wire wire = {board, wire_free_us, now_us, loop.byte_us};
    const auto since_step_s = [&] {
      const double since_us = now_us - stepped_us;
      stepped_us = now_us;
      return static_cast<float>(since_us * 1e-6);
    };
    for (LineByte byte; board.transmit(now_us, byte);)
      for (bool got =
               codec.receive(byte.value, static_cast<std::uint32_t>(static_cast<std::uint64_t>(byte.end_us)));
           got; got = codec.next()) {
        const sbgc::RealtimeData* telemetry = codec.realtime_data();
        if (telemetry == nullptr) continue;
        const auto& command = gimbal.step(*telemetry, since_step_s());
        busy_until_us = wire.now_us = now_us + loop.compute_us;
        codec.send(sbgc::power_and_gain(command), wire);
        sink(now_us * 1e-6, *telemetry, command);
        is_waiting = false;
        has_telemetry = true;
      }
    if (is_waiting && now_us - requested_us > loop.answer_timeout_us) {
      is_waiting = false;
      if (has_telemetry && now_us - stepped_us > loop.silence_us)
        codec.send(sbgc::power_and_gain(gimbal.step_silent(since_step_s())), wire);
    }
    if (!is_waiting && now_us - requested_us > loop.request_interval_us) {
      codec.send(sbgc::Request(sbgc::command::realtime_data_4), wire);
      requested_us = now_us;
      is_waiting = true;
    }
  }
  return world.figures();
}

}  // namespace thermopower::simulation
