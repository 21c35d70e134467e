// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <stddef.h>

#include "../detail/check.hpp"
#include "record_ring.hpp"

/// @file stored_state.hpp
/// An actuator's temperatures through a loss of power: a record with a check sum, and a journal that spreads
/// the wear.
///
/// A record is 22 bytes, low byte first whatever the machine:
///
/// | byte | what |
/// |---|---|
/// | 0 | 0x54, a record is here |
/// | 1 | version of this format, 2 |
/// | 2, 3 | sequence number, one up with every record, wraps |
/// | 4, 5 | winding, signed, hundredths of a degC |
/// | 6, 7 | body, signed, hundredths of a degC |
/// | 8, 9 | upper bound of the winding, signed, hundredths of a degC |
/// | 10, 11 | upper bound of the body, signed, hundredths of a degC |
/// | 12, 13 | heat in the winding, hundredths of a watt |
/// | 14, 15 | uncertainty (1 sigma) of both temperatures, hundredths of a kelvin |
/// | 16 .. 19 | the caller's clock, seconds; 0xffffffff: it has none |
/// | 20, 21 | CRC-16/CCITT-FALSE of bytes 0 .. 19 |

namespace thermopower {

/// What is worth keeping.
///
/// @snippet actuator_examples.cpp journal
/// How to: @ref explain_observer.
struct StoredState {
  float winding_C;        ///< -300 .. 300; outside, it is kept as the nearest of these.
  float body_C;           ///< -300 .. 300.
  float winding_upper_C;  ///< The winding is not hotter. NaN: no bound is known, which is kept as 300.
  float body_upper_C;     ///< The body is not hotter. NaN: no bound is known, which is kept as 300.
  float heat_W;           ///< 0 .. 655. What was heating it when it was stored.
  float std_K;            ///< 0 .. 655. How sure the temperatures are.
  uint32_t clock_s;       ///< Any clock that goes on without power; `no_clock()` when there is none.
  uint16_t sequence;      ///< Set by the journal.

  static constexpr uint32_t no_clock() { return 0xffffffffUL; }  ///< There is no such clock.
  static constexpr uint8_t size() { return 22; }                 ///< Bytes of a record.

  /// Writes the record. @param bytes  at least `size()` of them
  void write(uint8_t* bytes) const noexcept {
    bytes[0] = 0x54;
    bytes[1] = 2;
    put(bytes + 2, sequence);
    put(bytes + 4, hundredths(winding_C));
    put(bytes + 6, hundredths(body_C));
    put(bytes + 8, hundredths(winding_upper_C));
    put(bytes + 10, hundredths(body_upper_C));
    put(bytes + 12, whole_hundredths(heat_W));
    put(bytes + 14, whole_hundredths(std_K));
    put(bytes + 16, static_cast<uint16_t>(clock_s & 0xffffu));
    put(bytes + 18, static_cast<uint16_t>(clock_s >> 16));
    put(bytes + 20, crc(bytes, 20));
  }

  /// Reads a record. @return false, with this object unchanged, when the bytes are not one, or damaged
  bool read(const uint8_t* bytes) noexcept {
    if (bytes[0] != 0x54 || bytes[1] != 2 || take(bytes + 20) != crc(bytes, 20)) return false;
    sequence = take(bytes + 2);
    winding_C = signed_from(take(bytes + 4));
    body_C = signed_from(take(bytes + 6));
    winding_upper_C = signed_from(take(bytes + 8));
    body_upper_C = signed_from(take(bytes + 10));
    heat_W = static_cast<float>(take(bytes + 12)) * 0.01f;
    std_K = static_cast<float>(take(bytes + 14)) * 0.01f;
    clock_s = static_cast<uint32_t>(take(bytes + 16)) | (static_cast<uint32_t>(take(bytes + 18)) << 16);
    return true;
  }

  /// Has a temperature or a bound moved away from another record's? @param change_K  by this or more; NaN counts
  bool differs(const StoredState& other, float change_K) const noexcept {
    return !(is_near(winding_C, other.winding_C, change_K) && is_near(body_C, other.body_C, change_K) &&
             is_near(winding_upper_C, other.winding_upper_C, change_K) &&
             is_near(body_upper_C, other.body_upper_C, change_K));
  }

  /// CRC-16/CCITT-FALSE: polynomial 0x1021, start 0xffff; of "123456789" it is 0x29b1.
  static uint16_t crc(const uint8_t* bytes, uint8_t count) noexcept { return detail::crc16(bytes, count); }

private:
  static bool is_near(float left, float right, float change_K) noexcept {
    return detail::magnitude(left - right) < change_K;
  }
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

/// What is certain about the time after a record: how long an actuator may have gone on unrecorded.
struct RecordPromise {
  float interval_s;  ///< Whatever happened in this time after a record may have left no other. >= 0.
  float change_K;    ///< Later than that, temperatures and bounds stayed within this of the record. >= 0.
  float longest_s;   ///< Later than this there would be another record: the power was off. >= `interval_s`.
};

/// Keeps records in a ring of slots, so that no byte is written more often than it bears.
/// @tparam Memory  as RecordRing takes it: an EEPROM, a file, an FRAM
///
/// Liveness: a record is written at power-up (the first `step()`, with what the actuator was started with), when
/// something has changed but at most once in `interval_s`, at least once in `longest_s`, and before a planned
/// stop (`write_now()`). What that makes certain is `promise()`. A record that was cut off by the loss of
/// power fails its check sum, and the one before it counts.
///
/// @snippet actuator_examples.cpp journal
/// How to: @ref explain_observer.
template <class Memory>
class StateJournal {
  static_assert(
      detail::IsMemory<Memory>::value,
      "thermopower: the parameter of StateJournal must be a memory: a type with uint8_t read(size_t) and "
      "void write(size_t, uint8_t)");

public:
  /// What one tunes.
  struct Config {
    uint16_t start;      ///< First byte in the memory.
    uint8_t slots;       ///< Records in the ring, 2 .. 255.
    float interval_s;    ///< Not more often than this. Above 0.
    float change_K;      ///< Nor, before `longest_s`, unless a temperature has changed by this. >= 0.
    uint32_t endurance;  ///< Writes that a byte bears: 100000 for an AVR's EEPROM. At least 1.
    float longest_s;     ///< A record at least this often, changed or not. At least `interval_s`.
    float step_s;        ///< `step()` is called at least this often. Above 0.

    /// 16 slots from byte 0, once a minute when changed by 2 K, every ten minutes in any case, stepped at
    /// least once a second, an AVR's EEPROM: three years of changing every minute.
    static Config standard() noexcept {
      const Config config = {0, 16, 60.0f, 2.0f, 100000UL, 600.0f, 1.0f};
      return config;
    }
    /// Time until the memory is worn out if a record is due every time. Every power-up costs one record more.
    /// @return years of operation
    float years() const noexcept {
      return static_cast<float>(endurance) * static_cast<float>(slots) * interval_s / 31557600.0f;
    }
    /// Hands each field to an archive, in the order of a record: config_record.hpp.
    template <class Self, class Archive>
    static void each_field(Self& self, Archive& archive) {
      archive(self.start, self.slots, self.interval_s, self.change_K, self.endurance, self.longest_s,
              self.step_s);
    }
    /// First constant out of its range, or ConfigError::none. A ring that would not last a year is refused as
    /// `interval_s`.
    ConfigError validate() const noexcept {
      if (slots < 2) return ConfigError::slots;
      if (is_error(detail::require_positive(interval_s, ConfigError::interval_s)) || years() < 1.0f)
        return ConfigError::interval_s;
      if (!detail::is_finite(longest_s) || longest_s < interval_s) return ConfigError::longest_s;
      return first_error(detail::require_not_negative(change_K, ConfigError::change_K),
                         detail::require_positive(step_s, ConfigError::longest_s));
    }
  };

  /// Touches nothing yet.
  /// @param memory  where the records lie; must outlive this object
  /// @param config  the ring; ask `validate()` once
  StateJournal(Memory& memory, const Config& config) noexcept
      : ring_(memory, config.start, config.slots), config_(config) {
    const float none_C = detail::not_a_number();
    const StoredState none = {none_C, none_C, none_C, none_C, 0.0f, 0.0f, StoredState::no_clock(), 0};
    last_ = none;
  }

  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept { return config_.validate(); }

  /// What the newest record leaves open.
  RecordPromise promise() const noexcept {
    const RecordPromise promise = {config_.interval_s + config_.step_s, config_.change_K,
                                   config_.longest_s + config_.step_s};
    return promise;
  }

  /// Finds the newest whole record. Call once, at power-up, before `step()`. @return false when there is none
  bool load(StoredState& newest) noexcept {
    if (!ring_.load(newest)) return false;
    last_ = newest;
    return true;
  }

  /// Writes a record when one is due. @param dt_s  time since the last call  @return true when one was
  /// begun
  bool step(const StoredState& now, float dt_s) noexcept {
    if (is_error(config_.validate())) return false;
    if (dt_s > 0.0f) since_s_ += dt_s;
    ring_.work();
    // The first record of this run says what it started with, or a power lost early would leave the last run's.
    if (is_first_) return write_now(now);
    if (since_s_ < config_.interval_s) return false;
    if (since_s_ < config_.longest_s && !now.differs(last_, config_.change_K)) return false;
    return write_now(now);
  }

  /// Writes a record whatever the interval says: at power-up and before a planned stop. @return false when
  /// the record before it is still being written to a slow memory, or the configuration is refused
  bool write_now(const StoredState& now) noexcept {
    if (is_error(config_.validate()) || !ring_.begin(now)) return false;
    last_ = now;
    since_s_ = 0.0f;
    is_first_ = false;
    ring_.work();
    return true;
  }

  /// Seconds since the newest record, rounded up: for `Retained::keep()`. Stops at 65535.
  uint16_t since_s() const noexcept {
    return since_s_ < 65534.0f ? static_cast<uint16_t>(since_s_ + 1.0f) : static_cast<uint16_t>(65535u);
  }
  /// Goes on after a reset that was no loss of power, without a record: the promise still counts from the
  /// newest one. @param since_s  `Retained::since_s`
  void resume(uint16_t since_s) noexcept {
    since_s_ = static_cast<float>(since_s);
    is_first_ = false;
  }

  /// Goes on writing to a memory that takes a byte at a time. @return true when nothing is left to be written
  bool work() noexcept { return ring_.work(); }

private:
  RecordRing<Memory, StoredState> ring_;
  Config config_;
  StoredState last_;
  float since_s_ = 0.0f;
  bool is_first_ = true;  // no record was written in this run
};

}  // namespace thermopower
