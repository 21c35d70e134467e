// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The cost of the wire: reading an answer, writing a command, and the worst that a stream can do to a
// receiver.
#include "cost.hpp"

using namespace cost;

namespace sbgc = thermopower::sbgc;

template <class Codec>
static Codec& codec_of() {
  static Codec end;
  return end;
}
static tp::SbgcCodec<>& codec() { return codec_of<tp::SbgcCodec<>>(); }

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

// The longest frames whose payload is headers, each announcing a frame that ends with it, one behind the other: when a last byte is
// wrong, all are. Of such a stream every byte is tried in turn.
static uint16_t bytes_before;
static uint8_t nested(uint16_t at) {
  at = static_cast<uint16_t>(at % 257);
  const uint8_t size = static_cast<uint8_t>(252 - (at & ~3));
  if (at >= 252) return 1;
  return at % 4 == 0 ? 0x3E : (at % 4 == 1 ? 23 : static_cast<uint8_t>(at % 4 == 2 ? size : size + 23));
}
template <class Codec>
static void attack() {
  codec_of<Codec>().clear();
  for (uint16_t at = 0; at < bytes_before; ++at) codec_of<Codec>().receive(nested(at), 0);
}
typedef tp::SbgcCodec<> OfV1;
typedef tp::SbgcCodec<255, sbgc::ProtocolAuto> OfBoth;
extern "C" void nested_headers() { attack<OfV1>(); }
extern "C" void nested_headers_of_both() { attack<OfBoth>(); }
extern "C" void false_headers() { small_sink = codec_of<OfV1>().receive(nested(bytes_before), 0); }
extern "C" void false_headers_of_both() { small_sink = codec_of<OfBoth>().receive(nested(bytes_before), 0); }
// Cortex-M is measured by many calls each, so only the bytes around the first wrong end are tried there.
static const uint16_t first_byte = counter::resolution == 0 ? 0 : 240,
                      bytes = counter::resolution == 0 ? 700 : 60;
static void next_byte(uint16_t round) { bytes_before = static_cast<uint16_t>(first_byte + round); }

extern "C" void measure_all() {
  thermopower_cost_after(receive_byte, in_payload);
  thermopower_cost_after(receive_last, before_last_byte);
  thermopower_cost_after(read_telemetry, answer);
  thermopower_cost(write_command);
  bytes_before = 300;
  thermopower_cost_searched(false_headers, nested_headers, next_byte, bytes);
  bytes_before = 300;
  thermopower_cost_searched(false_headers_of_both, nested_headers_of_both, next_byte, bytes);
}
