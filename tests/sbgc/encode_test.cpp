// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Encoding into buffers and onto wires: refuses what does not fit, writes nothing half.

#include "support.hpp"

using namespace support;

namespace {

struct TooMuch {
  std::uint8_t id() const { return 1; }
  std::uint8_t payload_size() const { return 3; }
  template <class Sink>
  void write_payload(Sink& sink) const {
    for (int i = 0; i < 300; ++i) sink.put(7);
  }
};

struct TooLittle : TooMuch {
  template <class Sink>
  void write_payload(Sink& sink) const {
    sink.put(7);
  }
};

struct SilentWire {
  Data all;
  void write(const std::uint8_t* data, std::size_t size) { all.insert(all.end(), data, data + size); }
};

struct FullWire {
  std::size_t room;
  std::size_t calls = 0;
  int write(const std::uint8_t*, std::size_t size) {
    ++calls;
    const std::size_t took = size < room ? size : room;
    room -= took;
    return static_cast<int>(took);
  }
};

sbgc::Raw raw(const Data& payload) {
  return sbgc::Raw{25, {payload.data(), static_cast<std::uint8_t>(payload.size())}};
}

}  // namespace

TEST_CASE("encode: a buffer too small is refused and left as it was") {
  const Data payload(20, 5);
  for (const sbgc::Version version : {sbgc::Version::v1, sbgc::Version::v2}) {
    const std::size_t needed = sbgc::frame_size(raw(payload), version);
    CHECK(needed == (version == sbgc::Version::v1 ? 25u : 26u));
    for (std::size_t capacity = 0; capacity < needed; ++capacity) {
      Data buffer(capacity, 0xEE);
      CHECK(sbgc::encode<sbgc::ProtocolAuto>(raw(payload), buffer.data(), capacity, version) == 0);
      CHECK(buffer == Data(capacity, 0xEE));
    }
    Data buffer(needed + 1, 0xEE);
    CHECK(sbgc::encode<sbgc::ProtocolAuto>(raw(payload), buffer.data(), needed, version) == needed);
    CHECK(buffer.back() == 0xEE);
  }
  CHECK(sbgc::encode<sbgc::ProtocolV1>(raw(payload), nullptr, 100) == 0);
}

TEST_CASE("encode: id 0 and a version the policy does not speak are refused") {
  Data buffer(64, 0xEE);
  CHECK(sbgc::encode<sbgc::ProtocolV1>(sbgc::Request(0), buffer.data(), buffer.size()) == 0);
  CHECK(sbgc::encode<sbgc::ProtocolV1>(sbgc::Request(25), buffer.data(), buffer.size(), sbgc::Version::v2) ==
        0);
  CHECK(sbgc::encode<sbgc::ProtocolV2>(sbgc::Request(25), buffer.data(), buffer.size(), sbgc::Version::v1) ==
        0);
  CHECK(buffer == Data(64, 0xEE));
  VectorWire wire;
  CHECK(sbgc::send<sbgc::ProtocolV1>(sbgc::Request(0), wire) == 0);
  CHECK(wire.writes.empty());
}

TEST_CASE(
    "encode: a message that writes more or less than it announced is refused, and no memory is overrun") {
  Data buffer(8, 0);
  CHECK(sbgc::encode<sbgc::ProtocolV1>(TooMuch(), buffer.data(), buffer.size()) == 0);
  CHECK(sbgc::encode<sbgc::ProtocolV1>(TooLittle(), buffer.data(), buffer.size()) == 0);
  VectorWire wire;
  CHECK(sbgc::send<sbgc::ProtocolV1>(TooMuch(), wire) == 0);
  CHECK(sbgc::send<sbgc::ProtocolV1>(TooLittle(), wire) == 0);
  CHECK(wire.writes.empty());
}

TEST_CASE("encode: a payload of 256 bytes is refused before anything is written") {
  const Data data(255, 1);
  sbgc::Confirm confirm;
  confirm.data = sbgc::Bytes{data.data(), 255};
  REQUIRE(confirm.payload_size() == 256);
  Data buffer(300, 0xEE);
  CHECK(sbgc::encode<sbgc::ProtocolV1>(confirm, buffer.data(), buffer.size()) == 0);
  CHECK(buffer == Data(300, 0xEE));
  VectorWire wire;
  CHECK(sbgc::send<sbgc::ProtocolV1>(confirm, wire) == 0);
  CHECK(wire.all.empty());
  confirm.data.size = 254;
  CHECK(sbgc::encode<sbgc::ProtocolV1>(confirm, buffer.data(), buffer.size()) == 260);
}

TEST_CASE("send: writes the same bytes as encode, short frames in one go, whatever the portion") {
  for (std::size_t size = 0; size <= 255; ++size) {
    const Data payload(size, static_cast<std::uint8_t>(size));
    const Data frame = reference::make_frame(0x24, 25, payload);
    VectorWire wire;
    CHECK(sbgc::send<sbgc::ProtocolV2>(raw(payload), wire) == frame.size());
    REQUIRE(wire.all == frame);
    CHECK(wire.writes.size() == (frame.size() + 39) / 40);
    VectorWire byte_by_byte;
    CHECK(sbgc::send<sbgc::ProtocolV2, 1>(raw(payload), byte_by_byte) == frame.size());
    REQUIRE(byte_by_byte.all == frame);
  }
}

TEST_CASE("send: a wire whose write() returns nothing takes everything") {
  SilentWire wire;
  thermopower::SbgcCodec<> codec;
  CHECK(codec.send(sbgc::Request(25), wire) == 5);
  CHECK(wire.all == reference::make_frame(0x3E, 25, {}));
}

TEST_CASE("send: stops at a wire that refuses, and says how much it took") {
  const Data payload(200, 1);
  for (std::size_t room = 0; room < 205; ++room) {
    FullWire wire{room};
    CHECK(sbgc::send<sbgc::ProtocolV1>(raw(payload), wire) == room);
    CHECK(wire.calls == room / 40 + 1);
  }
  FullWire wire{3};
  CHECK(sbgc::send<sbgc::ProtocolV1>(sbgc::Request(25), wire) == 3);
}

TEST_CASE("send: a wire that boasts of more than it was handed took no more than the frame") {
  struct BoastfulWire {
    std::size_t write(const std::uint8_t*, std::size_t size) { return size + 7; }
  } wire;
  for (const std::size_t size : {0u, 10u, 200u}) {
    const Data payload(size, 1);
    CHECK(sbgc::send<sbgc::ProtocolV1>(raw(payload), wire) == size + 5);
  }
}

TEST_CASE("send: two codecs, a controller and a board, talk") {
  thermopower::SbgcCodec<> controller;
  thermopower::SbgcCodec<124, sbgc::ProtocolAuto> board;
  VectorWire to_board;
  VectorWire to_controller;

  controller.send(sbgc::Request(sbgc::command::realtime_data_4), to_board);
  for (const std::uint8_t byte : to_board.all) {
    if (!board.receive(byte, 0)) continue;
    sbgc::Request request;
    REQUIRE(board.read(request));
    sbgc::RealtimeFields answer;
    answer.imu_C = 31;
    answer.battery_cV = 1480;
    board.send(answer, to_controller);
  }
  const sbgc::RealtimeData* telemetry = nullptr;
  for (const std::uint8_t byte : to_controller.all)
    if (controller.receive(byte, 0)) telemetry = controller.realtime_data();
  REQUIRE(telemetry != nullptr);
  CHECK(int(telemetry->imu_C()) == 31);
  CHECK(is_near(telemetry->battery_V(), 14.8));
  CHECK(to_controller.writes.size() == 4);  // 129 bytes in portions of 40

  sbgc::Confirm confirm;
  CHECK_FALSE(controller.read(confirm));  // the frame at hand is another one
}

TEST_CASE("encode: a frame of v1 is 5 bytes and its payload, one of v2 is 6") {
  CHECK(int(sbgc::ProtocolV1::overhead) == 5);
  CHECK(int(sbgc::ProtocolV2::overhead) == 6);
  CHECK(int(sbgc::ProtocolAuto::overhead) == 6);  // the longer of the two
}

TEST_CASE("encode: a codec encodes in the version it sends in") {
  thermopower::SbgcCodec<124, sbgc::ProtocolAuto> codec;
  Data buffer(10, 0);
  CHECK(codec.encode(sbgc::Request(25), buffer.data(), buffer.size()) == 5);
  CHECK(Data(buffer.begin(), buffer.begin() + 5) == reference::make_frame(0x3E, 25, {}));
  codec.protocol().send_in(sbgc::Version::v2);
  CHECK(codec.encode(sbgc::Request(25), buffer.data(), buffer.size()) == 6);
  CHECK(Data(buffer.begin(), buffer.begin() + 6) == reference::make_frame(0x24, 25, {}));
  CHECK(codec.encode(sbgc::Request(25), buffer.data(), 5) == 0);
}
