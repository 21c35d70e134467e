// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../../detail/numeric.hpp"
#include "../../detail/probe.hpp"
#include "policy_call.hpp"

/// @file control/detail/standing_time.hpp
/// Notices a clock that stands still: `dt_s` that is 0 in step after step, or in most of them.

namespace thermopower {
namespace detail {

/// Counts steps that are told no time. Nothing here has a clock of its own, so each of them is taken to last as long as the last step
/// that was told one, and as long as is tolerated where none ever was: the second such step in a row is then a fault. Time that is told
/// makes up for as much that was not: a clock that stands still in most of the steps is a fault, and one that does so in less than half
/// of them, as a slow clock in a fast loop may, is none. A fault lasts until half of it is made up for.
class StandingTime {
public:
  /// @param dt_s  time of this step, >= 0  @param hold_s  how long time may stand still, above 0
  /// @return true when it has stood still for longer
  [[gnu::noinline]] bool is_standing(float dt_s, float hold_s) noexcept {
    if (dt_s > 0.0f) {
      step_s_ = dt_s;
      stood_s_ -= dt_s;
      // Twice while it is a fault, so that a clock which stands still in half of the steps is not one for ever.
      if (is_fault_) stood_s_ -= dt_s;
      if (!(stood_s_ > 0.0f)) {
        stood_s_ = 0.0f;
        is_fault_ = false;
      }
    } else if (!(stood_s_ < hold_s)) {
      is_fault_ = true;
    } else {
      stood_s_ += step_s_ > 0.0f ? step_s_ : hold_s;
    }
    return is_fault_;
  }
  /// Length of the last step that was told one, s; 0 before.
  float step_s() const noexcept { return step_s_; }

private:
  float step_s_ = 0.0f, stood_s_ = 0.0f;
  bool is_fault_ = false;
};

/// Whether a limiter notices by itself that time stands still.
template <class Limiter, class = int>
struct NoticesStandingTime {
  static constexpr bool value = false;
};
template <class Limiter>
struct NoticesStandingTime<Limiter, typename Exists<decltype(Limiter::notices_standing_time())>::Type> {
  static constexpr bool value = true;
};

/// What an axis does where its limiter does not: a tenth of a second, or as long as the limiter vouches for.
template <class Limiter, bool = NoticesStandingTime<Limiter>::value>
class AxisClock {
public:
  bool is_standing(const Limiter& limiter, float dt_s) noexcept {
    const float hold_s = hold_of(limiter, 0);
    return time_.is_standing(dt_s, hold_s < 0.1f ? hold_s : 0.1f);
  }
  float step_s() const noexcept { return time_.step_s(); }  // of the last step that was told its time

private:
  StandingTime time_;
};
template <class Limiter>
class AxisClock<Limiter, true> {
public:
  static bool is_standing(const Limiter&, float) noexcept { return false; }
  // Such a limiter carries its own bounds through times that it is not told.
  static float step_s() noexcept { return 0.0f; }
};

}  // namespace detail
}  // namespace thermopower
