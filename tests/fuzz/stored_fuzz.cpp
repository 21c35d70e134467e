// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Any bytes in the memory that survives an outage: what is believed of them is whole, none the colder for being stored again, and
// the newest that there is; what is not whole changes nothing.

#include <thermopower/actuator/hottest_journal.hpp>
#include <thermopower/actuator/record_ring.hpp>
#include <thermopower/actuator/stored_state.hpp>
#include <thermopower/config_record.hpp>
#include <thermopower/control/certified/limiter.hpp>
#include <thermopower/control/safety_limiter.hpp>
#include <thermopower/control/step_power_law.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

namespace {

using namespace thermopower;

void require(bool holds, const char* claim) {
  if (holds) return;
  std::fprintf(stderr, "stored_fuzz: does not hold: %s\n", claim);
  std::abort();
}

/// Memory whose first bytes are the input, and whose others are erased.
struct Memory {
  std::vector<std::uint8_t> bytes;
  Memory(const std::uint8_t* data, std::size_t size) : bytes(512, 0xff) {
    if (size > 0) std::memcpy(bytes.data(), data, size < bytes.size() ? size : bytes.size());
  }
  std::uint8_t read(std::size_t at) const { return bytes[at]; }
  void write(std::size_t at, std::uint8_t value) { bytes[at] = value; }
  static bool is_ready() { return true; }
};

bool is_same(const StoredState& a, const StoredState& b) {
  return a.sequence == b.sequence && a.clock_s == b.clock_s &&
         std::memcmp(&a.winding_C, &b.winding_C, 4) == 0 && std::memcmp(&a.body_C, &b.body_C, 4) == 0;
}

void one_record(const std::uint8_t* data, std::size_t size) {
  if (size < StoredState::size()) return;
  StoredState untouched = {1.0f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f, 7, 8};
  const StoredState before = untouched;
  if (!untouched.read(data)) {
    require(is_same(untouched, before), "what is no record changes nothing");
    return;
  }
  const StoredState first = untouched;
  for (const float value_C : {first.winding_C, first.body_C, first.winding_upper_C, first.body_upper_C})
    require(value_C >= -328.0f && value_C <= 328.0f, "a record's temperatures are what 16 bits hold");
  require(first.heat_W >= 0.0f && first.std_K >= 0.0f, "heat and uncertainty are not negative");
  std::uint8_t bytes[StoredState::size()];
  first.write(bytes);
  StoredState again;
  require(again.read(bytes), "what was read can be stored");
  if (first.winding_C < 300.0f)
    require(again.winding_C >= first.winding_C - 1e-3f, "stored again it is no colder");
  if (first.body_C < 300.0f) require(again.body_C >= first.body_C - 1e-3f, "stored again it is no colder");
  bytes[size % StoredState::size()] = static_cast<std::uint8_t>(bytes[size % StoredState::size()] ^ 0x10u);
  require(!again.read(bytes), "a record with a changed bit is none");
}

void a_ring(const std::uint8_t* data, std::size_t size) {
  Memory memory(data, size);
  const std::uint8_t slots = static_cast<std::uint8_t>(2 + size % 19);
  RecordRing<Memory, StoredState> ring(memory, 0, slots);
  StoredState newest = {};
  const bool is_found = ring.load(newest);
  bool is_there = false;
  for (std::size_t slot = 0; slot < slots; ++slot) {
    StoredState one = {};
    if (!one.read(memory.bytes.data() + slot * StoredState::size())) continue;
    require(is_found, "a whole record is found");
    is_there = is_there || is_same(one, newest);
  }
  require(is_there == is_found, "what is found is one of those that are there");
  const StoredState now = {50.0f, 40.0f, 55.0f, 45.0f, 1.0f, 1.0f, 1000, 0};
  require(ring.begin(now), "nothing is being written");
  require(ring.work(), "a memory that is ready takes it all");
  RecordRing<Memory, StoredState> next(memory, 0, slots);
  StoredState found = {};
  require(next.load(found), "what was written is found");
  if (is_found)
    require(static_cast<std::uint16_t>(found.sequence - newest.sequence) < 0x8000u, "nothing older is found");
}

void after_a_reset(const std::uint8_t* data, std::size_t size) {
  Retained<StoredState> kept;
  if (size < sizeof kept) return;
  std::memcpy(&kept, data, sizeof kept);
  StoredState found = {1.0f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f, 7, 8};
  if (!kept.recall(found)) require(kept.boots == 0, "noise is no count of resets");
  const StoredState now = {50.0f, 40.0f, 55.0f, 45.0f, 1.0f, 1.0f, 1000, 3};
  kept.keep(now, 12);
  require(kept.recall(found) && found.body_C == 40.0f && found.sequence == 3, "what was kept comes back");
  kept.forget();
  require(!kept.recall(found), "what was forgotten does not");
}

void hottest(const std::uint8_t* data, std::size_t size) {
  Memory memory(data, size);
  HottestJournal<Memory, OffTogether> journal(memory);
  std::int16_t hottest_C = 999;
  if (journal.load(hottest_C))
    require(hottest_C >= -60 && hottest_C <= 255 - 60 + 1, "a record's temperature is what a byte holds");
  else require(hottest_C == 999, "without a record nothing changes");
  while (!journal.is_idle()) journal.work();
  journal.write_now(100);
  while (!journal.is_idle()) journal.work();
  HottestJournal<Memory, OffTogether> next(memory);
  require(next.load(hottest_C), "what was written is found");
}

template <class Config>
void a_configuration(const std::uint8_t* data, std::size_t size, Config config) {
  std::uint8_t before[512], after[512];
  const std::size_t length = write_config(config, 1, before, sizeof before);
  const ConfigRead read = read_config(config, 1, data, size);
  if (read.error == ConfigRecordError::none) {
    require(config.validate() == ConfigError::none, "a configuration that is believed is a good one");
    require(write_config(config, 1, after, sizeof after) == length && std::memcmp(after, data, length) == 0,
            "and its record is the one that was read");
  } else {
    require(write_config(config, 1, after, sizeof after) == length && std::memcmp(after, before, length) == 0,
            "a record that is not believed changes nothing");
  }
}

std::string record_text() {
  const StoredState state = {61.0f, 48.0f, 65.0f, 52.0f, 6.0f, 1.5f, 1000000, 41};
  std::uint8_t bytes[StoredState::size()];
  state.write(bytes);
  return std::string(reinterpret_cast<const char*>(bytes), sizeof bytes);
}
template <class Config>
std::string config_text(const Config& config) {
  std::uint8_t bytes[512];
  const std::size_t size = write_config(config, 1, bytes, sizeof bytes);
  return std::string(reinterpret_cast<const char*>(bytes), size);
}

}  // namespace

std::vector<std::string> fuzz_seeds() {
  Retained<StoredState> kept = {};
  StoredState found;
  kept.recall(found);
  kept.keep({61.0f, 48.0f, 65.0f, 52.0f, 6.0f, 1.5f, 1000000, 41}, 3);
  Memory memory(nullptr, 0);
  HottestJournal<Memory, OffTogether> journal(memory);
  for (std::int16_t hottest_C = 40; hottest_C < 60; ++hottest_C) {
    journal.write_now(hottest_C);
    while (!journal.is_idle()) journal.work();
  }
  return {"0" + record_text(),
          "1" + record_text() + record_text() + std::string(60, '\xff'),
          "2" + std::string(reinterpret_cast<const char*>(&kept), sizeof kept),
          "3" + std::string(reinterpret_cast<const char*>(memory.bytes.data()), 90),
          "4" + config_text(SafetyLimiterConfig::standard()),
          "5" + config_text(StepPowerConfig::standard()),
          "6" + config_text(CertifiedLimiter<>::Config::standard())};
}
std::vector<std::string> fuzz_pieces() {
  return {record_text(), std::string(3, '\xff'),  std::string(4, '\0'), "T",
          "TP\x01",      std::string("\x02\0", 2)};
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::uint8_t* const bytes = data + 1;
  switch (data[0] % 7u) {
    case '0' % 7:
      one_record(bytes, size - 1);
      break;
    case '1' % 7:
      a_ring(bytes, size - 1);
      break;
    case '2' % 7:
      after_a_reset(bytes, size - 1);
      break;
    case '3' % 7:
      hottest(bytes, size - 1);
      break;
    case '4' % 7:
      a_configuration(bytes, size - 1, SafetyLimiterConfig::standard());
      break;
    case '5' % 7:
      a_configuration(bytes, size - 1, StepPowerConfig::standard());
      break;
    default:
      a_configuration(bytes, size - 1, CertifiedLimiter<>::Config::standard());
  }
  return 0;
}
