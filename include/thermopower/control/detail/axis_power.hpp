// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <stdint.h>

/// @file control/detail/axis_power.hpp
/// Which POWER may have acted on one axis: what was sent in the last messages, and what the board makes of a command.

namespace thermopower {
namespace detail {

/// What all axes of a board have in common.
struct BoardPower {
  uint8_t delay = 0;          ///< Messages after which a command was seen to show.
  bool is_disobeyed = false;  ///< By an axis, since the last message was decided on.
  bool is_confirmed = false;  ///< The command was, since then.
  bool answers = false;       ///< The board was heard to confirm or to refuse.
};

/// One axis of PowerInForce, which says what the rules are.
class AxisPower {
public:
  constexpr AxisPower() noexcept : sent_{} {}

  static constexpr uint8_t length() { return 8; }        ///< Messages that are kept, without the last one.
  static constexpr uint8_t least_scale() { return 32; }  ///< A quarter, in 1/128.
  static constexpr uint8_t most_scale() { return 255; }  ///< Twice.
  static constexpr uint8_t tolerance() { return 2; }     ///< Counts: a rounding and a count off.
  static constexpr uint8_t least_power() { return 2; }   ///< A command up to this is the least power.

  uint8_t low() const noexcept { return low_; }    ///< The board makes at least this of a command, in 1/128.
  uint8_t high() const noexcept { return high_; }  ///< And at most this.

  /// PowerInForce::lost().
  void lost(uint8_t largest) noexcept {
    largest_ = largest;
    low_ = high_ = 128;
    more_ = 0;
  }

  /// PowerInForce::expected().
  [[gnu::noinline]] uint8_t expected(uint8_t sent, uint8_t delay) const noexcept {
    for (const uint8_t* before = sent_; delay != 0; --delay) sent = greater(sent, *before++);
    return greater(largest_, in_force(sent));
  }

  /// PowerInForce::unheard().
  uint8_t unheard(uint8_t sent, uint8_t delay) noexcept {
    largest_ = greater(expected(sent, delay), sent_[0]);
    add(sent);
    return largest_;
  }

  /// PowerInForce::heard(). @param learns  whether this axis is the one that learns from this message
  [[gnu::noinline]] uint8_t heard(uint8_t reported, uint8_t sent, bool learns, BoardPower& board) noexcept {
    const uint8_t before = sent_[0];
    const bool has_moved = reported != reported_;
    reported_ = reported;
    bool is_obeyed = reported == sent, is_open = false;
    // The usual case needs no more: what was sent is in force. One axis a message learns, as that takes divisions.
    if (reported == 0) {
      is_obeyed = board.is_confirmed || !board.answers;
      if (sent <= least_power()) relearn(sent);
    } else if (!is_obeyed || learns || sent <= least_power()) {
      is_open = compare(sent, learns, has_moved, is_obeyed, board);
    }
    uint8_t acted = greater(expected(sent, board.delay), reported);
    if (is_obeyed) {
      largest_ = 0;
    } else {
      // Nothing is disobeyed before it was sent, nor by a message that crossed the command on its way.
      if (!is_open && before != 0 && (reported == 0 || reported != before)) board.is_disobeyed = true;
      acted = greater(acted, in_force(before));
      largest_ = reported == 0 ? acted : reported;
    }
    add(sent);
    return acted;
  }

private:
  static uint8_t greater(uint8_t left, uint8_t right) noexcept { return left > right ? left : right; }
  // No board reports more than 255.
  static uint8_t times(uint8_t value, uint8_t scale) noexcept {
    const uint16_t scaled =
        static_cast<uint16_t>(static_cast<uint16_t>(static_cast<uint16_t>(value) * scale) >> 7);
    return scaled < 255 ? static_cast<uint8_t>(scaled) : static_cast<uint8_t>(255);
  }
  // What the least scale that was learned makes of a command; never less than was sent.
  uint8_t in_force(uint8_t sent) const noexcept {
    const uint8_t scaled = low_ > 128 ? times(sent, low_) : sent;
    const uint16_t whole = static_cast<uint16_t>(scaled + more_ + (low_ > 128 ? 1 : 0));
    return whole < 255 ? static_cast<uint8_t>(whole) : static_cast<uint8_t>(255);
  }
  bool explains(uint8_t least, uint8_t most) const noexcept {
    return reported_ <= times(most, high_) + tolerance() && reported_ + tolerance() >= times(least, low_);
  }
  void add(uint8_t sent) noexcept {
    for (uint8_t at = length() - 1; at != 0; --at) sent_[at] = sent_[at - 1];
    sent_[0] = sent;
  }

  // A board that went down to the least power with us may have any scale within the bounds.
  bool relearn(uint8_t most) noexcept {
    for (uint8_t at = 0; at < length(); ++at)
      if (sent_[at] == 0 || sent_[at] > least_power()) return false;
    if (most > least_power() || reported_ > 2 * least_power() + tolerance()) return false;
    low_ = least_scale();
    high_ = most_scale();
    return true;
  }

  // @return does what was sent reach back to before anything was?
  bool compare(uint8_t sent, bool learns, bool has_moved, bool& is_obeyed, BoardPower& board) noexcept {
    if (relearn(sent)) {
      is_obeyed = true;
      return false;
    }
    uint8_t least = sent, most = sent;
    for (uint8_t at = 0; at < length(); ++at) {
      const uint8_t one = sent_[at];
      if (one == 0) return true;
      if (one < least) least = one;
      if (one > most) most = one;
    }
    if (explains(least, most)) {
      if (learns) learn(least, most);
      // A report that moves teaches the delay; one that stands still is explained by what was learned, or not.
      const uint8_t late =
          is_obeyed ? static_cast<uint8_t>(0) : delay(sent, has_moved ? length() : board.delay);
      if (late <= length() && late > board.delay) board.delay = late;
      is_obeyed = is_obeyed || has_moved || late <= board.delay;
    }
    // A report above what is foreseen is foreseen from now on, up to the tolerance.
    if (is_obeyed && more_ < tolerance() && reported_ > expected(sent, board.delay)) ++more_;
    return false;
  }

  // How many messages ago the command was sent that explains the report. @return more than `length()` when none of the
  // last ones does  @param longest  how many of them are asked
  uint8_t delay(uint8_t sent, uint8_t longest) const noexcept {
    for (uint8_t late = 0;; ++late) {
      if (explains(sent, sent)) return late;
      if (late >= longest) return length() + 1;
      sent = sent_[late];
    }
  }

  // Narrows the scale to what explains a report, whatever the delay.
  void learn(uint8_t least, uint8_t most) noexcept {
    const uint16_t above =
        static_cast<uint16_t>((reported_ > tolerance() ? reported_ - tolerance() : 0) * 128u);
    const uint16_t below = static_cast<uint16_t>((reported_ + tolerance()) * 128u);
    // Divided only where that changes something.
    if (above > static_cast<uint16_t>(static_cast<uint16_t>(most) * low_)) {
      const uint16_t ratio = static_cast<uint16_t>(above / most);
      low_ = static_cast<uint8_t>(ratio < high_ ? ratio : high_);
    }
    if (below < static_cast<uint16_t>(static_cast<uint16_t>(least) * high_)) {
      const uint16_t ratio = static_cast<uint16_t>(below / least + 1);
      if (ratio < high_) high_ = static_cast<uint8_t>(ratio > low_ ? ratio : low_);
    }
  }

  uint8_t largest_ = 0;             // may be in force besides what was sent last
  uint8_t reported_ = 0;            // by the last message
  uint8_t low_ = 128, high_ = 128;  // what the board makes of a command, in 1/128
  uint8_t more_ = 0;                // counts by which reports exceeded that
  uint8_t sent_[8];                 // before the last one, the newest first; 0: nothing was sent
};

}  // namespace detail
}  // namespace thermopower
