// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The journal of the controllers in whole numbers: what of it survives wear, wraps, cuts of the power and damage.

#include "../catch.hpp"

#include <algorithm>
#include <vector>

#include <thermopower/actuator/hottest_journal.hpp>
#include <thermopower/actuator/retained_hottest.hpp>

using namespace thermopower;

namespace {

/// An EEPROM that counts its writes, loses power when told, and may be busy.
struct Eeprom {
  std::vector<uint8_t> bytes = std::vector<uint8_t>(1024, 0xff);
  std::vector<int> writes = std::vector<int>(1024, 0);
  int writes_left = -1;
  bool is_busy = false;
  uint8_t read(size_t at) const { return bytes[at]; }
  bool is_ready() const { return !is_busy; }
  void write(size_t at, uint8_t value) {
    if (writes_left == 0) return;
    if (writes_left > 0) --writes_left;
    bytes[at] = value;
    ++writes[at];
  }
};

struct Small : StandardJournal {
  static constexpr uint16_t start() { return 100; }
  static constexpr uint8_t slots() { return 5; }
  static constexpr uint8_t change_K() { return 2; }
};
typedef HottestJournal<Eeprom, OffTogether, Small> Journal;

const uint16_t second = 3906;  // ticks of 256 us

void put(Journal& journal, int16_t hottest_C) {
  journal.write_now(hottest_C);
  while (!journal.is_idle()) journal.work();
}
/// What a start finds: -999 for nothing. A change that is not recorded may have come on top.
int16_t found(Eeprom& eeprom) {
  Journal next(eeprom);
  int16_t hottest_C = -999;
  next.load(hottest_C);
  return hottest_C;
}

}  // namespace

TEST_CASE(
    "an erased memory has no record, and a start finds the newest of many, past the wrap of their counter") {
  Eeprom eeprom;
  CHECK(found(eeprom) == -999);
  Journal journal(eeprom);
  for (int i = 0; i < 700; ++i) {
    const int16_t hottest_C = static_cast<int16_t>(i * 37 % 256 - 60);
    put(journal, hottest_C);
    REQUIRE(found(eeprom) == hottest_C + Small::change_K());
  }
  CHECK(std::count(eeprom.writes.begin(), eeprom.writes.begin() + 100, 0) == 100);
  CHECK(std::count(eeprom.writes.begin() + 125, eeprom.writes.end(), 0) == 1024 - 125);
  for (size_t at = 100; at < 125; ++at) CHECK(eeprom.writes[at] == 140);  // worn alike
}

TEST_CASE("a journal that goes on after a restart goes on in the ring") {
  Eeprom eeprom;
  int16_t hottest_C = 0;
  for (int start = 0; start < 12; ++start) {
    Journal journal(eeprom);
    if (journal.load(hottest_C))
      while (!journal.is_idle()) journal.work();
    put(journal, static_cast<int16_t>(20 + start));
    CHECK(found(eeprom) == 20 + start + Small::change_K());
  }
  const int most = *std::max_element(eeprom.writes.begin(), eeprom.writes.end());
  CHECK(most <= 5);  // twelve starts, two records each but for the first, in five slots
}

TEST_CASE("power that fails at any byte of a record leaves the record before it") {
  for (int cut = 0; cut < 5; ++cut)
    for (int before = 1; before < 12; ++before) {
      Eeprom eeprom;
      Journal journal(eeprom);
      for (int i = 0; i < before; ++i) put(journal, static_cast<int16_t>(40 + i));
      eeprom.writes_left = cut;
      put(journal, 90);
      CAPTURE(cut, before);
      CHECK(found(eeprom) == 40 + before - 1 + Small::change_K());
    }
}

TEST_CASE("a damaged byte costs its record and no other") {
  Eeprom eeprom;
  Journal journal(eeprom);
  for (int16_t i = 0; i < 5; ++i) put(journal, static_cast<int16_t>(40 + i));
  for (size_t at = 100; at < 125; ++at)
    for (int bit = 0; bit < 8; ++bit) {
      Eeprom damaged = eeprom;
      damaged.bytes[at] = static_cast<uint8_t>(damaged.bytes[at] ^ (1u << bit));
      const bool is_newest = at >= 120;
      CHECK(found(damaged) == (is_newest ? 43 : 44) + Small::change_K());
    }
}

TEST_CASE("a record is due when the interval is over and the temperature has moved, up or down") {
  Eeprom eeprom;
  Journal journal(eeprom);
  put(journal, 50);
  const int written = eeprom.writes[100];
  for (int i = 0; i < 20; ++i) journal.step(51, second);  // a kelvin is no change
  CHECK(journal.is_idle());
  journal.step(52, second);
  CHECK_FALSE(journal.is_idle());
  while (!journal.is_idle()) journal.work();
  CHECK(found(eeprom) == 52 + Small::change_K());
  for (int i = 0; i < 7; ++i) journal.step(40, second);  // 7 s of 8
  CHECK(journal.is_idle());
  journal.step(40, 2 * second);
  CHECK_FALSE(journal.is_idle());
  while (!journal.is_idle()) journal.work();
  CHECK(found(eeprom) == 40 + Small::change_K());
  CHECK(eeprom.writes[100] == written);  // other slots
  // Any time is counted at most once: 65535 ticks and more are long enough.
  journal.step(40, 0xffff);
  journal.step(40, 0xffff);
  journal.step(60, 0);
  CHECK_FALSE(journal.is_idle());
}

TEST_CASE("a busy memory is not waited for, and a record that is being written is not begun again") {
  Eeprom eeprom;
  Journal journal(eeprom);
  put(journal, 50);
  eeprom.is_busy = true;
  journal.write_now(70);
  for (int i = 0; i < 10; ++i) journal.work();
  CHECK_FALSE(journal.is_idle());
  journal.write_now(90);  // nothing happens
  CHECK(found(eeprom) == 50 + Small::change_K());
  eeprom.is_busy = false;
  for (int i = 0; i < 5; ++i) journal.work();
  CHECK(journal.is_idle());
  CHECK(found(eeprom) == 70 + Small::change_K());
  journal.work();  // nothing is left
  CHECK(found(eeprom) == 70 + Small::change_K());
}

TEST_CASE("the journal itself writes the first record of a run") {
  Eeprom eeprom;
  {
    Journal first(eeprom);
    put(first, 70);
  }
  Journal second(eeprom);
  int16_t hottest_C = 0;
  REQUIRE(second.load(hottest_C));
  const auto writes = [&] {
    return std::count_if(eeprom.writes.begin(), eeprom.writes.end(), [](int n) { return n > 0; });
  };
  const auto before = writes();
  while (!second.is_idle()) second.work();  // nothing but what every loop calls
  CHECK(writes() == before + 5);
  CHECK(found(eeprom) == 70 + 2 * Small::change_K());
  SECTION("and the first record of all with the first temperature that it is told") {
    Eeprom erased;
    Journal journal(erased);
    CHECK_FALSE(journal.load(hottest_C));
    CHECK(journal.is_idle());
    journal.step(41, 1);
    while (!journal.is_idle()) journal.work();
    CHECK(found(erased) == 41 + Small::change_K());
  }
  SECTION("and after a reset with what was retained") {
    Journal reset(eeprom);
    reset.resume(93);
    while (!reset.is_idle()) reset.work();
    CHECK(found(eeprom) == 93 + Small::change_K());
  }
}

TEST_CASE("actuators that may be driven on start where the largest power settles, however cool the record") {
  Eeprom eeprom;
  Journal journal(eeprom);
  put(journal, 30);
  HottestJournal<Eeprom, DrivenOn<112>, Small> driven(eeprom);
  int16_t hottest_C = 0;
  REQUIRE(driven.load(hottest_C));
  CHECK(hottest_C == 112);
  put(journal, 150);
  HottestJournal<Eeprom, DrivenOn<112>, Small> hotter(eeprom);
  REQUIRE(hotter.load(hottest_C));
  CHECK(hottest_C == 150 + Small::change_K());
}

TEST_CASE("a memory that another program used is foreign: no value and no run of values is a record") {
  // Every pair of bytes with every pattern a program leaves behind: fills, counters, and what repeats.
  int accepted = 0;
  Eeprom eeprom;
  for (int value = 0; value < 256; ++value) {
    std::fill(eeprom.bytes.begin(), eeprom.bytes.end(), static_cast<uint8_t>(value));
    accepted += found(eeprom) != -999 ? 1 : 0;
    for (int step = 1; step < 256; step += 2) {
      for (size_t at = 0; at < 1024; ++at)
        eeprom.bytes[at] = static_cast<uint8_t>(value + static_cast<int>(at) * step);
      accepted += found(eeprom) != -999 ? 1 : 0;
    }
  }
  CHECK(accepted <= 1);
  // Random memories: a ring of 100 slots takes 100 / 2^24 of them for its own, one in 167 772.
  struct Large : StandardJournal {};
  uint32_t random = 1;
  const int memories = 20000;
  accepted = 0;
  for (int memory = 0; memory < memories; ++memory) {
    for (uint8_t& byte : eeprom.bytes) {
      random = random * 1664525u + 1013904223u;
      byte = static_cast<uint8_t>(random >> 24);
    }
    HottestJournal<Eeprom, OffTogether, Large> journal(eeprom);
    int16_t hottest_C = 0;
    accepted += journal.load(hottest_C) ? 1 : 0;
  }
  // With one check byte instead of three it is 32 % of them. More than three have a probability of 7e-6.
  CHECK(accepted <= 3);
}

TEST_CASE("what a reset leaves comes back, what a loss of power leaves does not") {
  RetainedHottest retained = {};
  CHECK_FALSE(retained.recall());
  for (int resets = 1; resets < 300; ++resets) {
    if (resets == 1) retained.keep(61 * 128 + 5, 240);
    REQUIRE(retained.recall());
    REQUIRE(int(retained.resets) == std::min(resets, 255));
    REQUIRE(retained.hottest == 61 * 128 + 5);
    REQUIRE(int(retained.power) == 240);
  }
  CHECK(retained.hottest_C() == 62);
  retained.keep(-5 * 128, 1);
  REQUIRE(retained.recall());
  CHECK(int(retained.resets) == 1);
  // Any changed bit, and any memory of one value.
  uint8_t* bytes = reinterpret_cast<uint8_t*>(&retained);
  for (size_t at = 0; at < sizeof(retained); ++at)
    for (int bit = 0; bit < 8; ++bit) {
      RetainedHottest damaged = retained;
      reinterpret_cast<uint8_t*>(&damaged)[at] = static_cast<uint8_t>(bytes[at] ^ (1u << bit));
      REQUIRE_FALSE(damaged.recall());
    }
  for (int value = 0; value < 256; ++value) {
    RetainedHottest noise;
    std::fill_n(reinterpret_cast<uint8_t*>(&noise), sizeof(noise), static_cast<uint8_t>(value));
    CHECK_FALSE(noise.recall());
  }
}
