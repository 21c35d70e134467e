// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <stdint.h>

#include "../detail/probe.hpp"
#include "detail/axis_power.hpp"

/// @file power_in_force.hpp
/// Which POWER may have acted, from what was sent and what the board says is in force. A board may refuse a
/// command, lose it, obey late, restart with a POWER of its own, or be out of reach. What heats the motors is
/// what is in force, not what was sent.

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

/// A board's answer that says whether it belongs to a command that sets POWER.
template <class Candidate, class = int>
struct IsConfirm {
  static constexpr bool value = false;
};
template <class Candidate>
struct IsConfirm<Candidate, typename Exists<decltype(probe<const Candidate>().is_of_power() ? 1 : 0)>::Type> {
  static constexpr bool value = true;
};

}  // namespace detail

/// Keeps, for every axis, the largest POWER that may be in force.
///
/// | what is known | the motor is heated with |
/// |---|---|
/// | telemetry reports the POWER that was sent | that |
/// | telemetry reports another, and a delay and a scale that were learned explain it | the largest that was sent within the delay, by the scale |
/// | telemetry reports another, and nothing explains it | the largest of what was sent, what was before, and what is reported |
/// | telemetry reports none (0), but the POWER was read back since the message before | as if it had been reported |
/// | telemetry reports none (0), and the CONFIRM of the command came after it | what was sent |
/// | the same, and CONFIRM did not come, or ERROR did | the largest of all that was sent since the last CONFIRM |
/// | no telemetry for a while | the largest of what was sent and what was before |
/// | no telemetry for longer than is tolerated | 255: the board may have restarted with anything |
///
/// A board that neither reports nor ever confirms cannot be verified; what is sent to it is believed. A CONFIRM says that the board
/// took the command, not that it obeys. So once POWER was read back, CONFIRM no longer counts, and every message needs a POWER read back.
///
/// **What is learned.** A board may show a command up to `longest_delay()` messages late. A report that moves within
/// what was sent in that time teaches the delay; one that stands still while another POWER was sent is not obeyed. A
/// report may differ from the command by 2 counts, or by a factor within `least_scale()` .. `most_scale()`. A factor is learned
/// only from a board that was seen to follow the power down to its least. What is beyond these bounds is not obeyed.
///
/// @snippet control_examples.cpp power in force
/// How to: @ref faults_and_reasons.
/// @ingroup control
template <uint8_t axis_count>
class PowerInForce {
  static_assert(axis_count > 0, "thermopower: a gimbal has at least one axis");

public:
  /// Nothing was sent yet.
  constexpr PowerInForce() noexcept {}

  /// A command that shows in a later message than this is not obeyed.
  static constexpr uint8_t longest_delay() { return detail::AxisPower::length(); }
  /// A board that reports less than this of the command does not obey.
  static constexpr float least_scale() { return detail::AxisPower::least_scale() / 128.0f; }
  /// A board that reports more than this times the command does not obey.
  static constexpr float most_scale() { return detail::AxisPower::most_scale() / 128.0f; }

  /// Messages after which the board was seen to show a command; 0 .. `longest_delay()`.
  uint8_t delay() const noexcept { return board_.delay; }
  /// What the board reports of a command, at least; 1 until something else was learned.
  float scale_low(uint8_t axis) const noexcept { return static_cast<float>(axes_[axis].low()) / 128.0f; }
  /// What the board reports of a command, at most.
  float scale_high(uint8_t axis) const noexcept { return static_cast<float>(axes_[axis].high()) / 128.0f; }

  /// The largest POWER that may act until the next call, as far as is known already: what `heard()` or
  /// `unheard()` will say is never less. @param sent  what was sent last
  uint8_t expected(uint8_t axis, uint8_t sent) const noexcept {
    return axes_[axis].expected(sent, board_.delay);
  }

  /// A telemetry message has come. Call it for every axis in turn, then `decided()`.
  /// @param reported  POWER in force by the message, 0 when it does not say  @param sent  what was sent last
  /// @return the largest POWER that may have acted since the call before
  uint8_t heard(uint8_t axis, uint8_t reported, uint8_t sent) noexcept {
    if (reported == 0) reported = read_[axis];
    read_[axis] = 0;
    return axes_[axis].heard(reported, sent, axis == learning_, board_);
  }

  /// A cycle without telemetry. @return the largest POWER that may have acted since the call before
  uint8_t unheard(uint8_t axis, uint8_t sent) noexcept { return axes_[axis].unheard(sent, board_.delay); }

  /// Out of reach, or not heard of since the start: any POWER may be in force, until the board says another.
  void lost() noexcept {
    for (uint8_t axis = 0; axis < axis_count; ++axis) lost(axis);
  }
  /// The same of one axis. @param largest  no larger POWER is in force
  void lost(uint8_t axis, uint8_t largest = 255) noexcept {
    axes_[axis].lost(largest);
    board_.delay = 0;
  }

  /// The board has confirmed a command. Only asked of a board that reports no POWER, which must then confirm every one.
  /// @param confirm  says by `is_of_power()` whether the command was one that sets POWER, as sbgc::Confirm does; any
  /// other is not counted
  template <class Confirm>
  void confirmed(const Confirm& confirm) noexcept {
    static_assert(
        detail::IsConfirm<Confirm>::value,
        "thermopower: confirmed() needs the board's answer, with is_of_power(), such as sbgc::Confirm");
    if (!confirm.is_of_power()) return;
    if (others_ != 0) {
      --others_;
      return;
    }
    board_.answers = true;
    board_.is_confirmed = !is_read_;
  }
  /// The board was asked for its POWER and has answered: `sbgc::hear_power()` tells it. Of a board whose telemetry reports none.
  /// @param power  its value, 0 .. 255
  void read_back(uint8_t axis, uint8_t power) noexcept {
    if (axis >= axis_count) return;
    read_[axis] = power != 0 ? power : uint8_t(1);
    board_.answers = is_read_ = true;
  }
  /// Your program has sent a command of the kind that sets POWER, for something else: its CONFIRM looks the same, so one
  /// the less is counted.
  void other_sent() noexcept {
    if (others_ != 255) ++others_;
  }
  /// The board has answered a command with an error.
  void refused() noexcept {
    board_.answers = true;
    board_.is_confirmed = false;
  }

  /// After the last axis: forgets what the next message has to say anew. @return did every axis obey?
  bool decided() noexcept {
    const bool was_obeyed = !board_.is_disobeyed;
    board_.is_disobeyed = board_.is_confirmed = false;
    learning_ = static_cast<uint8_t>(learning_ + 1 < axis_count ? learning_ + 1 : 0);
    return was_obeyed;
  }

private:
  detail::AxisPower axes_[axis_count] = {};
  detail::BoardPower board_ = {};
  uint8_t learning_ = 0;           // the axis that learns from the next message
  uint8_t others_ = 0;             // CONFIRMs that may belong to other commands
  uint8_t read_[axis_count] = {};  // POWER that was read back since the last message; 0: none
  bool is_read_ = false;           // was ever
};

}  // namespace thermopower
