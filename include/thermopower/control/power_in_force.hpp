// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <stdint.h>

/// @file power_in_force.hpp
/// Which POWER may have acted, from what was sent and what the board says is in force. A board may refuse a
/// command, lose it, restart with a POWER of its own, or be out of reach: what heats the motors is what is in
/// force, not what was sent.

namespace thermopower {

namespace detail {

/// POWER in force as a telemetry message has it; 0 where it says nothing.
template <class Telemetry>
auto reported_power(const Telemetry& telemetry, uint8_t axis, int) noexcept
    -> decltype(static_cast<uint8_t>(telemetry.motor_power(axis))) {
  return static_cast<uint8_t>(telemetry.motor_power(axis));
}
template <class Telemetry>
uint8_t reported_power(const Telemetry&, uint8_t, long) noexcept {
  return 0;
}

}  // namespace detail

/// Keeps, for every axis, the largest POWER that may be in force.
///
/// | what is known | the motor is heated with |
/// |---|---|
/// | telemetry reports the POWER that was sent | that |
/// | telemetry reports another | the largest of what was sent, what was before, and what is reported |
/// | telemetry reports none (0), and CONFIRM came after the command | what was sent |
/// | the same, and CONFIRM did not come, or ERROR did | the largest of all that was sent since the last CONFIRM |
/// | no telemetry for a while | the largest of what was sent and what was before |
/// | no telemetry for longer than is tolerated | 255: the board may have restarted with anything |
///
/// A board that neither reports nor ever confirms cannot be verified; what is sent to it is believed.
///
/// @snippet control_examples.cpp power in force
/// How to: @ref faults_and_reasons.
/// @ingroup control
template <uint8_t axis_count>
class PowerInForce {
  static_assert(axis_count > 0, "thermopower: a gimbal has at least one axis");

public:
  /// Nothing was sent yet.
  constexpr PowerInForce() noexcept : largest_{}, before_{} {}

  /// The largest POWER that may act until the next call, as far as is known already: what `heard()` or
  /// `unheard()` will say is never less. @param sent  what was sent last
  uint8_t expected(uint8_t axis, uint8_t sent) const noexcept { return greater(largest_[axis], sent); }

  /// A telemetry message has come. Call it for every axis in turn, then `decided()`.
  /// @param reported  POWER in force by the message, 0 when it does not say  @param sent  what was sent last
  /// @return the largest POWER that may have acted since the call before
  uint8_t heard(uint8_t axis, uint8_t reported, uint8_t sent) noexcept {
    const bool is_reported = reported != 0;
    const bool is_sent_in_force = is_reported ? reported == sent : is_confirmed_ || !answers_;
    uint8_t& largest = largest_[axis];
    if (!is_sent_in_force) {
      // A message that shows the command before the last is late, not disobedient; nor is one disobedient that
      // comes before anything was sent.
      if (before_[axis] != 0 && (!is_reported || reported != before_[axis])) is_disobeyed_ = true;
      largest = greater(greater(largest, before_[axis]), greater(sent, reported));
    }
    const uint8_t acted = greater(largest, sent);
    if (is_sent_in_force) largest = 0;
    else if (is_reported) largest = reported;
    before_[axis] = sent;
    return acted;
  }

  /// A cycle without telemetry. @return the largest POWER that may have acted since the call before
  uint8_t unheard(uint8_t axis, uint8_t sent) noexcept {
    largest_[axis] = greater(largest_[axis], greater(before_[axis], sent));
    before_[axis] = sent;
    return largest_[axis];
  }

  /// Out of reach, or not heard of since the start: any POWER may be in force, until the board says another.
  void lost() noexcept {
    for (uint8_t axis = 0; axis < axis_count; ++axis) lost(axis);
  }
  /// The same of one axis.
  void lost(uint8_t axis) noexcept { largest_[axis] = 255; }

  /// The board has confirmed a command, and does so for every one. Only asked of a board that reports no
  /// POWER.
  void confirmed() noexcept { answers_ = is_confirmed_ = true; }
  /// The board has answered a command with an error.
  void refused() noexcept {
    answers_ = true;
    is_confirmed_ = false;
  }

  /// After the last axis: forgets what the next message has to say anew. @return did every axis obey?
  bool decided() noexcept {
    const bool was_obeyed = !is_disobeyed_;
    is_disobeyed_ = is_confirmed_ = false;
    return was_obeyed;
  }

private:
  static uint8_t greater(uint8_t left, uint8_t right) noexcept { return left > right ? left : right; }

  uint8_t largest_[axis_count];  // may be in force besides what was sent last
  uint8_t before_[axis_count];   // what was sent before that
  bool is_disobeyed_ = false, is_confirmed_ = false, answers_ = false;
};

}  // namespace thermopower
