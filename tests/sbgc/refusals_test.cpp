// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// What each reader refuses for one reason alone, all others being out of the way: a frame of another command that
// is long enough, one of its own that is too short, and no frame at all.

#include <thermopower/sbgc/poller.hpp>

#include "support.hpp"

using namespace support;
namespace command = sbgc::command;

namespace {

// Reads nothing from frames of every other id, though their payload would do, and is left as it was.
template <class Message, class Told>
void refuses_other_ids(std::uint8_t own_id, const Data& payload, Told told) {
  Message message = Message();
  REQUIRE(message.read(view(own_id, payload)));
  REQUIRE(told(message) != told(Message()));
  for (int id = 0; id <= 255; ++id) {
    if (id == own_id) continue;
    Message other = Message();
    CAPTURE(id);
    CHECK_FALSE(other.read(view(static_cast<std::uint8_t>(id), payload)));
    CHECK(told(other) == told(Message()));
  }
}

// Announces three bytes and writes as many as it was told to.
struct Liar {
  int writes;
  std::uint8_t id() const { return 1; }
  std::uint8_t payload_size() const { return 3; }
  template <class Sink>
  void write_payload(Sink& sink) const {
    for (int i = 0; i < writes; ++i) sink.put(7);
  }
};

}  // namespace

TEST_CASE("refusals: a message is read from frames of its own id only") {
  const Data ones(21, 1);
  refuses_other_ids<sbgc::Error>(command::error, ones, [](const sbgc::Error& e) { return int(e.code); });
  refuses_other_ids<sbgc::BoardInfo>(command::board_info, ones,
                                     [](const sbgc::BoardInfo& i) { return int(i.board_version); });
  refuses_other_ids<sbgc::MotorsOff>(command::motors_off, ones,
                                     [](const sbgc::MotorsOff& m) { return int(m.mode); });
  refuses_other_ids<sbgc::Reset>(command::reset, ones, [](const sbgc::Reset& r) { return int(r.delay_ms); });
  refuses_other_ids<sbgc::DataStreamInterval>(
      command::data_stream_interval, ones,
      [](const sbgc::DataStreamInterval& d) { return int(d.interval_ms); });
  refuses_other_ids<sbgc::Confirm>(command::confirm, ones,
                                   [](const sbgc::Confirm& c) { return int(c.confirmed_id); });
  for (const std::size_t size : {13u, 15u})
    refuses_other_ids<sbgc::Control>(command::control, Data(size, 1),
                                     [](const sbgc::Control& c) { return int(c.axis[1].speed); });
  refuses_other_ids<sbgc::AdjVarsView>(command::set_adj_vars_val, ones,
                                       [](const sbgc::AdjVarsView& v) { return int(v.count()); });
  refuses_other_ids<sbgc::GetAdjVarsView>(command::get_adj_vars_val, ones,
                                          [](const sbgc::GetAdjVarsView& v) { return int(v.ids.size); });
  const sbgc::MotorsOn on;
  CHECK(on.read(view(command::motors_on, {})));
  CHECK_FALSE(on.read(view(command::motors_off, {})));
}

TEST_CASE("refusals: where there is no frame, the messages that take any id take none") {
  thermopower::SbgcCodec<> idle;
  REQUIRE(idle.frame().id == 0);
  sbgc::Request request(command::get_angles);
  CHECK_FALSE(request.read(idle.frame()));
  CHECK(request.id() == command::get_angles);
  const std::uint8_t byte = 5;
  sbgc::Raw raw = {9, {&byte, 1}};
  CHECK_FALSE(raw.read(idle.frame()));
  CHECK(raw.id() == 9);
  CHECK(raw.data.data == &byte);
}

TEST_CASE("refusals: a codec reads a message only while a frame is there, and only one of that kind") {
  using Codec = thermopower::SbgcCodec<>;
  Codec codec;
  sbgc::MotorsOff off;
  off.mode = sbgc::MotorsOff::brake;
  CHECK_FALSE(codec.read(off));
  CHECK(codec.realtime_data() == nullptr);

  const Data frame = encoded<sbgc::ProtocolV1>(off);
  for (const std::uint8_t byte : frame) codec.receive(byte, 0);
  REQUIRE(codec.has_frame());
  sbgc::MotorsOff back;
  CHECK(codec.read(back));
  CHECK(back.mode == sbgc::MotorsOff::brake);
  sbgc::Reset reset;
  CHECK_FALSE(codec.read(reset));           // a frame, of another kind
  CHECK(codec.realtime_data() == nullptr);  // as well

  codec.next();  // released: what was read a moment ago is no longer there
  sbgc::MotorsOff late;
  CHECK_FALSE(codec.read(late));
  CHECK(late.mode == sbgc::MotorsOff::released);
}

TEST_CASE("refusals: what writes more or less than it announced is no frame for who hears it") {
  for (const int writes : {0, 2, 3, 4, 300}) {
    CAPTURE(writes);
    VectorWire wire;
    const std::size_t sent = sbgc::send<sbgc::ProtocolV2, 1>(Liar{writes}, wire, sbgc::Version::v2);
    thermopower::SbgcCodec<16, sbgc::ProtocolV2> board;
    const bool heard = receive_then_silence(board, wire.all).size() == 1;
    CHECK(heard == (writes == 3));
    CHECK(sent == (writes == 3 ? wire.all.size() : 0u));
    // Nor may what it wrote beyond its announcement go out.
    CHECK(wire.all.size() <= 3u + sbgc::ProtocolV2::overhead);
    Data buffer(3u + sbgc::ProtocolV2::overhead, 0);
    CHECK(sbgc::encode<sbgc::ProtocolV2>(Liar{writes}, buffer.data(), buffer.size()) ==
          (writes == 3 ? buffer.size() : 0u));
  }
}

TEST_CASE("refusals: an answer that nobody asked for changes no pace") {
  sbgc::Poller poller;
  poller.answered();
  CHECK_FALSE(poller.is_waiting());
  CHECK(poller.turn(10000) == sbgc::Turn::wait);
  CHECK(poller.turn(10001) == sbgc::Turn::ask);
}

TEST_CASE(
    "refusals: a board silent for ever is asked once in a time-out, and is talked with when it is back") {
  sbgc::Poller poller;
  std::uint32_t now_us = 0;
  int asked = 0, missed = 0;
  for (; missed < 600; now_us += 100) {
    const sbgc::Turn turn = poller.turn(now_us);
    asked += turn == sbgc::Turn::ask;
    missed += turn == sbgc::Turn::missed;
  }
  CHECK(asked == 600);
  while (poller.turn(now_us) != sbgc::Turn::ask) now_us += 100;
  // Each late answer is waited for; after a time-out without one, the pace is the usual.
  poller.answered();
  CHECK(poller.is_waiting());
  const std::uint32_t answered_us = now_us;
  while (poller.turn(now_us) != sbgc::Turn::ask) now_us += 100;
  CHECK(now_us - answered_us <= 50000u + 200u);
  poller.answered();
  CHECK_FALSE(poller.is_waiting());
  const std::uint32_t next_us = now_us;
  while (poller.turn(now_us) != sbgc::Turn::ask) now_us += 100;
  CHECK(now_us - next_us <= 10000u + 200u);
}
