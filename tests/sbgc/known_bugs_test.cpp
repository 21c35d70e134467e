// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Receivers in the field get these wrong; one test for each.

#include <numeric>

#include "support.hpp"

using namespace support;

namespace {

const Data request = reference::make_frame(0x3E, 25, {});
const Data request_v2 = reference::make_frame(0x24, 25, {});

Data ramp(std::size_t size) {
  Data payload(size);
  std::iota(payload.begin(), payload.end(), std::uint8_t(1));
  return payload;
}

Data without(Data data, std::size_t at) {
  data.erase(data.begin() + static_cast<std::ptrdiff_t>(at));
  return data;
}

}  // namespace

TEST_CASE("known bug: a stray start byte costs the next good frame") {
  const Data good = reference::make_frame(0x3E, 25, ramp(20));
  for (std::size_t strays = 1; strays < 8; ++strays) {
    thermopower::SbgcCodec<> codec;
    const auto frames = receive_all(codec, Data(strays, 0x3E) + good);
    REQUIRE(frames.size() == 1);
    CHECK(frames[0].payload == ramp(20));
    CHECK(codec.counters().skipped_bytes == strays);
  }
}

TEST_CASE("known bug: a stray byte with a whole header in front hides frames until it is proved wrong") {
  // The header announces 100 bytes; three good frames lie within them.
  const Data false_header = {0x3E, 25, 100, 125};
  const Data good = reference::make_frame(0x3E, 23, ramp(10));
  thermopower::SbgcCodec<> codec;
  CHECK(receive_all(codec, false_header + good + good + good).empty());
  SECTION("more bytes bring all three out") {
    CHECK(receive_all(codec, Data(100, 0)).size() == 3);
    CHECK(codec.counters().payload_checksum == 1);
  }
  SECTION("so does silence") {
    CHECK(after_silence(codec).size() == 3);
    CHECK(codec.counters().timeouts == 1);
  }
  SECTION("and they are not lost when next() is never called") {
    int count = 0;
    for (int i = 0; i < 100; ++i) count += codec.receive(0, 0);
    CHECK(count == 3);
  }
}

TEST_CASE("known bug: a lost byte costs the next good frame") {
  const Data damaged = reference::make_frame(0x3E, 25, ramp(20));
  const Data good = reference::make_frame(0x3E, 23, ramp(10));
  for (std::size_t lost = 0; lost < damaged.size(); ++lost) {
    INFO("byte " << lost << " lost");
    thermopower::SbgcCodec<> codec;
    const auto frames = receive_then_silence(codec, without(damaged, lost) + good + good);
    REQUIRE(frames.size() == 2);
    CHECK(frames[0].id == 23);
    CHECK(frames[1].id == 23);
  }
}

TEST_CASE("known bug: no time-out inside a frame") {
  const Data good = reference::make_frame(0x3E, 25, ramp(20));
  for (std::size_t cut = 1; cut < good.size(); ++cut) {
    INFO("cut after " << cut);
    thermopower::SbgcCodec<> codec(5000);
    const Data head(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(cut));
    CHECK(receive_all(codec, head, 1000).empty());
    CHECK(receive_all(codec, good, 7000).size() == 1);  // the first byte comes 6000 us later
    CHECK(codec.counters().timeouts == 1);
    CHECK(codec.counters().skipped_bytes == cut);
  }
}

TEST_CASE("known bug: a v2 frame is accepted though one of its CRC bytes is wrong") {
  const Data good = reference::make_frame(0x24, 25, ramp(20));
  for (const std::size_t byte : {good.size() - 2, good.size() - 1}) {
    for (int change = 1; change < 256; ++change) {
      Data bad = good;
      bad[byte] = static_cast<std::uint8_t>(bad[byte] ^ change);
      thermopower::SbgcCodec<124, sbgc::ProtocolV2> codec;
      CHECK(receive_then_silence(codec, bad).empty());
      CHECK(codec.counters().payload_checksum == 1);
    }
  }
}

TEST_CASE("known bug: a payload of length zero swallows what follows") {
  thermopower::SbgcCodec<> v1;
  CHECK(receive_all(v1, request + request + request).size() == 3);
  thermopower::SbgcCodec<124, sbgc::ProtocolV2> v2;
  CHECK(receive_all(v2, request_v2 + request_v2 + request_v2).size() == 3);
  CHECK(v2.counters().skipped_bytes == 0);

  SECTION("its checksum is looked at all the same") {
    Data bad = request;
    bad.back() = 1;
    thermopower::SbgcCodec<> codec;
    CHECK(receive_all(codec, bad + request).size() == 1);
    CHECK(codec.counters().payload_checksum == 1);
  }
}

TEST_CASE("known bug: a payload longer than the buffer") {
  thermopower::SbgcCodec<16> codec;
  for (std::size_t size = 17; size <= 255; ++size) {
    INFO("payload of " << size);
    codec.clear_counters();
    const Data too_long = reference::make_frame(0x3E, 25, Data(size, 0xAA));
    const auto frames = receive_all(codec, too_long + request);
    REQUIRE(frames.size() == 1);
    CHECK(frames[0].payload.empty());
    CHECK(codec.counters().too_long == 1);
    CHECK(codec.counters().skipped_bytes == too_long.size());
  }
  SECTION("a false header that announces too much costs nothing") {
    codec.clear_counters();
    CHECK(receive_all(codec, Data{0x3E, 25, 200, 225} + request + request).size() == 2);
    CHECK(codec.counters().too_long == 1);
  }
  SECTION("the longest payload that fits does fit") {
    CHECK(receive_all(codec, reference::make_frame(0x3E, 25, ramp(16))).size() == 1);
  }
}

TEST_CASE("known bug: telemetry of newer firmware is longer than the buffer and never read") {
  const Data payload = load_hex("payload_rt4_real.hex");
  for (const std::uint8_t start : {std::uint8_t(0x3E), std::uint8_t(0x24)})
    for (std::size_t size = 124; size <= 255; ++size) {
      CAPTURE(int(start), size);
      Data longer = payload;
      for (std::size_t at = payload.size(); at < size; ++at)
        longer.push_back(static_cast<std::uint8_t>(at * 7));
      const Data frame = reference::make_frame(start, 25, longer);
      thermopower::SbgcCodec<255, sbgc::ProtocolAuto> codec;
      int telemetry = 0;
      for (int repeat = 0; repeat < 20; ++repeat)
        for (const std::uint8_t byte : frame)
          for (bool got = codec.receive(byte, 0); got; got = codec.next()) {
            const sbgc::RealtimeData* data = codec.realtime_data();
            REQUIRE(data != nullptr);
            CHECK(int(data->motor_power(2)) == 250);
            CHECK(int(data->frame_imu_C()) == -7);
            CHECK(codec.frame().size == size);
            ++telemetry;
          }
      CHECK(telemetry == 20);
      CHECK(codec.counters().skipped_bytes == 0);
    }
}

TEST_CASE("known bug: the checksum leaves out the last payload byte") {
  for (const std::uint8_t start : {std::uint8_t(0x3E), std::uint8_t(0x24)}) {
    for (std::size_t size = 1; size <= 124; ++size) {
      Data bad = reference::make_frame(start, 25, ramp(size));
      bad[4 + size - 1] ^= 0x10;
      thermopower::SbgcCodec<124, sbgc::ProtocolAuto> codec;
      CHECK(receive_then_silence(codec, bad).empty());
    }
  }
}

TEST_CASE("lengths 0 to 255 arrive whole, in buffers that hold them exactly") {
  for (std::size_t size = 0; size <= 255; ++size) {
    thermopower::SbgcCodec<255, sbgc::ProtocolAuto> codec;
    for (const std::uint8_t start : {std::uint8_t(0x3E), std::uint8_t(0x24)}) {
      const auto frames = receive_all(codec, reference::make_frame(start, 200, ramp(size)));
      REQUIRE(frames.size() == 1);
      CHECK(frames[0].start == start);
      CHECK(frames[0].payload == ramp(size));
    }
  }
}

TEST_CASE("id 0 is never valid") {
  thermopower::SbgcCodec<124, sbgc::ProtocolAuto> codec;
  const Data bad = reference::make_frame(0x3E, 0, ramp(3)) + reference::make_frame(0x24, 0, {});
  CHECK(receive_all(codec, bad + request).size() == 1);
  CHECK(codec.counters().invalid_id == 2);
  CHECK(codec.counters().skipped_bytes == bad.size());
}
