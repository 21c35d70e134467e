// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// What damage costs: exactly the damaged frames.
//
// The guarantee, for any stream, however it was made: the receiver's result is the leftmost reading of the
// stream (see reference.hpp). From it follows: an intact frame is lost only where damaged bytes happen to
// form a frame with right checksums that overlaps it. v2 has 16 + 8 check bits against that; v1 only 8 + 8,
// so v1 does lose one now and then, and no receiver can help it.

#include <algorithm>
#include <random>

#include "support.hpp"

using namespace support;

namespace {

using Random = std::mt19937;

int pick(Random& random, int from, int to) { return std::uniform_int_distribution<int>(from, to)(random); }

std::uint8_t any_byte(Random& random) { return static_cast<std::uint8_t>(pick(random, 0, 255)); }

// Bytes that look like starts, short headers and their sums.
std::uint8_t nasty_byte(Random& random) {
  static const std::uint8_t bytes[] = {0x3E, 0x24, 0x3E, 0x24, 0, 1, 2, 3, 5, 7, 0x19, 0x1F, 0x3F, 0x40};
  return bytes[pick(random, 0, sizeof(bytes) - 1)];
}

struct Intact {
  std::size_t begin;
  std::size_t end;
  reference::Frame frame;
};

struct Recording {
  Data stream;
  std::vector<Intact> intact;
};

// Frames with noise in between; `damage` of 1000 bytes are changed, lost, or have one inserted before them.
Recording record(Random& random, const reference::Rules& rules, int frames, int damage, bool nasty) {
  Recording recording;
  for (int i = 0; i < frames; ++i) {
    const auto byte = [&] {
      return nasty && pick(random, 0, 1) == 0 ? nasty_byte(random) : any_byte(random);
    };
    for (int noise = pick(random, 0, 9) == 0 ? pick(random, 1, 30) : 0; noise > 0; --noise)
      recording.stream.push_back(byte());
    const int longest = static_cast<int>(rules.payload_capacity);
    Data payload(
        static_cast<std::size_t>(pick(random, 0, pick(random, 0, 1) == 0 ? longest : std::min(longest, 12))));
    for (std::uint8_t& value : payload) value = byte();
    const bool v1 = rules.v1 && (!rules.v2 || pick(random, 0, 1) == 0);
    const std::uint8_t id = static_cast<std::uint8_t>(pick(random, 1, 255));
    const Data frame = reference::make_frame(v1 ? 0x3E : 0x24, id, payload);

    Data damaged;
    for (const std::uint8_t sent : frame) {
      const int what = pick(random, 0, 999) < damage ? pick(random, 1, 3) : 0;
      if (what == 1) continue;
      if (what == 2) damaged.push_back(byte());
      damaged.push_back(what == 3 ? static_cast<std::uint8_t>(sent ^ pick(random, 1, 255)) : sent);
    }
    // A byte inserted in front does no harm, nor does one that happens to be the next byte of the frame.
    const auto found = std::search(damaged.begin(), damaged.end(), frame.begin(), frame.end());
    if (found != damaged.end()) {
      Intact intact;
      intact.begin = recording.stream.size() + static_cast<std::size_t>(found - damaged.begin());
      intact.end = intact.begin + frame.size();
      intact.frame.start = frame[0];
      intact.frame.id = id;
      intact.frame.payload = payload;
      recording.intact.push_back(intact);
    }
    recording.stream.insert(recording.stream.end(), damaged.begin(), damaged.end());
  }
  return recording;
}

template <std::size_t capacity, class Protocol_, bool v1, bool v2>
struct Case {
  using Codec = thermopower::SbgcCodec<capacity, Protocol_>;
  static reference::Rules rules() { return reference::Rules{capacity, v1, v2}; }
};

using V1Small = Case<0, sbgc::ProtocolV1, true, false>;
using V1Default = Case<124, sbgc::ProtocolV1, true, false>;
using V1Full = Case<255, sbgc::ProtocolV1, true, false>;
using V2Default = Case<124, sbgc::ProtocolV2, false, true>;
using V2Full = Case<255, sbgc::ProtocolV2, false, true>;
using AutoSmall = Case<7, sbgc::ProtocolAuto, true, true>;
using AutoByteIndex = Case<207, sbgc::ProtocolAuto, true, true>;
using AutoWordIndex = Case<208, sbgc::ProtocolAuto, true, true>;

}  // namespace

TEMPLATE_TEST_CASE("damage: the result is the leftmost reading of any stream", "", V1Small, V1Default, V1Full,
                   V2Default, V2Full, AutoSmall, AutoByteIndex, AutoWordIndex) {
  Random random(20260101);
  for (int run = 0; run < 60; ++run) {
    const bool nasty = run % 2 == 0;
    const int damage = run % 3 == 0 ? 0 : run % 3 == 1 ? 10 : 100;
    // Frames longer than the buffer occur too.
    reference::Rules sending = TestType::rules();
    sending.payload_capacity = std::min<std::size_t>(255, sending.payload_capacity + 20);
    const Recording recording = record(random, sending, 60, damage, nasty);
    const auto expected = reference::leftmost_reading(recording.stream, TestType::rules());

    typename TestType::Codec codec;
    REQUIRE(receive_then_silence(codec, recording.stream) == expected);

    std::size_t frame_bytes = 0;
    for (const reference::Frame& frame : expected) frame_bytes += frame.end - frame.begin;
    CHECK(codec.counters().frames == expected.size());
    CHECK(codec.counters().skipped_bytes == recording.stream.size() - frame_bytes);
    CHECK(codec.pending() == 0);
  }
}

TEMPLATE_TEST_CASE("damage: pauses cut frames and nothing else, in any chunking", "", V1Default, V2Full,
                   AutoSmall, AutoWordIndex) {
  Random random(20260202);
  for (int run = 0; run < 40; ++run) {
    const Recording recording = record(random, TestType::rules(), 40, 20, run % 2 == 0);
    typename TestType::Codec codec(5000);
    std::vector<std::size_t> pauses;
    std::vector<reference::Frame> frames;
    std::uint32_t now_us = 0xFFFF0000u;  // wraps on the way
    for (std::size_t at = 0; at < recording.stream.size();) {
      const std::size_t chunk = static_cast<std::size_t>(pick(random, 1, 64));
      for (std::size_t end = std::min(at + chunk, recording.stream.size()); at < end; ++at)
        for (bool got = codec.receive(recording.stream[at], now_us); got; got = codec.next())
          frames.push_back(copy(codec));
      if (pick(random, 0, 3) == 0) {
        now_us += 6000;
        pauses.push_back(at);
        if (pick(random, 0, 1) == 0)
          for (const reference::Frame& frame : after_silence(codec, now_us)) frames.push_back(frame);
      } else {
        now_us += 4000;
      }
    }
    for (const reference::Frame& frame : after_silence(codec, now_us + 6000)) frames.push_back(frame);
    REQUIRE(frames == reference::leftmost_reading(recording.stream, TestType::rules(), pauses));
    CHECK(codec.pending() == 0);
  }
}

TEMPLATE_TEST_CASE("damage: frames arrive also when next() is never called", "", V1Default, V2Full,
                   AutoWordIndex) {
  Random random(20260303);
  for (int run = 0; run < 40; ++run) {
    const Recording recording = record(random, TestType::rules(), 40, 20, true);
    typename TestType::Codec codec;
    std::vector<reference::Frame> frames;
    for (const std::uint8_t byte : recording.stream)
      if (codec.receive(byte, 0)) frames.push_back(copy(codec));
    for (const reference::Frame& frame : after_silence(codec)) frames.push_back(frame);
    REQUIRE(frames == reference::leftmost_reading(recording.stream, TestType::rules()));
  }
}

TEST_CASE("damage: v2 loses damaged frames only") {
  Random random(20260404);
  std::size_t intact = 0;
  std::size_t sent = 0;
  for (int run = 0; run < 100; ++run) {
    const Recording recording = record(random, V2Default::rules(), 100, 10, false);
    V2Default::Codec codec;
    const auto frames = receive_then_silence(codec, recording.stream);
    REQUIRE(frames.size() == recording.intact.size());
    for (std::size_t i = 0; i < frames.size(); ++i) REQUIRE(frames[i] == recording.intact[i].frame);
    intact += frames.size();
    sent += 100;
  }
  CHECK(intact > sent / 3);  // the test is about something: some frames survive, some do not
  CHECK(intact < sent * 9 / 10);
}

TEST_CASE("damage: v1 loses an intact frame only to damaged bytes whose checksums are right by chance") {
  Random random(20260505);
  std::size_t lost = 0;
  std::size_t intact = 0;
  for (int run = 0; run < 200; ++run) {
    const Recording recording = record(random, V1Default::rules(), 100, 10, run % 2 == 0);
    const auto reading = reference::leftmost_reading(recording.stream, V1Default::rules());
    V1Default::Codec codec;
    REQUIRE(receive_then_silence(codec, recording.stream) == reading);
    intact += recording.intact.size();
    for (const Intact& frame : recording.intact) {
      bool received = false;
      bool overlapped = false;
      for (const reference::Frame& read : reading) {
        if (read.begin == frame.begin && read.end == frame.end) received = true;
        else if (read.begin < frame.end && frame.begin < read.end) overlapped = true;
      }
      if (!received) {
        ++lost;
        CHECK(overlapped);
      }
    }
  }
  CHECK(intact > 5000);
  CHECK(lost * 1000 < intact);
}

TEST_CASE("damage: every change of a single byte of a v2 frame is rejected") {
  const Data next = reference::make_frame(0x24, 67, {31});
  for (const char* name : {"v2_request_realtime_data_3.hex", "v2_request_realtime_data_4.hex",
                           "v2_set_adj_vars_1_max.hex", "v2_set_adj_vars_6.hex", "v2_answer_rt4_real.hex"}) {
    const Data good = load_hex(name);
    std::size_t accepted = 0;
    std::size_t next_lost = 0;
    for (std::size_t at = 0; at < good.size(); ++at) {
      for (int change = 1; change < 256; ++change) {
        Data bad = good;
        bad[at] = static_cast<std::uint8_t>(bad[at] ^ change);
        V2Full::Codec codec;
        const auto frames = receive_then_silence(codec, bad + next);
        const bool got_next = !frames.empty() && frames.back().id == 67;
        accepted += frames.size() - (got_next ? 1 : 0);
        next_lost += got_next ? 0 : 1;
      }
    }
    INFO(name);
    CHECK(accepted == 0);
    CHECK(next_lost == 0);
  }
}

TEST_CASE("damage: every change of a single byte of a v1 frame is rejected") {
  for (const char* name : {"v1_request_board_info.hex", "v1_set_adj_vars_6.hex", "v1_answer_rt4_real.hex"}) {
    const Data good = load_hex(name);
    std::size_t accepted = 0;
    for (std::size_t at = 0; at < good.size(); ++at) {
      for (int change = 1; change < 256; ++change) {
        Data bad = good;
        bad[at] = static_cast<std::uint8_t>(bad[at] ^ change);
        V1Full::Codec codec;
        accepted += receive_then_silence(codec, bad).size();
      }
    }
    INFO(name);
    CHECK(accepted == 0);
  }
}

TEST_CASE("damage: what a v1 checksum cannot see is accepted: that is the protocol, and v2 sees it") {
  const Data swapped_v1 = [] {
    Data frame = reference::make_frame(0x3E, 25, {1, 2, 3});
    std::swap(frame[4], frame[5]);
    return frame;
  }();
  V1Default::Codec v1;
  CHECK(receive_all(v1, swapped_v1).size() == 1);

  Data swapped_v2 = reference::make_frame(0x24, 25, {1, 2, 3});
  std::swap(swapped_v2[4], swapped_v2[5]);
  V2Default::Codec v2;
  CHECK(receive_then_silence(v2, swapped_v2).empty());
}

TEST_CASE("damage: with both versions accepted, only a first byte turned from v2 into v1 can deceive") {
  const Data good = load_hex("v2_answer_rt4_real.hex");
  for (std::size_t at = 0; at < good.size(); ++at) {
    for (int value = 0; value < 256; ++value) {
      if (value == good[at] || (at == 0 && value == 0x3E)) continue;
      Data bad = good;
      bad[at] = static_cast<std::uint8_t>(value);
      AutoWordIndex::Codec codec;
      REQUIRE(receive_then_silence(codec, bad).empty());
    }
  }
}
