// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../../detail/numeric.hpp"
#include "../../detail/probe.hpp"
#include "policy_call.hpp"

/// @file control/detail/standing_time.hpp
/// Notices a clock that stands still: `dt_s` that is 0 in step after step.

namespace thermopower {
namespace detail {

/// Counts steps that are told no time. Nothing here has a clock of its own, so each of them is taken to last as long as the last step
/// that was told one, and as long as is tolerated where none ever was: the second such step in a row is then a fault.
class StandingTime {
public:
  /// @param dt_s  time of this step, >= 0  @param hold_s  how long time may stand still, above 0
  /// @return true when it has stood still for longer
  bool is_standing(float dt_s, float hold_s) noexcept {
    if (dt_s > 0.0f) {
      step_s_ = dt_s;
      stood_s_ = 0.0f;
      return false;
    }
    const bool is_standing = !(stood_s_ < hold_s);
    if (!is_standing) stood_s_ += step_s_ > 0.0f ? step_s_ : hold_s;
    return is_standing;
  }
  /// Length of the last step that was told one, s; 0 before.
  float step_s() const noexcept { return step_s_; }
  /// For how long no time has been told, s.
  float stood_s() const noexcept { return stood_s_; }

private:
  float step_s_ = 0.0f, stood_s_ = 0.0f;
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
  float step_s() const noexcept { return time_.step_s(); }    // of the last step that was told its time
  float stood_s() const noexcept { return time_.stood_s(); }  // since then

private:
  StandingTime time_;
};
template <class Limiter>
class AxisClock<Limiter, true> {
public:
  static bool is_standing(const Limiter&, float) noexcept { return false; }
  // Such a limiter carries its own bounds through times that it is not told.
  static float step_s() noexcept { return 0.0f; }
  static float stood_s() noexcept { return 0.0f; }
};

}  // namespace detail
}  // namespace thermopower
