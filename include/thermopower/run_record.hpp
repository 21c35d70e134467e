// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "config_record.hpp"

/// @file run_record.hpp
/// A run of a firmware as lines of text: what it was told and what it answered, step by step. Another machine can step the same
/// firmware with the same inputs and compare the answers, bit for bit.
///
/// A firmware that can be recorded keeps its decisions apart from its pins:
///
///     struct Firmware {
///       struct Told { uint16_t supply_counts; ... each_field };     // everything that a step reads, time included
///       struct Answered { uint8_t power; float motor_C; ... each_field };
///       Answered step(const Told& told);
///     };
///
/// `Told` and `Answered` name their fields as configurations do: config_record.hpp.
///
/// | line | hex bytes, then CRC-16/CCITT-FALSE of the letter and the bytes, high byte first |
/// |---|---|
/// | `P` | the firmware has started: format 1, then the kinds of the fields of `Told` and of `Answered`, two bytes each |
/// | `R` | a step: its number modulo 256, the fields of `Told`, the fields of `Answered`, lowest byte first |
///
/// Any other line is ignored, so a program may print beside it.

namespace thermopower {

/// Where a replayed answer first differs from the recorded one.
/// @ingroup control
struct RunDifference {
  uint32_t step;  ///< Number of the step, from 1 at the first that was compared; 0: no answer differs.
  uint16_t
      field;  ///< Number of the field in `Answered`, from 1, as `each_field` names them; each element of an array counts.
  bool is_float;      ///< The field is a float: `recorded` and `replayed` are its bits, IEEE 754 binary32.
  uint32_t recorded;  ///< What the recording holds.
  uint32_t replayed;  ///< What this machine answers.
};

namespace detail {

/// The first letter of a line, "P": the firmware begins.
constexpr char run_begins() { return 0x50; }
/// The first letter of a line, "R": a step.
constexpr char run_steps() { return 0x52; }

/// Writes a line of a recorded run, a byte at a time.
template <class Wire>
class RunLine {
public:
  RunLine(Wire& wire, char letter) noexcept : wire_(wire) {
    const uint8_t code = static_cast<uint8_t>(letter);
    sum_ = crc16(&code, 1);
    put(code);
  }
  void number(const float& value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    bytes(bits, 4);
  }
  void number(const uint8_t& value) { bytes(value, 1); }
  void number(const uint16_t& value) { bytes(value, 2); }
  void number(const uint32_t& value) { bytes(value, 4); }
  void end() {
    const uint16_t sum = sum_;
    hex(static_cast<uint8_t>(sum >> 8));
    hex(static_cast<uint8_t>(sum));
    put('\n');
  }

private:
  void bytes(uint32_t value, uint8_t count) {
    for (; count != 0; --count, value >>= 8) {
      const uint8_t byte = static_cast<uint8_t>(value);
      sum_ = crc16(&byte, 1, sum_);
      hex(byte);
    }
  }
  void hex(uint8_t byte) {
    put(digit(static_cast<uint8_t>(byte >> 4)));
    put(digit(static_cast<uint8_t>(byte & 15)));
  }
  static uint8_t digit(uint8_t nibble) noexcept {
    return static_cast<uint8_t>(nibble < 10 ? '0' + nibble : 'a' - 10 + nibble);
  }
  void put(uint8_t character) { wire_.write(&character, 1); }

  Wire& wire_;
  uint16_t sum_;
};

/// Compares the fields of an answer with those that were recorded.
class RunComparison {
public:
  explicit RunComparison(const uint8_t* recorded) noexcept : recorded_(recorded) {}
  void number(const float& value) noexcept {
    float said;
    recorded_.number(said);
    uint32_t bits, other;
    memcpy(&bits, &value, sizeof bits);
    memcpy(&other, &said, sizeof other);
    if (!differs(other, bits, true)) return;
    // Of one sign the bits of numbers order as the numbers do.
    const bool is_one_sign = ((bits ^ other) >> 31) == 0;
    const uint32_t apart = bits > other ? bits - other : other - bits;
    const uint32_t units = is_one_sign ? apart : 0xffffffffUL;
    if (units > most_units) most_units = units;
  }
  void number(const uint8_t& value) noexcept { whole(value); }
  void number(const uint16_t& value) noexcept { whole(value); }
  void number(const uint32_t& value) noexcept { whole(value); }

  uint32_t most_units = 0;  ///< Of a float, in units in the last place.
  bool is_decision_other = false;
  RunDifference first = RunDifference();  ///< Without its step; field 0: none differs.

private:
  template <class Number>
  void whole(const Number& value) noexcept {
    Number said;
    recorded_.number(said);
    if (differs(said, value, false)) is_decision_other = true;
  }
  bool differs(uint32_t recorded, uint32_t replayed, bool is_float) noexcept {
    ++field_;
    if (recorded == replayed) return false;
    if (first.field == 0) {
      const RunDifference found = {0, field_, is_float, recorded, replayed};
      first = found;
    }
    return true;
  }
  FieldReader recorded_;
  uint16_t field_ = 0;
};

}  // namespace detail

/// Records a run: prints a line for each step.
/// @tparam Wire  any object with `write(const uint8_t*, size_t)`, such as Arduino's Serial
///
/// @snippet control_examples.cpp recorded run
/// How to: @ref record_a_run.
/// @ingroup control
template <class Wire>
class RunWriter {
public:
  /// @param wire  where the lines go; it must outlive this object
  explicit RunWriter(Wire& wire) noexcept : wire_(wire) {}

  /// The firmware has just started. Only the types of both count.
  template <class Told, class Answered>
  void begin(const Told& told, const Answered& answered) {
    detail::RunLine<Wire> line(wire_, detail::run_begins());
    line.number(static_cast<uint8_t>(1));
    line.number(detail::layout_of(told).kinds());
    line.number(detail::layout_of(answered).kinds());
    line.end();
    step_ = 0;
  }
  /// One step. @param told  what it was told  @param answered  what it answered
  template <class Told, class Answered>
  void step(const Told& told, const Answered& answered) {
    detail::RunLine<Wire> line(wire_, detail::run_steps());
    line.number(step_++);
    detail::FieldArchive<detail::RunLine<Wire>> archive(line);
    Told::each_field(told, archive);
    Answered::each_field(answered, archive);
    line.end();
  }

private:
  Wire& wire_;
  uint8_t step_ = 0;
};

/// What came of a replay.
///
/// @snippet control_examples.cpp recorded run
/// How to: @ref record_a_run.
/// @ingroup control
struct RunReplayed {
  uint32_t steps;            ///< Steps that were compared.
  uint32_t different;        ///< Steps of these whose answer differs in a bit.
  uint32_t decisions_other;  ///< Steps of these in which a whole number differs.
  uint32_t most_units;       ///< Of the floats that differ: the most, in units in the last place.
  uint32_t damaged;          ///< Lines with a wrong check sum or length.
  uint32_t lost;             ///< Times that the numbers of two steps do not follow each other.
  bool is_other_layout;      ///< The recording is of another firmware: its fields are of other kinds.
  RunDifference first;       ///< The first field of an answer that differs.

  /// Steps were compared, none differs, and no line is missing.
  bool is_identical() const noexcept {
    return steps != 0 && different == 0 && damaged == 0 && lost == 0 && !is_other_layout;
  }
};

/// Replays a recorded run: hands a firmware the recorded inputs and compares its answers with the recorded ones.
/// @tparam Firmware  has `Told`, `Answered` and `step(told)`, and begins as the recorded one did when it is made without arguments
///
/// From a line that is damaged or missing on nothing is compared until the firmware started again: a step that was not replayed
/// leaves another state.
///
/// @snippet control_examples.cpp recorded run
/// How to: @ref record_a_run.
/// @ingroup control
template <class Firmware>
class RunReplay {
public:
  typedef typename Firmware::Told Told;          ///< What a step reads.
  typedef typename Firmware::Answered Answered;  ///< What a step answers.

  /// Takes the next character of the recording.
  void feed(char character) noexcept {
    if (character == '\n') {
      if (letter_ != 0) take_line();
      letter_ = 0;
      is_line_begun_ = false;
      return;
    }
    if (!is_line_begun_) {
      is_line_begun_ = true;
      letter_ = character == detail::run_begins() || character == detail::run_steps() ? character
                                                                                      : static_cast<char>(0);
      digits_ = 0;
      is_hex_ = true;
      return;
    }
    if (letter_ != 0 && character != '\r') take_digit(character);
  }

  /// What came of it so far.
  const RunReplayed& result() const noexcept { return result_; }
  /// The firmware as it stands.
  const Firmware& firmware() const noexcept { return firmware_; }

private:
  // What is written of a struct is never longer than the struct.
  enum : uint16_t { most_bytes = 1 + sizeof(Told) + sizeof(Answered) + 2 + 5 };

  void take_digit(char character) noexcept {
    uint8_t nibble = 16;
    if (character >= '0' && character <= '9') nibble = static_cast<uint8_t>(character - '0');
    else if (character >= 'a' && character <= 'f') nibble = static_cast<uint8_t>(character - 'a' + 10);
    if (nibble == 16 || digits_ == 2 * most_bytes) {
      is_hex_ = false;
      return;
    }
    uint8_t& byte = bytes_[digits_ / 2];
    byte = static_cast<uint8_t>(digits_ % 2 == 0 ? nibble << 4 : byte | nibble);
    ++digits_;
  }

  void take_line() noexcept {
    const uint16_t told = layout(Told()).size(), answered = layout(Answered()).size();
    const uint16_t size = static_cast<uint16_t>(letter_ == detail::run_begins() ? 5 : 1 + told + answered);
    const uint8_t code = static_cast<uint8_t>(letter_);
    const bool is_whole = is_hex_ && digits_ == 2 * (size + 2) &&
                          detail::crc16(bytes_, size, detail::crc16(&code, 1)) ==
                              static_cast<uint16_t>(bytes_[size] << 8 | bytes_[size + 1]);
    if (!is_whole) {
      ++result_.damaged;
      is_following_ = false;
    } else if (letter_ == detail::run_begins()) {
      begin();
    } else if (is_following_) {
      compare(told);
    }
  }

  void begin() noexcept {
    const bool is_same = bytes_[0] == 1 && detail::word_at(bytes_ + 1) == layout(Told()).kinds() &&
                         detail::word_at(bytes_ + 3) == layout(Answered()).kinds();
    if (!is_same) result_.is_other_layout = true;
    is_following_ = is_same;
    firmware_ = Firmware();
    step_ = 0;
  }

  void compare(uint16_t told_size) noexcept {
    if (bytes_[0] != step_++) {
      ++result_.lost;
      is_following_ = false;
      return;
    }
    Told told = Told();
    detail::FieldReader reader(bytes_ + 1);
    detail::FieldArchive<detail::FieldReader> read(reader);
    Told::each_field(told, read);
    const Answered answered = firmware_.step(told);
    detail::RunComparison comparison(bytes_ + 1 + told_size);
    detail::FieldArchive<detail::RunComparison> compared(comparison);
    Answered::each_field(answered, compared);
    ++result_.steps;
    if (comparison.is_decision_other) ++result_.decisions_other;
    if (comparison.most_units > result_.most_units) result_.most_units = comparison.most_units;
    if (comparison.first.field == 0) return;
    if (result_.different++ != 0) return;
    result_.first = comparison.first;
    result_.first.step = result_.steps;
  }

  template <class Fields>
  static detail::FieldLayout layout(const Fields& fields) noexcept {
    return detail::layout_of(fields);
  }

  Firmware firmware_;
  RunReplayed result_ = RunReplayed();
  uint16_t digits_ = 0;
  char letter_ = 0;
  uint8_t step_ = 0;
  bool is_line_begun_ = false, is_hex_ = true, is_following_ = false;
  uint8_t bytes_[most_bytes];
};

}  // namespace thermopower
