// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "../detail/crc16.hpp"
#include "../detail/probe.hpp"
#include "detail/memory.hpp"

/// @file record_ring.hpp
/// Records through a loss of power: a ring of slots in a memory that keeps them, and one record in a memory
/// that only a reset leaves as it was.

namespace thermopower {

namespace detail {

/// A record: how many bytes, and whether they are whole.
template <class Candidate, class = int>
struct IsRecord {
  static constexpr bool value = false;
};
template <class Candidate>
struct IsRecord<Candidate, typename Exists<decltype(Candidate::size()),
                                           decltype(probe<Candidate>().read(
                                               static_cast<const uint8_t*>(nullptr)))>::Type> {
  static constexpr bool value = true;
};

}  // namespace detail

/// A ring of slots, so that no byte is written more often than it bears.
/// @tparam Memory  has `uint8_t read(size_t)` and `void write(size_t, uint8_t)`. A slow one also has `bool
///                 is_ready()`: nothing is read or written before it says so, and nobody waits for it
/// @tparam Record  has `static constexpr uint8_t size()`, `void write(uint8_t*) const`, `bool read(const
///                 uint8_t*)` that refuses what is damaged, and `uint16_t sequence`
///
/// @snippet actuator_examples.cpp record ring
/// How to: @ref explain_observer.
template <class Memory, class Record>
class RecordRing {
  static_assert(
      detail::IsMemory<Memory>::value,
      "thermopower: the first parameter of RecordRing must be a memory: a type with uint8_t read(size_t) and "
      "void write(size_t, uint8_t)");
  static_assert(
      detail::IsRecord<Record>::value,
      "thermopower: the second parameter of RecordRing must be a record: a type with static size(), "
      "read(bytes) and write(bytes), such as StoredState");

public:
  /// Touches nothing yet.
  /// @param memory  where the records lie; must outlive this object
  /// @param start   first byte in it
  /// @param slots   records in the ring, at least 2
  constexpr RecordRing(Memory& memory, uint16_t start, uint8_t slots) noexcept
      : memory_(memory), start_(start), slots_(slots), bytes_{} {}

  /// Finds the newest whole record, and goes on after it. @return false, with `newest` unchanged, when there
  /// is none
  bool load(Record& newest) noexcept {
    bool is_found = false;
    for (uint8_t slot = 0; slot < slots_; ++slot) {
      slot_ = slot;
      for (uint8_t i = 0; i < Record::size(); ++i) bytes_[i] = memory_.read(address(i));
      Record record;
      if (!record.read(bytes_)) continue;
      // Newer by less than half a turn of the counter: right across the wrap.
      if (is_found && static_cast<uint16_t>(record.sequence - newest.sequence) >= 0x8000u) continue;
      newest = record;
      next_slot_ = after(slot);
      is_found = true;
    }
    slot_ = next_slot_;
    if (is_found) next_sequence_ = static_cast<uint16_t>(newest.sequence + 1);
    return is_found;
  }

  /// Begins to write a record over the oldest; `work()` does it. @return false when one is still being written
  bool begin(Record record) noexcept {
    if (!is_idle()) return false;
    record.sequence = next_sequence_++;
    record.write(bytes_);
    slot_ = next_slot_;
    next_slot_ = after(slot_);
    written_ = 0;
    return true;
  }

  /// Writes as much as the memory takes now. @return true when nothing is left
  bool work() noexcept {
    while (!is_idle() && detail::is_memory_ready(memory_, 0)) {
      // A byte that is right already is not worn.
      if (memory_.read(address(written_)) != bytes_[written_])
        memory_.write(address(written_), bytes_[written_]);
      ++written_;
    }
    return is_idle();
  }

  /// Is nothing left to be written?
  bool is_idle() const noexcept { return written_ == Record::size(); }

private:
  size_t address(uint8_t byte) const noexcept {
    return static_cast<size_t>(start_) + static_cast<size_t>(slot_) * Record::size() + byte;
  }
  uint8_t after(uint8_t slot) const noexcept {
    return static_cast<uint8_t>(slot + 1 < slots_ ? slot + 1 : 0);
  }

  Memory& memory_;
  uint16_t start_, next_sequence_ = 0;
  uint8_t slots_, slot_ = 0, next_slot_ = 0;
  uint8_t written_ = Record::size();
  uint8_t bytes_[Record::size()];
};

/// One record in a memory that a reset leaves as it was, such as the `.noinit` section of a chip's RAM. After
/// a loss of power it holds noise, and the check sum says so.
///
///     Retained<StoredState> retained __attribute__((section(".noinit")));
///     ...
///     if (retained.recall(state)) ...  // a reset: as warm as it was; `retained.boots` resets since power came
///     retained.keep(state, journal.since_s());                // in every cycle: it wears nothing
///
/// It has no constructor on purpose: one would wipe what it is there to keep. Where a reset clears all memory
/// it is of no use, and of no harm.
/// @tparam Record  as RecordRing takes it
///
/// @snippet actuator_examples.cpp retained
/// How to: @ref explain_observer.
template <class Record>
struct Retained {
  static_assert(
      detail::IsRecord<Record>::value,
      "thermopower: the parameter of Retained must be a record: a type with static size(), read(bytes) and "
      "write(bytes), such as StoredState");
  uint8_t bytes[Record::size()];  ///< The record, with its own check sum.
  uint16_t boots;                 ///< Resets since power came; right only after `recall()`.
  uint16_t boots_check;           ///< The complement of `boots`, so that noise is no count.
  uint16_t since_s;               ///< Age of the newest record in the ring, as told to `keep()`.
  uint16_t since_check;           ///< Its complement.

  /// Reads the record after a reset and counts the reset. @return false after a loss of power, or when the
  /// reset cut off `keep()`: the count starts at 0 then
  bool recall(Record& record) noexcept {
    const bool is_whole = is_pair(boots, boots_check) && is_pair(since_s, since_check) && record.read(bytes);
    boots = is_whole && boots != 0xffffu ? static_cast<uint16_t>(boots + 1) : static_cast<uint16_t>(0);
    boots_check = static_cast<uint16_t>(~boots);
    return is_whole;
  }
  /// Keeps a record. @param ring_age_s  seconds since the ring was written, for `StateJournal::resume()`
  void keep(const Record& record, uint16_t ring_age_s) noexcept {
    record.write(bytes);
    since_s = ring_age_s;
    since_check = static_cast<uint16_t>(~ring_age_s);
  }
  /// Makes the memory forget, as a loss of power would.
  void forget() noexcept { bytes[0] = static_cast<uint8_t>(~bytes[0]); }

private:
  static bool is_pair(uint16_t value, uint16_t check) noexcept {
    return static_cast<uint16_t>(value ^ check) == 0xffffu;
  }
};

}  // namespace thermopower
