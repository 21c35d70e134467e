// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// What power-up decides on, one reason at a time: each fact alone decides, all others being as they should.

#include "../catch.hpp"

#include <limits>
#include <thermopower/actuator/power_up.hpp>
#include <vector>

using namespace thermopower;

namespace {

const float nan_ = std::numeric_limits<float>::quiet_NaN(), infinite = std::numeric_limits<float>::infinity();

StoredState record() { return {60.0f, 50.0f, 62.0f, 52.0f, 5.0f, 1.0f, 1000u, 0}; }

// 25 W in 8 J/K, 1 W/K to 80 J/K, 0.2 W/K to the air: settles 125 K above it.
StartAssumptions assumptions() { return {25.0f, 8.0f, 8.0f, 80.0f, 80.0f, 1.0f, 0.2f, 0.2f, 110.0f, 60.0f}; }

StartFacts facts(float age_s, bool is_driven = false) {
  return {true, record(), {60.0f, 2.0f, 600.0f}, age_s, 25.0f, is_driven};
}

struct Memory {
  std::vector<std::uint8_t> bytes = std::vector<std::uint8_t>(512, 0xff);
  std::uint8_t read(std::size_t at) const { return bytes[at]; }
  void write(std::size_t at, std::uint8_t value) { bytes[at] = value; }
};

}  // namespace

TEST_CASE("start bounds: only an age that is known cools, and only an actuator that was off") {
  const StartBounds unknown = assumptions().start(facts(nan_));
  CHECK(assumptions().start(facts(infinite)).winding_upper_C == unknown.winding_upper_C);
  CHECK(assumptions().start(facts(-1.0f)).winding_upper_C == unknown.winding_upper_C);
  CHECK(assumptions().start(facts(600.0f)).body_upper_C == unknown.body_upper_C);  // not longer than promised
  CHECK(assumptions().start(facts(3600.0f)).body_upper_C < unknown.body_upper_C - 10.0f);
  // Driven on for an hour, it is as hot as all heat for ever makes it, not cooler.
  const StartBounds driven = assumptions().start(facts(3600.0f, true));
  CHECK(driven.body_upper_C > 140.0f);
  CHECK(driven.winding_upper_C > driven.body_upper_C);
}

TEST_CASE("start bounds: without a record or an air the limits count, or where it settles if driven on") {
  StartFacts none = facts(3600.0f);
  none.has_stored = false;
  CHECK(assumptions().start(none).winding_upper_C == 110.0f);
  CHECK(assumptions().unrecorded_K(none) == 0.0f);
  CHECK(assumptions().unrecorded_K(facts(3600.0f)) > 0.0f);
  none.is_driven_while_off = true;
  CHECK(assumptions().start(none).body_upper_C == Approx(25.0f + 125.0f));
  CHECK(assumptions().start(none).winding_upper_C == Approx(25.0f + 125.0f + 25.0f));
  for (const bool is_driven : {false, true}) {
    StartFacts no_air = facts(3600.0f, is_driven);
    no_air.air_upper_C = nan_;
    CHECK(assumptions().start(no_air).winding_upper_C == 110.0f);
    CHECK(assumptions().start(no_air).body_upper_C == 60.0f);
  }
}

TEST_CASE("start bounds: air that is left out is not 0 degC") {
  StartFacts forgotten = {true, record(), {60.0f, 2.0f, 600.0f}, 3600.0f, {}, false};
  CHECK(assumptions().start(forgotten).winding_upper_C == 110.0f);
  CHECK(assumptions().start(forgotten).body_upper_C == 60.0f);
  // Nor does it say that nothing warmed: then all heat stays inside.
  CHECK(assumptions().unrecorded_K(forgotten) >= assumptions().unrecorded_K(facts(3600.0f)));
  forgotten.is_driven_while_off = true;
  CHECK(assumptions().unrecorded_K(forgotten) >= 25.0f * 3600.0f / 80.0f);
  forgotten.age_s = nan_;
  CHECK(std::isinf(assumptions().unrecorded_K(forgotten)));
}

TEST_CASE("start bounds: where the winding may be the slow one, no cooling is counted on") {
  StartAssumptions loose = assumptions();
  const StartBounds hot = {80.0f, 50.0f};
  CHECK(loose.cooled(hot, 25.0f, 3600.0f).winding_upper_C < 40.0f);
  loose.least_coupling_W_per_K = 0.01f;  // 0.2 W/K outside: the body follows the air, the winding neither
  for (const float time_s : {0.0f, 3600.0f, 1.0e6f}) {
    CHECK(loose.cooled(hot, 25.0f, time_s).winding_upper_C == 80.0f);
    CHECK(loose.cooled(hot, 25.0f, time_s).body_upper_C == 80.0f);
  }
}

TEST_CASE("a record differs as soon as one of its four temperatures does, and when one is not known") {
  CHECK_FALSE(record().differs(record(), 2.0f));
  float StoredState::*const temperatures[] = {&StoredState::winding_C, &StoredState::body_C,
                                              &StoredState::winding_upper_C, &StoredState::body_upper_C};
  for (float StoredState::*const one : temperatures)
    for (const float change_K : {2.0f, -2.0f, nan_}) {
      StoredState other = record();
      other.*one += change_K;
      CHECK(record().differs(other, 2.0f));
      CHECK(other.differs(record(), 2.0f));
      if (change_K == change_K) CHECK_FALSE(record().differs(other, 2.1f));
    }
}

TEST_CASE("what does not fit a record comes back as the end of its range, and heat below 0 as none") {
  const auto back = [](StoredState state) {
    std::uint8_t bytes[StoredState::size()];
    state.write(bytes);
    StoredState read = {};
    REQUIRE(read.read(bytes));
    return read;
  };
  StoredState extreme = record();
  extreme.winding_C = -400.0f;
  extreme.body_C = 400.0f;
  extreme.heat_W = 1.0e6f;
  extreme.std_K = nan_;
  CHECK(back(extreme).winding_C == -300.0f);
  CHECK(back(extreme).body_C == 300.0f);
  CHECK(back(extreme).heat_W == 655.0f);
  CHECK(back(extreme).std_K == 655.0f);
  extreme.heat_W = -3.0f;
  CHECK(back(extreme).heat_W == 0.0f);
}

TEST_CASE("a journal with a wrong constant names it, and writes nothing") {
  typedef StateJournal<Memory> Journal;
  const Journal::Config standard = Journal::Config::standard();
  REQUIRE(standard.validate() == ConfigError::none);
  const auto refused = [&](ConfigError error, void (*spoil)(Journal::Config&)) {
    Journal::Config config = standard;
    spoil(config);
    CHECK(config.validate() == error);
    Memory memory;
    Journal journal(memory, config);
    CHECK_FALSE(journal.step(record(), 1.0e4f));
    CHECK_FALSE(journal.write_now(record()));
    journal.work();
    CHECK(memory.bytes == Memory().bytes);
  };
  refused(ConfigError::slots, [](Journal::Config& c) { c.slots = 1; });
  refused(ConfigError::interval_s, [](Journal::Config& c) { c.interval_s = 0.0f; });
  refused(ConfigError::interval_s, [](Journal::Config& c) { c.interval_s = infinite; });
  refused(ConfigError::interval_s, [](Journal::Config& c) { c.endurance = 1000; });  // worn out in 11 days
  refused(ConfigError::longest_s, [](Journal::Config& c) { c.longest_s = nan_; });
  refused(ConfigError::longest_s, [](Journal::Config& c) { c.longest_s = c.interval_s - 1.0f; });
  refused(ConfigError::change_K, [](Journal::Config& c) { c.change_K = -1.0f; });
}

TEST_CASE("a time that runs backwards or is none makes no record due, and an age stops at its largest") {
  Memory memory;
  StateJournal<Memory> journal(memory, StateJournal<Memory>::Config::standard());
  REQUIRE(journal.write_now(record()));
  while (!journal.work()) {
  }
  StoredState other = record();
  other.winding_C += 10.0f;
  for (const float dt_s : {-100.0f, nan_, 0.0f, 59.0f}) CHECK_FALSE(journal.step(other, dt_s));
  CHECK(journal.since_s() == 60);
  CHECK(journal.step(other, 1.0f));
  CHECK(journal.since_s() == 1);
  journal.resume(65535u);
  CHECK(journal.since_s() == 65535u);
  journal.resume(65533u);
  CHECK(journal.since_s() == 65534u);
}

TEST_CASE("what survived a reset counts only whole, and the count of resets starts again after its last") {
  Retained<StoredState> retained;
  StoredState found = {};
  const auto whole = [&] {
    retained.keep(record(), 17);
    retained.boots = 3;
    retained.boots_check = static_cast<std::uint16_t>(~3u);
  };
  whole();
  CHECK(retained.recall(found));
  CHECK(retained.boots == 4);
  whole();
  retained.since_check ^= 1u;
  CHECK_FALSE(retained.recall(found));
  CHECK(retained.boots == 0);
  whole();
  retained.boots_check ^= 1u;
  CHECK_FALSE(retained.recall(found));
  whole();
  retained.boots = 0xffffu;
  retained.boots_check = 0;
  CHECK(retained.recall(found));
  CHECK(retained.boots == 0);
}
