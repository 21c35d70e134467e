// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <cmath>
#include <cstdint>
#include <deque>
#include <stdexcept>
#include <vector>

#include <thermopower/sbgc/codec.hpp>
#include <thermopower/simulation/emulated_board_line.hpp>
#include <thermopower/simulation/emulated_board_truth.hpp>

/// @file emulated_board.hpp
/// A SimpleBGC board that exists only in software: bytes in, bytes out, at the real board's pace.

namespace thermopower::simulation {

/// How the board works.
struct BoardConfig {
  double parse_interval_us = 8000;          ///< It looks at what it received this often, above 0.
  double baud = 115200;                     ///< Above 0.
  unsigned bits_per_byte = 10;              ///< 10 for 8N1, 11 with a parity bit.
  std::size_t transmit_buffer_bytes = 255;  ///< It parses nothing while its answer would not fit.
  std::uint8_t power[3] = {150, 150, 150};  ///< POWER after power-up: roll, pitch, yaw.
  std::uint8_t p_gain[3] = {12, 135, 18};   ///< P after power-up.
  std::uint16_t firmware_version = 2687;    ///< Reported by BOARD_INFO.
  std::uint64_t seed = 1;                   ///< Of the line's random damage.
};

/// What happened so far.
struct BoardCounters {
  std::uint64_t telemetry_sent = 0;        ///< REALTIME_DATA answers, asked for or streamed.
  std::uint64_t variables_set = 0;         ///< SET_ADJ_VARS_VAL commands obeyed.
  std::uint64_t confirmations = 0;         ///< CONFIRM answers.
  std::uint64_t errors = 0;                ///< ERROR answers.
  std::uint64_t other_frames = 0;          ///< Frames it has no answer for.
  std::uint64_t refused_variables = 0;     ///< Adjustable variables that do not exist, or out of 0 .. 255.
  double shortest_request_gap_us = 1e300;  ///< Between the ends of two requests for telemetry.
};

/// An emulated SimpleBGC board (protocol v1 and v2). It knows nothing of motors: a plant reads `power()` and
/// `p_gain()` and writes the truth.
///
///     board.receive(byte, end_us);                 // whatever the controller sends, at its time
///     board.step(board.next_parse_us(), truth);    // when that time has come
///     while (board.transmit(now_us, byte)) ...     // whatever has arrived at the controller
///
/// It answers REALTIME_DATA_3/4, BOARD_INFO, GET_ADJ_VARS_VAL and confirms SET_ADJ_VARS_VAL, MOTORS_ON/OFF
/// and DATA_STREAM_INTERVAL (whose streams it sends). Anything else is counted and ignored.
///
/// @snippet simulation_examples.cpp emulated board
/// How to: @ref rig.
class EmulatedBoard {
public:
  /// @throws std::invalid_argument naming the field that is out of range
  explicit EmulatedBoard(const BoardConfig& config = BoardConfig())
      : config_(checked(config)), line_(config.bits_per_byte * 1e6 / config.baud, config.seed) {
    for (int axis = 0; axis < 3; ++axis) {
      variables_[sbgc::variable::power_roll + axis] = config.power[axis];
      variables_[sbgc::variable::p_roll + axis] = config.p_gain[axis];
    }
  }

  /// A byte arrived. @param end_us  when its stop bit ended; not earlier than that of the byte before
  void receive(std::uint8_t byte, double end_us) { arrived_.push_back({end_us, byte}); }

  /// When the board looks at its input next.
  double next_parse_us() const { return next_parse_us_; }

  /// Does everything that is due until a time. @param truth  what it measures when it answers
  void step(double now_us, const BoardTruth& truth) {
    while (next_parse_us_ <= now_us) {
      truth_ = truth;
      parse(next_parse_us_);
      next_parse_us_ += config_.parse_interval_us;
    }
  }

  /// Takes the next byte that has arrived at the controller by a time. @return false when there is none
  bool transmit(double until_us, LineByte& byte) { return line_.take(until_us, byte); }

  /// POWER in force.
  std::uint8_t power(int axis) const { return variables_[sbgc::variable::power_roll + axis]; }
  std::uint8_t p_gain(int axis) const { return variables_[sbgc::variable::p_roll + axis]; }  ///< P in force.
  bool motors_on() const { return motors_on_; }                                 ///< Are the motors powered?
  const BoardCounters& counters() const { return counters_; }                   ///< What happened so far.
  const sbgc::ReceiverCounters& received() const { return codec_.counters(); }  ///< What its receiver lost.
  /// The telemetry sent last, as sent.
  const sbgc::RealtimeFields& last_telemetry() const { return last_telemetry_; }

  BoardFaults faults;  ///< What is wrong with it now; may be changed at any time.

private:
  static constexpr int variable_count = 12;
  struct Arrived {
    double end_us;
    std::uint8_t byte;
  };
  struct Stream {
    std::uint8_t id = 0;
    double interval_us = 0;
    double next_us = 0;
  };

  static const BoardConfig& checked(const BoardConfig& config) {
    if (!(config.parse_interval_us > 0))
      throw std::invalid_argument("BoardConfig::parse_interval_us must be above 0");
    if (!(config.baud > 0)) throw std::invalid_argument("BoardConfig::baud must be above 0");
    if (config.bits_per_byte < 10 || config.bits_per_byte > 12)
      throw std::invalid_argument("BoardConfig::bits_per_byte must be within 10 .. 12");
    if (config.transmit_buffer_bytes < 130)
      throw std::invalid_argument(
          "BoardConfig::transmit_buffer_bytes must be at least 130, the longest answer");
    return config;
  }

  void parse(double now_us) {
    while (!arrived_.empty() && arrived_.front().end_us <= now_us && has_room(now_us)) {
      const Arrived arrived = arrived_.front();
      arrived_.pop_front();
      if (faults.is_deaf) continue;
      const auto at_us = static_cast<std::uint32_t>(static_cast<std::uint64_t>(arrived.end_us));
      for (bool got = codec_.receive(arrived.byte, at_us); got; got = codec_.next())
        obey(codec_.frame(), arrived.end_us, now_us);
    }
    if (stream_.interval_us > 0 && now_us >= stream_.next_us && has_room(now_us)) {
      send_telemetry(stream_.id, now_us);
      stream_.next_us = now_us + stream_.interval_us;
    }
  }

  bool has_room(double now_us) const {
    return line_.backlog_bytes(now_us) + 130.0 <= static_cast<double>(config_.transmit_buffer_bytes);
  }

  void obey(const sbgc::Frame& frame, double received_us, double now_us) {
    switch (frame.id) {
      case sbgc::command::realtime_data_3:
      case sbgc::command::realtime_data_4: {
        const double gap_us = received_us - last_request_us_;
        if (gap_us < counters_.shortest_request_gap_us) counters_.shortest_request_gap_us = gap_us;
        last_request_us_ = received_us;
        return send_telemetry(frame.id, now_us);
      }
      case sbgc::command::board_info: {
        sbgc::BoardInfo info;
        info.board_version = 30;
        info.firmware_version = config_.firmware_version;
        return send(info, now_us, false);
      }
      case sbgc::command::set_adj_vars_val:
        return set_variables(frame, now_us);
      case sbgc::command::get_adj_vars_val:
        return report_variables(frame, now_us);
      case sbgc::command::motors_on:
      case sbgc::command::motors_off:
        motors_on_ = frame.id == sbgc::command::motors_on;
        return confirm(frame.id, now_us);
      case sbgc::command::data_stream_interval:
        return start_stream(frame, now_us);
      default:
        ++counters_.other_frames;
    }
  }

  void send_telemetry(std::uint8_t id, double now_us) {
    last_telemetry_ = measured(truth_, faults);
    last_telemetry_.extended = id == sbgc::command::realtime_data_4;
    last_telemetry_.flags = motors_on_ ? 1 : 0;
    for (int axis = 0; axis < 3; ++axis)
      last_telemetry_.motor_power[axis] = faults.hides_power ? 0 : power(axis);
    ++counters_.telemetry_sent;
    send(last_telemetry_, now_us, true);
  }

  void set_variables(const sbgc::Frame& frame, double now_us) {
    sbgc::AdjVarsView vars;
    if (!vars.read(frame)) return static_cast<void>(++counters_.other_frames);
    if (faults.ignores_commands) return;
    if (faults.refuses_with_error) {
      ++counters_.errors;
      return send(sbgc::Error(), now_us, false);
    }
    for (std::uint8_t index = 0; index < vars.count(); ++index) {
      const sbgc::AdjVar var = vars[index];
      if (faults.refuses_power && var.id >= sbgc::variable::power_roll) continue;
      if (var.id < variable_count && var.value >= 0 && var.value <= 255)
        variables_[var.id] = static_cast<std::uint8_t>(var.value);
      else ++counters_.refused_variables;
    }
    ++counters_.variables_set;
    confirm(frame.id, now_us);
  }

  void report_variables(const sbgc::Frame& frame, double now_us) {
    sbgc::GetAdjVarsView wanted;
    if (!wanted.read(frame)) return static_cast<void>(++counters_.other_frames);
    std::vector<std::uint8_t> payload = {0};
    for (std::uint8_t index = 0; index < wanted.ids.size && payload[0] < 50; ++index) {
      const std::uint8_t id = wanted.ids.data[index];
      if (id >= variable_count) continue;
      payload.insert(payload.end(), {id, variables_[id], 0, 0, 0});
      ++payload[0];
    }
    send(sbgc::Raw{sbgc::command::set_adj_vars_val,
                   {payload.data(), static_cast<std::uint8_t>(payload.size())}},
         now_us, false);
  }

  void start_stream(const sbgc::Frame& frame, double now_us) {
    sbgc::DataStreamInterval wanted;
    const bool is_known = wanted.read(frame) && (wanted.streamed_id == sbgc::command::realtime_data_3 ||
                                                 wanted.streamed_id == sbgc::command::realtime_data_4);
    if (!is_known) return static_cast<void>(++counters_.other_frames);
    stream_ = {wanted.streamed_id, wanted.interval_ms * 1000.0, now_us};
    confirm(frame.id, now_us);
  }

  void confirm(std::uint8_t id, double now_us) {
    sbgc::Confirm confirmation;
    confirmation.confirmed_id = id;
    ++counters_.confirmations;
    send(confirmation, now_us, false);
  }

  template <class Message>
  void send(const Message& message, double now_us, bool is_telemetry) {
    std::uint8_t bytes[261];
    const std::size_t size = codec_.encode(message, bytes, sizeof bytes);
    line_.send(bytes, size, now_us + faults.answer_delay_us, is_telemetry, faults);
  }

  BoardConfig config_;
  BoardLine line_;
  SbgcCodec<255, sbgc::ProtocolAuto> codec_;
  std::deque<Arrived> arrived_;
  double next_parse_us_ = 0;
  double last_request_us_ = -1e300;
  BoardTruth truth_;
  std::uint8_t variables_[variable_count] = {};
  bool motors_on_ = true;
  Stream stream_;
  sbgc::RealtimeFields last_telemetry_;
  BoardCounters counters_;
};

}  // namespace thermopower::simulation
