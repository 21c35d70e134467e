// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The journal of the controllers in whole numbers: what of it survives wear, wraps, cuts of the power and damage.

#include "../catch.hpp"

#include <algorithm>
#include <vector>

#include <thermopower/actuator/hottest_journal.hpp>

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
typedef HottestJournal<Eeprom, Small> Journal;

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
  CHECK(std::count(eeprom.writes.begin() + 115, eeprom.writes.end(), 0) == 1024 - 115);
  for (size_t at = 100; at < 115; ++at) CHECK(eeprom.writes[at] == 140);  // worn alike
}

TEST_CASE("a journal that goes on after a restart goes on in the ring") {
  Eeprom eeprom;
  int16_t hottest_C = 0;
  for (int start = 0; start < 12; ++start) {
    Journal journal(eeprom);
    journal.load(hottest_C);
    put(journal, static_cast<int16_t>(20 + start));
    CHECK(found(eeprom) == 20 + start + Small::change_K());
  }
  const int most = *std::max_element(eeprom.writes.begin(), eeprom.writes.end());
  CHECK(most <= 3);  // twelve records in five slots
}

TEST_CASE("power that fails at any byte of a record leaves the record before it") {
  for (int cut = 0; cut < 3; ++cut)
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
  for (size_t at = 100; at < 115; ++at)
    for (int bit = 0; bit < 8; ++bit) {
      Eeprom damaged = eeprom;
      damaged.bytes[at] = static_cast<uint8_t>(damaged.bytes[at] ^ (1u << bit));
      const bool is_newest = at >= 112;
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
  for (int i = 0; i < 3; ++i) journal.work();
  CHECK(journal.is_idle());
  CHECK(found(eeprom) == 70 + Small::change_K());
  journal.work();  // nothing is left
  CHECK(found(eeprom) == 70 + Small::change_K());
}
