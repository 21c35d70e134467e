// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "../detail/crc16.hpp"
#include "../fixed_point/units.hpp"
#include "detail/memory.hpp"
#include "while_off.hpp"

/// @file hottest_journal.hpp
/// The hottest of several actuators through resets and losses of power, for a small chip without a clock:
/// five bytes a record, a few hundred bytes of program. Where there is room, StateJournal keeps more.
///
/// A record is a sequence number, the temperature in whole degC plus 60, rounded up, the complement of their sum, and a
/// CRC-16. A write that was cut off between bytes is never a record. Bytes that another program left are a record with a
/// probability of 2^-24, so that a ring of 120 slots finds one among them with less than 2^-17.

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
/// @tparam WhileOff   what happens to the actuators while this controller has no power: OffTogether, or DrivenOn. You have
///                    to say it: nothing can be taken for granted
/// @tparam Constants  StandardJournal, or your own
///
/// @snippet actuator_examples.cpp hottest journal
/// How to: @ref explain_observer.
template <class Memory, class WhileOff, class Constants = StandardJournal>
class HottestJournal {
  static_assert(
      detail::IsWhileOff<WhileOff>::value,
      "thermopower: the second parameter of HottestJournal says what happens to the actuators while the "
      "controller has no power: OffTogether, or DrivenOn<settled_C>");
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

  /// Finds the newest whole record, and begins the first one of this run. Call once, when power came.
  /// @param hottest_C  not below the hottest then, nor as long as nothing was heated for longer than the
  ///                   interval since; not below where the largest power settles, if the actuators are driven on; unchanged without a record
  /// @return false when there is no record
  bool load(int16_t& hottest_C) noexcept {
    if (!find()) return false;
    hottest_C = static_cast<int16_t>(code_ + Constants::change_K() - 60);
    if (hottest_C < WhileOff::settled_C()) hottest_C = WhileOff::settled_C();
    write_now(hottest_C);
    return true;
  }

  /// Goes on after a reset that was no loss of power. Call it once, instead of `load()`. @param hottest_C  what
  /// RetainedHottest recalled, rounded up; -60 .. 195: the first record of this run
  void resume(int16_t hottest_C) noexcept {
    find();
    write_now(hottest_C);
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
    if (at_ >= Constants::start() + static_cast<uint16_t>(size()) * Constants::slots())
      at_ = Constants::start();
    left_ = size();
    since_ = 0;
  }

  /// Writes as much as the memory takes now. Call it often.
  void work() noexcept {
    if (left_ == 0 || !memory_.is_ready()) return;
    const uint8_t byte = byte_of(sequence_, code_, static_cast<uint8_t>(size() - left_));
    memory_.write(at_, byte);
    ++at_;
    --left_;
  }
  /// Is nothing left to be written?
  bool is_idle() const noexcept { return left_ == 0; }

private:
  // The newest whole record, and where the next one goes.
  bool find() noexcept {
    bool is_found = false;
    uint16_t at = Constants::start();
    for (uint8_t slot = 0; slot < Constants::slots(); ++slot) {
      const uint8_t sequence = memory_.read(at), code = memory_.read(at + 1u);
      bool is_whole = true;
      for (uint8_t byte = 2; byte < size(); ++byte)
        is_whole = is_whole && memory_.read(at + byte) == byte_of(sequence, code, byte);
      at = static_cast<uint16_t>(at + size());
      if (!is_whole) continue;
      // Newer by less than half a turn of the counter: right across the wrap.
      if (is_found && static_cast<uint8_t>(sequence - sequence_) >= 0x80u) continue;
      is_found = true;
      sequence_ = sequence;
      code_ = code;
      at_ = at;
    }
    return is_found;
  }

  static constexpr uint8_t size() { return 5; }
  static uint8_t byte_of(uint8_t sequence, uint8_t code, uint8_t byte) noexcept {
    if (byte == 0) return sequence;
    if (byte == 1) return code;
    if (byte == 2) return static_cast<uint8_t>(~static_cast<uint8_t>(sequence + code));
    const uint8_t kept[2] = {sequence, code};
    const uint16_t sum = detail::crc16(kept, 2, 0x5448u);
    return static_cast<uint8_t>(byte == 3 ? sum : sum >> 8);
  }

  Memory& memory_;
  uint16_t at_ = Constants::start();  // where the next byte goes
  // Ticks since the newest record; stops at 65535. From the start the first step is due.
  uint16_t since_ = 0xFFFFu;
  uint8_t sequence_ = 0, code_ = 0, left_ = 0;
};

}  // namespace thermopower
