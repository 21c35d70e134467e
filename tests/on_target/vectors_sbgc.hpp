// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/sbgc/codec.hpp>

#include "report.hpp"

/// Input vectors for the wire: every byte written and every frame found is the same everywhere.
namespace on_target {

struct ByteSink {
  Report& report;
  template <class Count>
  size_t write(const uint8_t* bytes, Count size) const {
    for (size_t at = 0; at < size; ++at) report.integer(bytes[at]);
    return static_cast<size_t>(size);
  }
};

// A stream that everyone draws alike.
class Noise {
public:
  uint8_t next() {
    state_ = state_ * 1664525u + 1013904223u;
    return static_cast<uint8_t>(state_ >> 24);
  }

private:
  uint32_t state_ = 1;
};

template <class Protocol>
[[gnu::noinline]] void run_codec(Report& report) {
  namespace sbgc = thermopower::sbgc;
  thermopower::SbgcCodec<124, Protocol> codec;
  ByteSink wire = {report};
  codec.send(sbgc::Request(sbgc::command::realtime_data_4), wire);
  const struct { uint8_t power[3], p_gain[3]; } command = {{25, 250, 1}, {22, 106, 40}};
  codec.send(sbgc::power_and_gain(command), wire);

  // Telemetry frames in noise; some are damaged. What is found, and what is counted as lost, is the result.
  uint8_t frame[130];
  Noise noise;
  uint8_t payload[124];
  for (uint8_t round = 0; round < 12; ++round) {
    for (uint8_t at = 0; at < sizeof payload; ++at) payload[at] = noise.next();
    const sbgc::Raw telemetry = {sbgc::command::realtime_data_4, {payload, sizeof payload}};
    const size_t size = codec.encode(telemetry, frame, sizeof frame);
    if (round % 4 == 3) frame[noise.next() % size] ^= 0x10;
    for (uint8_t at = 0; at < round; ++at) codec.receive(noise.next(), 1000u * round);
    for (size_t at = 0; at < size; ++at)
      for (bool got = codec.receive(frame[at], 1000u * round); got; got = codec.next()) {
        const sbgc::RealtimeData* data = codec.realtime_data();
        report.integer(data == nullptr ? -1 : data->error_units(1));
        if (data == nullptr) continue;
        report.real(data->error_deg(2), 0.0f);
        report.real(data->battery_V(), 2e-5f);
        report.integer(data->imu_C());
      }
  }
  report.integer(static_cast<int32_t>(codec.counters().frames));
  report.integer(static_cast<int32_t>(codec.counters().skipped_bytes));
  report.integer(static_cast<int32_t>(codec.counters().payload_checksum));
}

inline void run_sbgc(Report& report) {
  report.section("protocol v1");
  run_codec<thermopower::sbgc::ProtocolV1>(report);
  report.section("protocol v2");
  run_codec<thermopower::sbgc::ProtocolV2>(report);
}

}  // namespace on_target
