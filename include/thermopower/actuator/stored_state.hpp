// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <stddef.h>

#include "../detail/check.hpp"

/// @file stored_state.hpp
/// An actuator's temperatures through a loss of power: a record with a check sum, and a journal that spreads
/// the wear.
///
/// A record is 18 bytes, low byte first whatever the machine:
///
/// | byte | what |
/// |---|---|
/// | 0 | 0x54, a record is here |
/// | 1 | version of this format, 1 |
/// | 2, 3 | sequence number, one up with every record, wraps |
/// | 4, 5 | winding, signed, hundredths of a degC |
/// | 6, 7 | body, signed, hundredths of a degC |
/// | 8, 9 | heat in the winding, hundredths of a watt |
/// | 10, 11 | uncertainty (1 sigma) of both temperatures, hundredths of a kelvin |
/// | 12 .. 15 | the caller's clock, seconds; 0xffffffff: it has none |
/// | 16, 17 | CRC-16/CCITT-FALSE of bytes 0 .. 15 |

namespace thermopower {

/// What is worth keeping.
struct StoredState {
  float winding_C;    ///< -300 .. 300; outside, it is kept as the nearest of these.
  float body_C;       ///< -300 .. 300.
  float heat_W;       ///< 0 .. 655. What was heating it when it was stored.
  float std_K;        ///< 0 .. 655. How sure the temperatures are.
  uint32_t clock_s;   ///< Any clock that goes on without power; `no_clock()` when there is none.
  uint16_t sequence;  ///< Set by the journal.

  static constexpr uint32_t no_clock() { return 0xffffffffUL; }  ///< There is no such clock.
  static constexpr uint8_t size() { return 18; }                 ///< Bytes of a record.

  /// Writes the record. @param bytes  at least `size()` of them
  void write(uint8_t* bytes) const noexcept {
    bytes[0] = 0x54;
    bytes[1] = 1;
    put(bytes + 2, sequence);
    put(bytes + 4, hundredths(winding_C));
    put(bytes + 6, hundredths(body_C));
    put(bytes + 8, whole_hundredths(heat_W));
    put(bytes + 10, whole_hundredths(std_K));
    put(bytes + 12, static_cast<uint16_t>(clock_s & 0xffffu));
    put(bytes + 14, static_cast<uint16_t>(clock_s >> 16));
    put(bytes + 16, crc(bytes, 16));
  }

  /// Reads a record. @return false, with this object unchanged, when the bytes are not one, or damaged
  bool read(const uint8_t* bytes) noexcept {
    if (bytes[0] != 0x54 || bytes[1] != 1 || take(bytes + 16) != crc(bytes, 16)) return false;
    sequence = take(bytes + 2);
    winding_C = signed_from(take(bytes + 4));
    body_C = signed_from(take(bytes + 6));
    heat_W = static_cast<float>(take(bytes + 8)) * 0.01f;
    std_K = static_cast<float>(take(bytes + 10)) * 0.01f;
    clock_s = static_cast<uint32_t>(take(bytes + 12)) | (static_cast<uint32_t>(take(bytes + 14)) << 16);
    return true;
  }

  /// CRC-16/CCITT-FALSE: polynomial 0x1021, start 0xffff; of "123456789" it is 0x29b1.
  static uint16_t crc(const uint8_t* bytes, uint8_t count) noexcept {
    uint16_t sum = 0xffffu;
    for (uint8_t i = 0; i < count; ++i) {
      sum = static_cast<uint16_t>(sum ^ static_cast<uint16_t>(static_cast<uint16_t>(bytes[i]) << 8));
      for (uint8_t step = 0; step < 8; ++step)
        sum = static_cast<uint16_t>((sum & 0x8000u) != 0 ? static_cast<uint16_t>(sum << 1) ^ 0x1021u
                                                         : static_cast<uint16_t>(sum << 1));
    }
    return sum;
  }

 private:
  static void put(uint8_t* at, uint16_t value) noexcept {
    at[0] = static_cast<uint8_t>(value & 0xffu);
    at[1] = static_cast<uint8_t>(value >> 8);
  }
  static uint16_t take(const uint8_t* at) noexcept {
    return static_cast<uint16_t>(at[0] | static_cast<uint16_t>(at[1]) << 8);
  }
  // Rounded up: a temperature must not come back colder than it was. NaN becomes the hottest.
  static uint16_t hundredths(float value) noexcept {
    const float scaled = value * 100.0f;
    if (!(scaled < 30000.0f)) return 30000u;
    const int16_t whole = static_cast<int16_t>(scaled > -30000.0f ? scaled : -30000.0f);
    return static_cast<uint16_t>(static_cast<float>(whole) < scaled ? whole + 1 : whole);
  }
  static uint16_t whole_hundredths(float value) noexcept {
    const float scaled = value * 100.0f + 0.99f;
    if (!(scaled < 65500.0f)) return 65500u;
    return static_cast<uint16_t>(scaled > 0.0f ? scaled : 0.0f);
  }
  static float signed_from(uint16_t bits) noexcept {
    const int32_t value = bits >= 0x8000u ? static_cast<int32_t>(bits) - 65536 : static_cast<int32_t>(bits);
    return static_cast<float>(value) * 0.01f;
  }
};

/// Keeps records in a ring of slots, so that no byte is written more often than it bears.
/// @tparam Memory  has `uint8_t read(size_t)` and `void write(size_t, uint8_t)`: an EEPROM, a file, an FRAM
///
/// A record that was cut off by the loss of power fails its check sum, and the one before it counts.
template <class Memory>
class StateJournal {
 public:
  /// What one tunes.
  struct Config {
    uint16_t start;      ///< First byte in the memory.
    uint8_t slots;       ///< Records in the ring, 2 .. 255.
    float interval_s;    ///< Not more often than this. Above 0.
    float change_K;      ///< Nor unless a temperature has changed by this. >= 0.
    uint32_t endurance;  ///< Writes that a byte bears: 100000 for an AVR's EEPROM. At least 1.

    /// 16 slots from byte 0, once a minute, 2 K, an AVR's EEPROM: three years of changing every minute.
    static Config standard() noexcept {
      const Config config = {0, 16, 60.0f, 2.0f, 100000UL};
      return config;
    }
    /// Time until the memory is worn out if a record is due every time. @return years of operation
    float years() const noexcept {
      return static_cast<float>(endurance) * static_cast<float>(slots) * interval_s / 31557600.0f;
    }
    /// First constant out of its range, or ConfigError::none. A ring that would not last a year is refused as
    /// `interval_s`.
    ConfigError validate() const noexcept {
      if (slots < 2) return ConfigError::slots;
      if (is_error(detail::require_positive(interval_s, ConfigError::interval_s)) || years() < 1.0f)
        return ConfigError::interval_s;
      return detail::require_not_negative(change_K, ConfigError::change_K);
    }
  };

  /// Touches nothing yet.
  /// @param memory  where the records lie; must outlive this object
  /// @param config  the ring; ask `validate()` once
  StateJournal(Memory& memory, const Config& config) noexcept : memory_(memory), config_(config) {
    const StoredState none = {0.0f, 0.0f, 0.0f, 0.0f, StoredState::no_clock(), 0};
    last_ = none;
  }

  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept { return config_.validate(); }

  /// Finds the newest whole record. Call once, at power-up, before `step()`. @return false when there is none
  bool load(StoredState& newest) noexcept {
    bool is_found = false;
    for (uint8_t slot = 0; slot < config_.slots; ++slot) {
      uint8_t bytes[StoredState::size()];
      for (uint8_t i = 0; i < StoredState::size(); ++i) bytes[i] = memory_.read(address(slot) + i);
      StoredState record;
      if (!record.read(bytes)) continue;
      // Newer by less than half a turn of the counter: right across the wrap.
      if (is_found && static_cast<uint16_t>(record.sequence - newest.sequence) >= 0x8000u) continue;
      newest = record;
      slot_ = slot;
      is_found = true;
    }
    if (is_found) {
      last_ = newest;
      next_sequence_ = static_cast<uint16_t>(newest.sequence + 1);
      slot_ = static_cast<uint8_t>(slot_ + 1 < config_.slots ? slot_ + 1 : 0);
      has_last_ = true;
    }
    return is_found;
  }

  /// Writes a record when one is due. @param dt_s  time since the last call  @return true when one was
  /// written
  bool step(StoredState now, float dt_s) noexcept {
    if (is_error(config_.validate())) return false;
    if (dt_s > 0.0f) since_s_ += dt_s;
    if (since_s_ < config_.interval_s) return false;
    const bool has_changed =
        !has_last_ || !(detail::magnitude(now.winding_C - last_.winding_C) < config_.change_K &&
                        detail::magnitude(now.body_C - last_.body_C) < config_.change_K);
    if (!has_changed) return false;
    now.sequence = next_sequence_++;
    uint8_t bytes[StoredState::size()];
    now.write(bytes);
    for (uint8_t i = 0; i < StoredState::size(); ++i) {
      // A byte that is right already is not worn.
      if (memory_.read(address(slot_) + i) != bytes[i]) memory_.write(address(slot_) + i, bytes[i]);
    }
    slot_ = static_cast<uint8_t>(slot_ + 1 < config_.slots ? slot_ + 1 : 0);
    last_ = now;
    has_last_ = true;
    since_s_ = 0.0f;
    return true;
  }

 private:
  size_t address(uint8_t slot) const noexcept {
    return static_cast<size_t>(config_.start) + static_cast<size_t>(slot) * StoredState::size();
  }

  Memory& memory_;
  Config config_;
  StoredState last_;
  float since_s_ = 0.0f;
  uint16_t next_sequence_ = 0;
  uint8_t slot_ = 0;
  bool has_last_ = false;
};

}  // namespace thermopower
