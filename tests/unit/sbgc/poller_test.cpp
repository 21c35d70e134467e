// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/sbgc/poller.hpp>

#include <cstdint>

#include "../../catch.hpp"

using thermopower::sbgc::Poller;
using thermopower::sbgc::Turn;

TEST_CASE("poller: one request at a time, none before its answer, and no sooner than the interval") {
  Poller poller;
  CHECK(poller.turn(10000) == Turn::wait);
  CHECK(poller.turn(10001) == Turn::ask);
  CHECK(poller.is_waiting());
  CHECK(poller.turn(40000) == Turn::wait);
  poller.answered();
  CHECK(poller.turn(40001) == Turn::ask);
  poller.answered();
  CHECK(poller.turn(50001) == Turn::wait);
  CHECK(poller.turn(50002) == Turn::ask);
}

TEST_CASE("poller: an answer that does not come is missed once, and then asked for again") {
  Poller poller;
  REQUIRE(poller.turn(20000) == Turn::ask);
  CHECK(poller.turn(70000) == Turn::wait);
  CHECK(poller.turn(70001) == Turn::missed);
  CHECK_FALSE(poller.is_waiting());
  CHECK(poller.turn(70002) == Turn::ask);
  CHECK(poller.turn(70003) == Turn::wait);
  poller.answered();
  poller.answered();
  CHECK(poller.turn(80002) == Turn::wait);
}

TEST_CASE("poller: the clock may wrap") {
  Poller poller;
  REQUIRE(poller.turn(0xFFFFF000u) == Turn::ask);
  CHECK(poller.turn(0x1000u) == Turn::wait);
  poller.answered();
  CHECK(poller.turn(0xFFFFF000u + 10000u) == Turn::wait);
  CHECK(poller.turn(0xFFFFF000u + 10001u) == Turn::ask);
  CHECK(poller.turn(0xFFFFF000u + 10001u + 50001u) == Turn::missed);
}
