// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Any bytes, in any chunking, with pauses anywhere: the codec reports the leftmost reading of the stream (where it dropped bytes
// unread, whole frames of it in order), conserves bytes, and every typed message either refuses a frame or encodes back into a frame that reads the
// same.
//
// The input is a small program, so that valid frames occur often: see play() below. Build with
// -fsanitize=fuzzer,address,undefined to search with libFuzzer, or with sbgc_fuzz_driver.cpp to run random
// programs.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <thermopower/sbgc/codec.hpp>
#include <vector>

#include "../sbgc/reference.hpp"

namespace {

namespace sbgc = thermopower::sbgc;
using reference::Data;

void require(bool holds, const char* claim) {
  if (holds) return;
  std::fprintf(stderr, "sbgc_fuzz: does not hold: %s\n", claim);
  std::abort();
}

constexpr std::uint32_t timeout_us = 2000;

template <class Message>
void same_after_encoding(const sbgc::Frame& frame) {
  Message message = Message();
  if (!message.read(frame)) return;
  std::uint8_t buffer[262];
  const std::size_t size = sbgc::encode<sbgc::ProtocolV2>(message, buffer, sizeof(buffer));
  require(size == sbgc::frame_size(message, sbgc::Version::v2), "a message that was read can be encoded");
  const sbgc::Frame again = {buffer[1], buffer[2], buffer + 4, sbgc::Version::v2};
  Message copy = Message();
  require(copy.read(again), "an encoded message can be read");
  std::uint8_t second[262];
  require(sbgc::encode<sbgc::ProtocolV2>(copy, second, sizeof(second)) == size, "encoding is stable in size");
  require(Data(buffer, buffer + size) == Data(second, second + size), "encoding is stable");
}

void read_as_everything(const sbgc::Frame& frame) {
  same_after_encoding<sbgc::RealtimeData>(frame);
  same_after_encoding<sbgc::RealtimeFields>(frame);
  same_after_encoding<sbgc::Request>(frame);
  same_after_encoding<sbgc::Raw>(frame);
  same_after_encoding<sbgc::Confirm>(frame);
  same_after_encoding<sbgc::Error>(frame);
  same_after_encoding<sbgc::BoardInfo>(frame);
  same_after_encoding<sbgc::Control>(frame);
  same_after_encoding<sbgc::MotorsOn>(frame);
  same_after_encoding<sbgc::MotorsOff>(frame);
  same_after_encoding<sbgc::Reset>(frame);
  same_after_encoding<sbgc::DataStreamInterval>(frame);
  std::int32_t total = 0;
  sbgc::AdjVarsView vars;
  if (vars.read(frame))
    for (std::uint8_t i = 0; i < vars.count(); ++i) total ^= vars[i].value;
  sbgc::GetAdjVarsView asked;
  if (asked.read(frame))
    for (std::uint8_t i = 0; i < asked.ids.size; ++i) total ^= asked.ids.data[i];
  volatile std::int32_t keep = total;
  static_cast<void>(keep);
}

struct Recording {
  Data stream;
  std::vector<std::size_t> pauses;
};

// One operation per leading byte: 0..3 a v1 frame, 4..7 a v2 frame (id, size and payload follow; every fourth
// is damaged in one byte), 8 a pause, anything else: the next byte goes out as it is.
Recording play(const std::uint8_t* program, std::size_t size) {
  Recording recording;
  std::size_t at = 0;
  const auto next = [&] { return at < size ? program[at++] : std::uint8_t(0); };
  while (at < size) {
    const std::uint8_t operation = next() % 16;
    if (operation < 8) {
      const std::uint8_t id = next();
      Data payload(next());
      const bool filled = operation % 2 == 1;
      for (std::uint8_t& byte : payload) byte = filled ? id : next();
      Data frame = reference::make_frame(operation < 4 ? 0x3E : 0x24, id, payload);
      if (operation % 4 == 3) frame[next() % frame.size()] ^= next();
      recording.stream.insert(recording.stream.end(), frame.begin(), frame.end());
    } else if (operation == 8) {
      if (!recording.stream.empty()) recording.pauses.push_back(recording.stream.size());
    } else {
      recording.stream.push_back(next());
    }
  }
  return recording;
}

template <std::size_t capacity, class Protocol>
void check(const Recording& recording, bool v1, bool v2) {
  thermopower::SbgcCodec<capacity, Protocol> codec(timeout_us);
  std::vector<reference::Frame> frames;
  const auto take = [&] {
    const sbgc::Frame frame = codec.frame();
    reference::Frame copy;
    copy.start = static_cast<std::uint8_t>(frame.version);
    copy.id = frame.id;
    copy.payload.assign(frame.payload, frame.payload + frame.size);
    frames.push_back(copy);
    read_as_everything(frame);
  };
  std::uint32_t now_us = 0xFFFFF000u;
  std::size_t next_pause = 0;
  for (std::size_t at = 0; at < recording.stream.size(); ++at) {
    while (next_pause < recording.pauses.size() && recording.pauses[next_pause] == at) {
      now_us += timeout_us + 1000;
      ++next_pause;
    }
    for (bool got = codec.receive(recording.stream[at], now_us); got; got = codec.next()) take();
  }
  do
    if (codec.poll(now_us + timeout_us + 1000)) take();
  while (codec.has_frame() || codec.has_unread());

  const reference::Rules rules = {capacity, v1, v2};
  std::size_t frame_bytes = 0;
  if (codec.counters().overruns == 0) {
    const auto expected = reference::leftmost_reading(recording.stream, rules, recording.pauses);
    require(frames == expected, "the frames are the leftmost reading of the stream");
    for (const reference::Frame& frame : expected) frame_bytes += frame.end - frame.begin;
  } else {
    std::size_t at = 0;
    for (const reference::Frame& frame : frames) {
      reference::Frame there;
      while (at < recording.stream.size() &&
             !(reference::frame_at(recording.stream, at, recording.stream.size(), rules, there) &&
               there == frame))
        ++at;
      require(at < recording.stream.size(), "each frame is in the stream, behind the one before");
      at = there.end;
      frame_bytes += there.end - there.begin;
    }
  }
  require(codec.pending() == 0, "nothing is pending after silence");
  require(codec.counters().frames == frames.size(), "frames are counted");
  require(codec.counters().skipped_bytes + frame_bytes == recording.stream.size(), "bytes are conserved");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const Recording recording = play(data, size);
  check<124, sbgc::ProtocolV1>(recording, true, false);
  check<124, sbgc::ProtocolV2>(recording, false, true);
  check<255, sbgc::ProtocolAuto>(recording, true, true);
  check<3, sbgc::ProtocolAuto>(recording, true, true);
  return 0;
}
