// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The receiver's time-out, counters and handling.

#include "support.hpp"

using namespace support;

namespace {
const Data answer = reference::make_frame(0x3E, 67, {31, 7});
const Data head(answer.begin(), answer.begin() + 5);
const Data tail(answer.begin() + 5, answer.end());
}  // namespace

TEST_CASE("time-out: never early, at most 512 us late, whatever the clock shows") {
  for (const std::uint32_t start : {0u, 1u, 255u, 256u, 70000u, 0x7FFFFFF0u, 0xFFFFFF00u, 0xFFFFFFFFu}) {
    for (const std::uint32_t timeout_us : {1u, 256u, 1000u, 20000u, 8000000u}) {
      INFO("start " << start << ", time-out " << timeout_us);
      thermopower::SbgcCodec<> patient(timeout_us);
      CHECK(receive_all(patient, head, start).empty());
      CHECK(receive_all(patient, tail, start + timeout_us).size() == 1);

      thermopower::SbgcCodec<> impatient(timeout_us);
      CHECK(receive_all(impatient, head, start).empty());
      CHECK(receive_all(impatient, tail, start + timeout_us + 512).empty());
      CHECK(impatient.counters().timeouts == 1);
    }
  }
}

TEST_CASE("time-out: a pause of any length is noticed") {
  for (const std::uint32_t start : {0u, 0x12345678u, 0xFFFFFF00u})
    for (std::uint32_t pause_ms = 21; pause_ms < 4250000; pause_ms += pause_ms / 3 + 1) {
      INFO("start " << start << ", pause of " << pause_ms << " ms");
      thermopower::SbgcCodec<> codec(20000);
      CHECK(receive_all(codec, head, start).empty());
      CHECK(receive_all(codec, tail, start + pause_ms * 1000u).empty());
      CHECK(codec.counters().timeouts == 1);
    }
}

TEST_CASE("time-out: counts from the last byte, not from the first") {
  thermopower::SbgcCodec<> codec(1000);
  std::uint32_t now_us = 0;
  bool got = false;
  for (const std::uint8_t byte : answer) got = codec.receive(byte, now_us += 900);
  CHECK(got);
}

TEST_CASE("time-out: a clock reading a little older than the last one is no pause") {
  thermopower::SbgcCodec<> codec(1000);
  CHECK(receive_all(codec, head, 500000).empty());
  CHECK(receive_all(codec, tail, 499000).size() == 1);
}

TEST_CASE("time-out: 0 waits for ever, more than 8 s is taken for 8 s") {
  thermopower::SbgcCodec<> codec(0);
  CHECK(codec.timeout_us() == 0);
  CHECK(receive_all(codec, head, 0).empty());
  CHECK_FALSE(codec.poll(5000000));
  CHECK(receive_all(codec, tail, 7000000).size() == 1);

  codec.set_timeout_us(0xFFFFFFFFu);
  CHECK(codec.timeout_us() == 8000000);
  codec.set_timeout_us(1000);
  CHECK(codec.timeout_us() == 1024);
}

TEST_CASE("time-out: poll() gives up an incomplete frame, and only when it is overdue") {
  thermopower::SbgcCodec<> codec(5000);
  receive_all(codec, head, 0);
  CHECK_FALSE(codec.poll(4000));
  CHECK(codec.pending() == 5);
  CHECK_FALSE(codec.poll(6000));
  CHECK(codec.pending() == 0);
  CHECK(codec.counters().timeouts == 1);
  CHECK(codec.counters().skipped_bytes == 5);
}

TEST_CASE("counters: one for every kind of loss") {
  thermopower::SbgcCodec<32> codec;
  Data wrong_header = answer;
  wrong_header[3] ^= 1;
  Data wrong_sum = answer;
  wrong_sum.back() ^= 1;
  const Data no_id = reference::make_frame(0x3E, 0, {1});
  const Data too_long = reference::make_frame(0x3E, 9, Data(33, 0));
  const Data noise = {1, 2, 3};

  receive_all(codec, noise + wrong_header + wrong_sum + no_id + too_long + answer + head, 0);
  CHECK(codec.pending() == head.size());
  CHECK(after_silence(codec).empty());
  const sbgc::ReceiverCounters& counters = codec.counters();
  CHECK(counters.frames == 1);
  CHECK(counters.header_checksum == 1);
  CHECK(counters.payload_checksum == 1);
  CHECK(counters.invalid_id == 1);
  CHECK(counters.too_long == 1);
  CHECK(counters.timeouts == 1);
  CHECK(counters.skipped_bytes ==
        noise.size() + wrong_header.size() + wrong_sum.size() + no_id.size() + too_long.size() + head.size());

  codec.clear_counters();
  CHECK(codec.counters().frames == 0);
  CHECK(codec.counters().skipped_bytes == 0);
}

TEST_CASE("a frame at hand stays until the next call, and no longer") {
  thermopower::SbgcCodec<> codec;
  CHECK_FALSE(codec.has_frame());
  CHECK(codec.pending() == 0);
  CHECK(codec.frame().id == 0);
  CHECK(int(codec.frame().size) == 0);
  CHECK(codec.frame().payload == nullptr);
  CHECK(codec.frame().version == sbgc::Version::v1);

  receive_all(codec, Data(answer.begin(), answer.end() - 1));
  REQUIRE(codec.receive(answer.back(), 0));
  CHECK(codec.has_frame());
  CHECK(codec.frame().id == 67);
  CHECK(codec.frame().size == 2);
  CHECK(codec.frame().payload[1] == 7);
  CHECK(codec.frame().version == sbgc::Version::v1);
  CHECK(codec.pending() == 0);
  CHECK_FALSE(codec.next());
  CHECK_FALSE(codec.has_frame());
}

TEST_CASE("clear() forgets what is pending and counts nothing") {
  thermopower::SbgcCodec<> codec;
  receive_all(codec, head);
  codec.clear();
  CHECK(codec.pending() == 0);
  CHECK(receive_all(codec, answer).size() == 1);
  CHECK(codec.counters().skipped_bytes == 0);
}

TEST_CASE("a policy hears its own version only") {
  const Data v2 = reference::make_frame(0x24, 67, {31, 7});
  thermopower::SbgcCodec<124, sbgc::ProtocolV1> only_v1;
  thermopower::SbgcCodec<124, sbgc::ProtocolV2> only_v2;
  thermopower::SbgcCodec<124, sbgc::ProtocolAuto> both;
  CHECK(receive_all(only_v1, answer + v2 + answer).size() == 2);
  CHECK(receive_all(only_v2, answer + v2 + answer).size() == 1);
  CHECK(receive_all(both, answer + v2 + answer).size() == 3);
}

TEST_CASE("ProtocolAuto answers in the version it heard last") {
  thermopower::SbgcCodec<124, sbgc::ProtocolAuto> codec;
  VectorWire wire;
  const auto first_byte = [&] {
    wire.all.clear();
    codec.send(sbgc::Request(25), wire);
    return int(wire.all.at(0));
  };
  CHECK(first_byte() == 0x3E);
  receive_all(codec, reference::make_frame(0x24, 25, {}));
  CHECK(first_byte() == 0x24);
  receive_all(codec, {0x3E, 25, 4, 29, 1, 2, 3, 4, 0});  // a v1 frame that is damaged does not count
  CHECK(first_byte() == 0x24);
  receive_all(codec, reference::make_frame(0x3E, 25, {}));
  CHECK(first_byte() == 0x3E);
  codec.protocol().send_in(sbgc::Version::v2);
  CHECK(first_byte() == 0x24);
}

TEST_CASE("instances are independent") {
  thermopower::SbgcCodec<> a;
  thermopower::SbgcCodec<> b;
  const Data for_a = reference::make_frame(0x3E, 10, {1, 2, 3, 4});
  const Data for_b = reference::make_frame(0x3E, 20, {9, 8, 7, 6});
  bool got_a = false;
  bool got_b = false;
  for (std::size_t i = 0; i < for_a.size(); ++i) {
    got_a = a.receive(for_a[i], 0);
    got_b = b.receive(for_b[i], 0);
  }
  REQUIRE(got_a);
  REQUIRE(got_b);
  CHECK(a.frame().id == 10);
  CHECK(b.frame().id == 20);
  CHECK(a.frame().payload[0] == 1);
  CHECK(b.frame().payload[0] == 9);
}

TEST_CASE("a copy of a codec goes on by itself") {
  thermopower::SbgcCodec<> codec;
  receive_all(codec, head);
  thermopower::SbgcCodec<> copy_of_it = codec;
  CHECK(receive_all(codec, tail).size() == 1);
  CHECK(receive_all(copy_of_it, tail).size() == 1);
}

TEST_CASE("a codec as it comes holds whatever can be sent") {
  thermopower::SbgcCodec<> codec;
  for (std::size_t size = 0; size <= 255; ++size)
    CHECK(receive_all(codec, reference::make_frame(0x3E, 25, Data(size, 1))).size() == 1);
  CHECK(codec.counters().too_long == 0);
  CHECK(codec.counters().skipped_bytes == 0);
}

TEST_CASE("next() brings out each frame that a false start held back, and then no more") {
  const Data one = reference::make_frame(0x3E, 10, {1}), two = reference::make_frame(0x3E, 20, {2});
  const Data false_start = {0x3E, 1, 12, 13};  // a header that announces as many bytes as both frames have
  const Data wrong_sum = {0x5A};
  thermopower::SbgcCodec<> codec;
  const Data all = false_start + one + two;
  for (const std::uint8_t byte : all) REQUIRE_FALSE(codec.receive(byte, 0));
  REQUIRE(codec.receive(wrong_sum[0], 0));
  CHECK(codec.frame().id == 10);
  CHECK(codec.pending() == two.size() + wrong_sum.size());
  REQUIRE(codec.next());
  CHECK(codec.frame().id == 20);
  CHECK(codec.pending() == wrong_sum.size());
  CHECK_FALSE(codec.next());
  CHECK(codec.pending() == 0);
  CHECK(codec.counters().frames == 2);
  CHECK(codec.counters().skipped_bytes == false_start.size() + wrong_sum.size());
}

TEST_CASE("the longest frames, one behind the other, stay within the receiver, next() or not") {
  // What a class adds begins right behind the buffer, its base's last member.
  struct Guarded : sbgc::Receiver<16, sbgc::ProtocolV1> {
    Guarded() {
      for (std::uint8_t& byte : behind) byte = 0xEE;
    }
    std::uint8_t behind[8];
  };
  for (const bool ask_for_more : {false, true}) {
    Guarded receiver;
    const Data longest = reference::make_frame(0x3E, 9, Data(16, 7));
    int frames = 0;
    for (int i = 0; i < 4; ++i)
      for (const std::uint8_t byte : longest) {
        frames += receiver.receive(byte, 0);
        if (ask_for_more && receiver.has_frame()) CHECK_FALSE(receiver.next());
      }
    CHECK(frames == 4);
    CHECK(receiver.counters().skipped_bytes == 0);
    for (const std::uint8_t byte : receiver.behind) CHECK(int(byte) == 0xEE);
  }
}

namespace {

// Protocol v1 that counts the bytes that are read, again or not, and the starts.
struct CountingV1 : sbgc::ProtocolV1 {
  static int& reads() {
    static int count = 0;
    return count;
  }
  void begin(std::uint8_t start) noexcept {
    ++reads();
    ProtocolV1::begin(start);
  }
  void add_header(std::uint8_t byte) noexcept {
    ++reads();
    ProtocolV1::add_header(byte);
  }
  void add_payload(std::uint8_t byte) noexcept {
    ++reads();
    ProtocolV1::add_payload(byte);
  }
};

// A frame whose payload is headers, each announcing a frame that ends with it: when its last byte is wrong, all are.
Data nested_headers(std::size_t payload_size) {
  Data stream;
  for (std::size_t size = payload_size; size >= 4; size -= 4)
    for (const std::size_t byte : {std::size_t{0x3E}, std::size_t{23}, size, size + 23})
      stream.push_back(static_cast<std::uint8_t>(byte));
  while (stream.size() < payload_size + 5) stream.push_back(1);
  return stream;
}

}  // namespace

TEST_CASE("a call reads at most sixteen bytes, whatever the stream") {
  std::mt19937 random(20260606);
  thermopower::SbgcCodec<255, CountingV1> codec;
  int most = 0;
  const auto receive = [&](const Data& stream) {
    for (const std::uint8_t byte : stream) {
      CountingV1::reads() = 0;
      bool got = codec.receive(byte, 0);
      most = std::max(most, CountingV1::reads());
      while (got) {
        CountingV1::reads() = 0;
        got = codec.next();
        most = std::max(most, CountingV1::reads());
      }
    }
  };
  for (std::size_t size = 4; size <= 252; size += 4) receive(nested_headers(size));
  Data headers(20000);  // nothing but starts, ids, sizes and sums
  static const std::uint8_t bytes[] = {0x3E, 0x3E, 1, 0x3F, 0x7C, 0xBA, 0};
  for (std::uint8_t& byte : headers) byte = bytes[random() % sizeof bytes];
  receive(headers);
  CHECK(most > 1);
  CHECK(most <= 16);
}

TEST_CASE("a stream built of false headers costs itself, and not the frames that come later") {
  const Data telemetry = reference::make_frame(0x3E, 25, Data(124, 7));
  thermopower::SbgcCodec<> codec;
  const Data attack = nested_headers(252);
  for (int i = 0; i < 20; ++i) CHECK(receive_all(codec, attack).empty());
  CHECK(codec.counters().overruns > 0);
  std::size_t frames = 0;
  for (int i = 0; i < 20; ++i) frames += receive_all(codec, telemetry).size();
  CHECK(frames >= 17);
  CHECK(codec.counters().frames == frames);
  CHECK(frames * telemetry.size() + codec.counters().skipped_bytes + codec.pending() ==
        20 * (attack.size() + telemetry.size()));
}

TEST_CASE("a false header in front of a longest frame drops nothing, wherever the frame it announces ends") {
  const Data longest = reference::make_frame(0x3E, 25, Data(255, 7)),
             next = reference::make_frame(0x3E, 26, {1});
  for (std::size_t size = 0; size <= 255; ++size) {
    const Data false_start = {0x3E, 9, static_cast<std::uint8_t>(size), static_cast<std::uint8_t>(size + 9)};
    thermopower::SbgcCodec<> codec;
    const Data stream = false_start + longest + next + next + next + next + next + next;
    INFO("announced " << size);
    CHECK(receive_all(codec, stream) == reference::leftmost_reading(stream, {255, true, false}));
    CHECK(codec.counters().overruns == 0);
  }
}

TEST_CASE("unread bytes are read by next() and poll() when no more come") {
  const Data held_back = reference::make_frame(0x3E, 25, Data(100, 7));
  const Data false_start = {0x3E, 9, static_cast<std::uint8_t>(held_back.size()),
                            static_cast<std::uint8_t>(held_back.size() + 9)};
  thermopower::SbgcCodec<> codec;
  CHECK(receive_all(codec, false_start + held_back + Data{0x55}).empty());
  CHECK(codec.has_unread());
  int calls = 0;
  bool got = false;
  for (; !got && codec.has_unread(); ++calls) got = codec.poll(0);
  CHECK(got);
  CHECK(calls <= 8);
}
