// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "../fixed_point/units.hpp"
#include "detail/memory.hpp"

/// @file hottest_journal.hpp
/// The hottest of several actuators through resets and losses of power, for a small chip without a clock:
/// three bytes a record, a few hundred bytes of program. Where there is room, StateJournal keeps more.
///
/// A record is a sequence number, the temperature in whole degC plus 60, rounded up, and the complement of
/// their sum. A write that was cut off between bytes is never a record: the slot's old sequence number is
/// older by the number of slots, which no change of temperature within one turn of the ring makes up for.

namespace thermopower {

/// What a HottestJournal is tuned to. A set of your own has the same functions.
///
/// @snippet actuator_examples.cpp hottest journal
/// How to: @ref explain_observer.
struct StandardJournal {
  /// First byte in the memory.
  static constexpr uint16_t start() { return 0; }
  /// Records in the ring, 2 to 120; 100 last 2.5 years of changing every 8 s in an AVR's EEPROM (100 000
  /// writes).
  static constexpr uint8_t slots() { return 100; }
  /// Not more often than this, s; 1 .. 16. The time that an outage leaves open.
  static constexpr double interval_s() { return 8.0; }
  /// Nor unless the temperature has changed by this, whole K; at least 1.
  static constexpr uint8_t change_K() { return 1; }
};

/// Keeps the temperature of the hottest actuator. Nothing has cooled in an outage whose length nobody knows.
/// Whatever happened in `interval_s()` after the newest record may have left no other; later than that, the
/// hottest stayed within `change_K()` of it. `load()` counts the latter in; heat your actuators with the
/// largest power for the former.
/// @tparam Memory     has `uint8_t read(size_t)`, `void write(size_t, uint8_t)` and `bool is_ready()`: nothing
///                    is written before it says so, and nobody waits for it
/// @tparam Constants  StandardJournal, or your own
///
/// @snippet actuator_examples.cpp hottest journal
/// How to: @ref explain_observer.
template <class Memory, class Constants = StandardJournal>
class HottestJournal {
  static_assert(
      detail::IsMemory<Memory>::value,
      "thermopower: the first parameter of HottestJournal must be a memory: a type with uint8_t read(size_t) "
      "and void write(size_t, uint8_t)");
  static_assert(Constants::slots() >= 2 && Constants::slots() <= 120 && Constants::change_K() >= 1,
                "thermopower: a HottestJournal has 2 to 120 slots, and records changes of at least 1 K");

public:
  /// Touches nothing yet. @param memory  must outlive this object
  constexpr explicit HottestJournal(Memory& memory) noexcept : memory_(memory) {}

  /// `interval_s()` in microseconds.
  static constexpr uint32_t open_us() { return static_cast<uint32_t>(Constants::interval_s() * 1e6); }

  /// Finds the newest whole record. Call once, at power-up.
  /// @param hottest_C  not below the hottest then, nor as long as nothing was heated for longer than the
  ///                   interval since; unchanged without a record
  /// @return false when there is no record
  bool load(int16_t& hottest_C) noexcept {
    bool is_found = false;
    uint16_t at = Constants::start();
    for (uint8_t slot = 0; slot < Constants::slots(); ++slot) {
      const uint8_t sequence = memory_.read(at), code = memory_.read(at + 1u), check = memory_.read(at + 2u);
      at = static_cast<uint16_t>(at + 3);
      if (check != complement(sequence, code)) continue;
      // Newer by less than half a turn of the counter: right across the wrap.
      if (is_found && static_cast<uint8_t>(sequence - sequence_) >= 0x80u) continue;
      is_found = true;
      sequence_ = sequence;
      code_ = code;
      at_ = at;
    }
    if (is_found) hottest_C = static_cast<int16_t>(code_ + Constants::change_K() - 60);
    return is_found;
  }

  /// Begins a record when one is due. @param hottest_C  rounded up; -60 .. 195  @param ticks  time since the
  /// last call, in 256 us
  void step(int16_t hottest_C, uint16_t ticks) noexcept {
    constexpr uint16_t interval =
        static_cast<uint16_t>(fixed_point::detail::nearest(Constants::interval_s() * 3906.25));
    const uint16_t room = static_cast<uint16_t>(0xFFFFu - since_);
    since_ = ticks > room ? static_cast<uint16_t>(0xFFFFu) : static_cast<uint16_t>(since_ + ticks);
    const int16_t moved = static_cast<int16_t>(hottest_C + 60 - code_);
    if (since_ >= interval && (moved >= Constants::change_K() || moved <= -Constants::change_K()))
      write_now(hottest_C);
  }

  /// Begins a record whatever the interval says: at power-up and before a planned stop; `work()` writes it.
  /// Nothing happens while one is being written. @param hottest_C  rounded up; -60 .. 195
  void write_now(int16_t hottest_C) noexcept {
    if (left_ != 0) return;
    code_ = static_cast<uint8_t>(hottest_C + 60);
    ++sequence_;
    if (at_ >= Constants::start() + 3u * Constants::slots()) at_ = Constants::start();
    left_ = 3;
    since_ = 0;
  }

  /// Writes as much as the memory takes now. Call it often.
  void work() noexcept {
    if (left_ == 0 || !memory_.is_ready()) return;
    const uint8_t byte = left_ == 3 ? sequence_ : (left_ == 2 ? code_ : complement(sequence_, code_));
    memory_.write(at_, byte);
    ++at_;
    --left_;
  }
  /// Is nothing left to be written?
  bool is_idle() const noexcept { return left_ == 0; }

private:
  static uint8_t complement(uint8_t sequence, uint8_t code) noexcept {
    return static_cast<uint8_t>(~static_cast<uint8_t>(sequence + code));
  }

  Memory& memory_;
  uint16_t at_ = Constants::start();  // where the next byte goes
  // Ticks since the newest record; stops at 65535. From the start the first step is due.
  uint16_t since_ = 0xFFFFu;
  uint8_t sequence_ = 0, code_ = 0, left_ = 0;
};

}  // namespace thermopower
