// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/sbgc/poller.hpp>

#include <algorithm>
#include <cstdint>
#include <deque>

#include "../catch.hpp"

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
  CHECK(poller.turn(80003) == Turn::ask);
}

TEST_CASE("poller: after late answers have ceased to come, a request without an answer is missed as before") {
  Poller poller;
  REQUIRE(poller.turn(20000) == Turn::ask);
  REQUIRE(poller.turn(70001) == Turn::missed);
  REQUIRE(poller.turn(70002) == Turn::ask);
  poller.answered();  // to the first: that to the second may follow
  CHECK(poller.turn(80000) == Turn::wait);
  CHECK(poller.turn(130000) == Turn::wait);
  CHECK(poller.turn(130001) == Turn::ask);  // it did not
  CHECK(poller.turn(180001) == Turn::wait);
  CHECK(poller.turn(180002) == Turn::missed);
}

TEST_CASE("poller: of all that was asked in vain up to 255 late answers are waited for") {
  for (const int requests : {1, 2, 254, 255, 256, 257, 600}) {
    CAPTURE(requests);
    Poller poller;
    std::uint32_t now_us = 0;
    for (int asked = 0; asked < requests; now_us += 100) asked += poller.turn(now_us) == Turn::ask;
    for (int answers = 1; answers < std::min(requests, 255); ++answers) {
      poller.answered();
      REQUIRE(poller.is_waiting());
    }
    poller.answered();
    CHECK_FALSE(poller.is_waiting());
  }
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

namespace {

/// A board that answers each request after a time of its own, one after the other; an answer may get lost.
struct Board {
  std::deque<std::uint32_t> answers_us;  // when they arrive; lost ones arrive never
  unsigned most_outstanding = 0, asked = 0, answered = 0;

  void ask(std::uint32_t now_us, std::uint32_t delay_us, bool is_lost) {
    ++asked;
    if (is_lost) return;
    const std::uint32_t earliest_us = answers_us.empty() ? 0 : answers_us.back() + 11200;  // the line's pace
    answers_us.push_back(std::max(now_us + delay_us, earliest_us));
    most_outstanding = std::max(most_outstanding, static_cast<unsigned>(answers_us.size()));
  }
  bool take(std::uint32_t now_us) {
    if (answers_us.empty() || answers_us.front() > now_us) return false;
    answers_us.pop_front();
    ++answered;
    return true;
  }
};

/// @param delay_us  of the answer to the n-th request @param is_lost  its answer gets lost
template <class Delay, class Lost>
Board converse(std::uint32_t duration_us, Delay delay_us, Lost is_lost, std::uint32_t count_from_us = 0) {
  Poller poller;
  Board board;
  for (std::uint32_t now_us = 0; now_us < duration_us; now_us += 100) {
    if (now_us == count_from_us) board.most_outstanding = board.asked = board.answered = 0;
    if (board.take(now_us)) poller.answered();
    if (poller.turn(now_us) == Turn::ask) {
      const unsigned n = board.asked;
      board.ask(now_us, delay_us(n), is_lost(n));
    }
  }
  return board;
}

}  // namespace

TEST_CASE("poller: one late answer does not change the pace afterwards") {
  for (const std::uint32_t late_us : {50100u, 55000u, 70000u, 99000u, 140000u, 300000u, 900000u}) {
    INFO("late by " << late_us);
    bool was_late = false;
    const Board after = converse(
        5000000,
        [&](unsigned n) {
          const bool is_late = n == 20 && !was_late;
          was_late = was_late || is_late;
          return is_late ? late_us : 24000u;
        },
        [](unsigned) { return false; }, 3000000);
    CHECK(after.most_outstanding == 1);
    CHECK(after.asked >= 80);  // 24 ms each in two seconds
    CHECK(after.asked <= 84);
  }
}

TEST_CASE("poller: a lost answer costs a time-out, and the pace is the old one") {
  const Board board = converse(
      10000000, [](unsigned) { return 24000u; }, [](unsigned n) { return n % 10 == 9; });
  CHECK(board.most_outstanding == 1);
  CHECK(board.answered > 250);  // of 416 without a loss
}

TEST_CASE("poller: a board that is always late is asked no faster than it answers") {
  for (const std::uint32_t delay_us : {51000u, 60000u, 80000u, 110000u, 260000u}) {
    INFO("answers after " << delay_us);
    const Board board = converse(
        20000000, [&](unsigned) { return delay_us; }, [](unsigned) { return false; });
    CHECK(board.most_outstanding <= 2 + delay_us / 50000);  // it does not grow with time
    CHECK(board.asked <= board.answered + 2 + delay_us / 50000);
  }
}
