// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The cost of the wire: reading an answer, writing a command, and the worst that a stream can do to a
// receiver.
#include "cost.hpp"

using namespace cost;

namespace sbgc = thermopower::sbgc;

static tp::SbgcCodec<>& codec() {
  static tp::SbgcCodec<> end;
  return end;
}

struct GivenCommand {
  uint8_t power[3], p_gain[3];
};

extern "C" void reset_codec() { codec().clear(); }
extern "C" void in_payload() {
  reset_codec();
  const uint8_t header[] = {0x3E, sbgc::command::realtime_data_4, 124,
                            static_cast<uint8_t>(sbgc::command::realtime_data_4 + 124)};
  for (const uint8_t byte : header) codec().receive(byte, 0);
}
extern "C" void receive_byte() { small_sink = codec().receive(given.level, 0); }

// Everything of an answer but its last byte.
extern "C" void before_last_byte() {
  in_payload();
  for (uint8_t count = 0; count < 124; ++count) codec().receive(0, 0);
}
extern "C" void receive_last() { small_sink = codec().receive(0, 0); }
extern "C" void read_telemetry() { small_sink = codec().realtime_data() != nullptr; }
extern "C" void answer() {
  before_last_byte();
  receive_last();
}

extern "C" void write_command() {
  const GivenCommand command = {{given.level, 1, 250}, {22, 172, 36}};
  uint8_t frame[40];
  small_sink =
      static_cast<uint8_t>(codec().encode(sbgc::PowerAndGain<GivenCommand>(command), frame, sizeof frame));
}

// A frame whose payload is headers, each announcing a frame that ends with it: when its last byte is wrong,
// all are.
extern "C" void nested_headers() {
  reset_codec();
  for (uint8_t start = 0; start < 124; start = static_cast<uint8_t>(start + 4)) {
    const uint8_t size = static_cast<uint8_t>(124 - start);
    codec().receive(0x3E, 0);
    codec().receive(23, 0);
    codec().receive(size, 0);
    codec().receive(static_cast<uint8_t>(23 + size), 0);
  }
  for (uint8_t count = 0; count < 4; ++count) codec().receive(0, 0);
}
extern "C" void wrong_last_byte() { small_sink = codec().receive(0, 0); }

extern "C" void measure_all() {
  thermopower_cost_after(receive_byte, in_payload);
  thermopower_cost_after(receive_last, before_last_byte);
  thermopower_cost_after(read_telemetry, answer);
  thermopower_cost(write_command);
  thermopower_cost_after(wrong_last_byte, nested_headers);
}
