// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "../catch.hpp"

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include <thermopower/actuator/power_up.hpp>

using namespace thermopower;

namespace {

/// An EEPROM that counts its writes, and loses power when told.
struct Eeprom {
  std::vector<uint8_t> bytes = std::vector<uint8_t>(1024, 0xff);
  std::vector<int> writes = std::vector<int>(1024, 0);
  int writes_left = -1;
  uint8_t read(size_t at) const { return bytes[at]; }
  void write(size_t at, uint8_t value) {
    if (writes_left == 0) return;
    if (writes_left > 0) --writes_left;
    bytes[at] = value;
    ++writes[at];
  }
};

StoredState warm(float winding_C = 61.27f) {
  return {winding_C, 48.5f, winding_C + 4.0f, 52.0f, 6.25f, 1.5f, 1000000UL, 0};
}
TwoNodeThermalModel<float>::Config motor() { return {8.0f, 80.0f, 1.0f, {0.2f}}; }
PowerUpFacts facts(float off_s) { return {true, warm(), off_s, 25.0f, 2.0f, 40.0f, 110.0f, 60.0f, 0.0f}; }

}  // namespace

TEST_CASE("a record's bytes are the same on every machine") {
  StoredState state = {-12.34f, 48.5f, -10.0f, 50.0f, 6.25f, 1.5f, 0x12345678UL, 0xabcd};
  uint8_t bytes[StoredState::size()];
  state.write(bytes);
  const uint8_t expected[20] = {0x54, 0x02, 0xcd, 0xab, 0x2e, 0xfb, 0xf2, 0x12, 0x18, 0xfc,
                                0x88, 0x13, 0x71, 0x02, 0x96, 0x00, 0x78, 0x56, 0x34, 0x12};
  // -1234 = 0xfb2e, 4850 = 0x12f2, -1000 = 0xfc18, 5000 = 0x1388, 625 = 0x0271, 150 = 0x0096
  CHECK(std::memcmp(bytes, expected, 20) == 0);
  const uint8_t digits[9] = {'1', '2', '3', '4', '5', '6', '7', '8', '9'};
  CHECK(StoredState::crc(digits, 9) == 0x29b1);  // the check value of CRC-16/CCITT-FALSE
  StoredState back = {};
  REQUIRE(back.read(bytes));
  CHECK(back.winding_C == Approx(-12.34f).margin(0.011));
  CHECK(back.body_C == 48.5f);
  CHECK(back.clock_s == 0x12345678UL);
  CHECK(back.sequence == 0xabcd);
}

TEST_CASE("a record never comes back colder, and NaN comes back as the hottest") {
  for (float value = -40.0f; value < 150.0f; value += 0.0371f) {
    StoredState state = warm(value), back = {};
    uint8_t bytes[StoredState::size()];
    state.write(bytes);
    REQUIRE(back.read(bytes));
    if (back.winding_C < value - 1e-5f || back.winding_C > value + 0.011f)
      FAIL(value << " came back as " << back.winding_C);
  }
  StoredState broken = warm(detail::not_a_number()), back = {};
  uint8_t bytes[StoredState::size()];
  broken.write(bytes);
  REQUIRE(back.read(bytes));
  CHECK(back.winding_C == 300.0f);
}

TEST_CASE("every damaged bit is noticed") {
  uint8_t bytes[StoredState::size()];
  warm().write(bytes);
  for (int bit = 0; bit < 8 * StoredState::size(); ++bit) {
    bytes[bit / 8] = static_cast<uint8_t>(bytes[bit / 8] ^ (1 << (bit % 8)));
    StoredState state = {};
    CHECK_FALSE(state.read(bytes));
    bytes[bit / 8] = static_cast<uint8_t>(bytes[bit / 8] ^ (1 << (bit % 8)));
  }
  uint8_t blank[StoredState::size()], zero[StoredState::size()] = {};
  std::memset(blank, 0xff, sizeof blank);
  StoredState state = {};
  CHECK_FALSE(state.read(blank));
  CHECK_FALSE(state.read(zero));
}

TEST_CASE("the journal spreads the wear, counts past its wrap, and survives a write cut off anywhere") {
  Eeprom memory;
  typedef StateJournal<Eeprom> Journal;
  Journal::Config config = Journal::Config::standard();
  config.slots = 4;
  REQUIRE(config.validate() == ConfigError::interval_s);  // four slots once a minute: worn out within a year
  config.interval_s = 120.0f;
  REQUIRE(config.validate() == ConfigError::none);
  {
    Journal journal(memory, config);
    StoredState newest;
    CHECK_FALSE(journal.load(newest));
    int written = 0;
    for (int i = 0; i < 70000; ++i)
      written += journal.step(warm(static_cast<float>(20 + 5 * (i % 2))), 120.0f) ? 1 : 0;
    CHECK(written == 70000);
    int most = 0;
    for (const int count : memory.writes) most = std::max(most, count);
    CHECK(most <= 70000 / 4 + 1);
    Journal again(memory, config);
    REQUIRE(again.load(newest));
    CHECK(newest.sequence == static_cast<uint16_t>(70000 - 1));  // across the wrap at 65536
  }
  const Eeprom before = memory;
  for (int cut = 0; cut <= StoredState::size(); ++cut) {
    Eeprom torn = before;
    Journal journal(torn, config);
    StoredState newest;
    REQUIRE(journal.load(newest));
    torn.writes_left = cut;
    journal.step(warm(99.0f), 120.0f);
    Journal again(torn, config);
    StoredState found = {};
    REQUIRE(again.load(found));  // there is always a whole one
    CHECK((found.sequence == newest.sequence ||
           (found.sequence == static_cast<uint16_t>(newest.sequence + 1) && found.winding_C == 99.0f)));
  }
}

TEST_CASE("nothing is written that has not changed, nor too often") {
  Eeprom memory;
  StateJournal<Eeprom> journal(memory, StateJournal<Eeprom>::Config::standard());
  CHECK(journal.step(warm(), 0.0f));  // the first of this run: what it started with
  CHECK_FALSE(journal.step(warm(70.0f), 59.0f));
  CHECK(journal.step(warm(70.0f), 2.0f));
  CHECK_FALSE(journal.step(warm(71.0f), 500.0f));  // less than 2 K
  CHECK(journal.step(warm(80.0f), 1.0f));
  // After a reset that was no loss of power the newest record still counts.
  StateJournal<Eeprom> reset(memory, StateJournal<Eeprom>::Config::standard());
  StoredState newest;
  REQUIRE(reset.load(newest));
  reset.resume(10);
  CHECK_FALSE(reset.step(warm(90.0f), 49.0f));
  CHECK(reset.step(warm(90.0f), 2.0f));
}

TEST_CASE("what does not change is written all the same, once in a while, and before a planned stop") {
  Eeprom memory;
  const auto config = StateJournal<Eeprom>::Config::standard();
  StateJournal<Eeprom> journal(memory, config);
  REQUIRE(journal.write_now(warm()));
  int records = 0;
  for (int s = 0; s < 3600; ++s) records += journal.step(warm(), 1.0f) ? 1 : 0;
  CHECK(records == 6);
  REQUIRE(journal.write_now(warm(63.0f)));
  StateJournal<Eeprom> again(memory, config);
  StoredState found = {};
  REQUIRE(again.load(found));
  CHECK(found.winding_C == 63.0f);
  CHECK(again.promise().longest_s == config.longest_s + config.step_s);
}

TEST_CASE("a slow memory is never waited for, and a record is whole when it says so") {
  struct Slow : Eeprom {
    int busy = 0;
    bool is_ready() { return busy-- <= 0; }
    void write(size_t at, uint8_t value) {
      Eeprom::write(at, value);
      busy = 3;
    }
  } memory;
  StateJournal<Slow> journal(memory, StateJournal<Slow>::Config::standard());
  REQUIRE(journal.write_now(warm()));
  StoredState found = {};
  CHECK_FALSE(StateJournal<Slow>(memory, StateJournal<Slow>::Config::standard()).load(found));
  CHECK_FALSE(journal.write_now(warm(70.0f)));  // one at a time
  int calls = 1;
  while (!journal.work()) ++calls;
  CHECK(calls > 2 * StoredState::size());
  CHECK(StateJournal<Slow>(memory, StateJournal<Slow>::Config::standard()).load(found));
  CHECK(found.winding_C == Approx(61.27f).margin(0.011));
}

TEST_CASE("what a reset leaves in memory is read back and counted; noise is neither") {
  Retained<StoredState> retained;
  std::memset(&retained, 0xa7, sizeof retained);
  StoredState found = {};
  CHECK_FALSE(retained.recall(found));
  CHECK(retained.boots == 0);
  retained.keep(warm(), 17);
  for (int reset = 1; reset <= 3; ++reset) {
    REQUIRE(retained.recall(found));
    CHECK(retained.boots == reset);
    CHECK(found.body_upper_C == 52.0f);
    CHECK(retained.since_s == 17);
  }
  retained.bytes[7] = static_cast<uint8_t>(retained.bytes[7] + 1);
  CHECK_FALSE(retained.recall(found));
  CHECK(retained.boots == 0);
  retained.keep(warm(), 17);
  retained.forget();
  CHECK_FALSE(retained.recall(found));
}

TEST_CASE("the rules of protection relays") {
  const float off_s = 300.0f;
  const PowerUpTemperatures new_load = AsNewLoad::start(facts(off_s), motor());
  const PowerUpTemperatures old_load = AsOldLoad::start(facts(off_s), motor());
  const PowerUpTemperatures stored = AsStored::start(facts(off_s), motor());
  const PowerUpTemperatures preset = AsPreset::start(facts(off_s), motor());
  const PowerUpTemperatures cooled = AsCooled::start(facts(off_s), motor());
  const PowerUpTemperatures hottest = AsHottest::start(facts(off_s), motor());

  TwoNodeThermalModel<double> truth({8.0, 80.0, 1.0, {0.2}}, 0.0);
  const auto after = [&](double heat_W) {
    truth.start(static_cast<double>(warm().winding_C), static_cast<double>(warm().body_C));
    for (int i = 0; i < 300; ++i) truth.step({heat_W, 0.0, {25.0, 0.0}}, 1.0);
    return truth.state();
  };
  CHECK(new_load.winding_C == Approx(after(2.0).winding_C).margin(0.01));
  CHECK(old_load.winding_C == Approx(after(6.25).winding_C).margin(0.01));
  CHECK(old_load.body_C == Approx(after(6.25).body_C).margin(0.01));
  CHECK(cooled.body_C == Approx(after(0.0).body_C).margin(0.01));
  CHECK(stored.winding_C == warm().winding_C);
  CHECK(preset.winding_C == 40.0f);
  CHECK(hottest.winding_C == 110.0f);
  CHECK(cooled.winding_C < new_load.winding_C);
  CHECK(new_load.winding_C < old_load.winding_C);
}

TEST_CASE("what is not known counts as hot: no record, no clock, no air") {
  PowerUpFacts none = facts(100.0f);
  none.has_stored = false;
  CHECK(AsCooled::start(none, motor()).winding_C == 110.0f);
  CHECK(AsNewLoad::start(none, motor()).winding_C == 110.0f);
  CHECK(AsStored::start(none, motor()).body_C == 60.0f);
  PowerUpFacts no_air = facts(100.0f);
  no_air.air_C = detail::not_a_number();
  CHECK(AsCooled::start(no_air, motor()).winding_C == 110.0f);
  // Left out, the air is not known either, and not 0 degC, in which an hour cools much.
  PowerUpFacts forgotten = {};
  forgotten.has_stored = true;
  forgotten.stored = warm();
  forgotten.off_s = 3600.0f;
  forgotten.preset_C = 40.0f;
  forgotten.hottest_winding_C = 110.0f;
  forgotten.hottest_body_C = 60.0f;
  CHECK(AsCooled::start(forgotten, motor()).winding_C == 110.0f);
  CHECK(AsStored::start(forgotten, motor()).body_C == 60.0f);
  CHECK(AsPreset::start(forgotten, motor()).winding_C == 110.0f);
  // An unknown time keeps the value: it does not cool.
  CHECK(AsCooled::start(facts(detail::not_a_number()), motor()).winding_C == warm().winding_C);
  CHECK(AsCooled::start(facts(-5.0f), motor()).winding_C == warm().winding_C);
  CHECK(AsCooled::start(facts(std::numeric_limits<float>::infinity()), motor()).winding_C ==
        warm().winding_C);
  // Nor does an unknown heat or setting: each alone makes the start the worst case.
  for (const float unknown : {detail::not_a_number(), std::numeric_limits<float>::infinity()}) {
    PowerUpFacts no_heat = facts(100.0f);
    no_heat.heat_now_W = unknown;
    CHECK(AsNewLoad::start(no_heat, motor()).winding_C == 110.0f);
    CHECK_FALSE(AsNewLoad::start(no_heat, motor()).rests_on_record);
    CHECK(AsCooled::start(no_heat, motor()).rests_on_record);  // which does not ask for it
    PowerUpFacts no_warming = facts(100.0f);
    no_warming.unrecorded_K = unknown;
    CHECK(AsStored::start(no_warming, motor()).winding_C == 110.0f);
    CHECK_FALSE(AsStored::start(no_warming, motor()).rests_on_record);
    PowerUpFacts no_setting = facts(100.0f);
    no_setting.preset_C = unknown;
    CHECK(AsPreset::start(no_setting, motor()).winding_C == 110.0f);
    PowerUpFacts set_in_unknown_air = facts(100.0f);
    set_in_unknown_air.air_C = unknown;
    CHECK(AsPreset::start(set_in_unknown_air, motor()).winding_C == 110.0f);
    CHECK(AsPreset::start(set_in_unknown_air, motor()).body_C == 60.0f);
  }
  // A clock that was set back says nothing.
  CHECK(std::isnan(PowerUpFacts::off_s_from(warm(), 999999UL, {60.0f, 2.0f, 600.0f})));
  CHECK(std::isnan(PowerUpFacts::off_s_from(warm(), StoredState::no_clock(), {60.0f, 2.0f, 600.0f})));
  // Only what is beyond the longest time between records was certainly spent without power.
  CHECK(PowerUpFacts::off_s_from(warm(), 1000300UL, {60.0f, 2.0f, 600.0f}) == 0.0f);
  CHECK(PowerUpFacts::off_s_from(warm(), 1001000UL, {60.0f, 2.0f, 600.0f}) == 399.0f);
  // What happened after the record makes the start warmer, and less sure.
  PowerUpFacts restless = facts(0.0f);
  restless.unrecorded_K = 8.0f;
  CHECK(AsStored::start(restless, motor()).winding_C == warm().winding_C + 4.0f);
  CHECK(AsStored::start(restless, motor()).std_K == Approx(std::sqrt(1.5f * 1.5f + 16.0f)));
}

TEST_CASE("nothing starts below the air, and nothing starts as warm as the air without a reason") {
  PowerUpFacts heat_wave = facts(1e6f);
  heat_wave.air_C = 45.0f;
  CHECK(AsCooled::start(heat_wave, motor()).winding_C == Approx(45.0f).margin(0.01));
  heat_wave.air_C = 80.0f;
  CHECK(AsStored::start(heat_wave, motor()).winding_C == 80.0f);
  CHECK(AsPreset::start(heat_wave, motor()).winding_C == 80.0f);
}
