// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../../fixed_point/units.hpp"
#include "../limit_reason.hpp"
#include "detail/composition.hpp"

/// @file control/fixed_point/safety_limiter.hpp
/// Keeps an actuator below its limit temperature in whole numbers, eq 4.23: T + t_safety dT/dt <= T_max.
///
/// | rule | the ceiling moves | the same in `thermopower` |
/// |---|---|---|
/// | `PerSecond` | at a rate in counts per second: the same at any loop rate | `PerSecond` |
/// | `PerCycle` | by 1 per call | `PerCycle`, the original program |
///
/// A rule of your own has `lower(ticks)`, `raise(ticks)`, `cut()` and `ceiling()`.

namespace thermopower {
namespace fixed_point {
namespace detail {

/// t_safety as a 16-bit factor: what `scaled` makes of a rate with it is t_safety dT/dt in units of 2^shift
/// temperature units.
template <class Constants>
struct SafetyHorizon {
  static constexpr double ticks = Constants::safety_time_s() * ticks_per_s();
  static constexpr uint8_t shift = ticks < 65535.0 ? 0 : (ticks < 131070.0 ? 1 : 4);
  static constexpr uint16_t factor = static_cast<uint16_t>(nearest(ticks / static_cast<double>(1 << shift)));
};

}  // namespace detail

/// The thesis's constants: 60 degC, 30 s, one count per 30 ms. A set of your own has the same functions.
///
/// @snippet fixed_point_examples.cpp fixed-point parts
/// How to: @ref choose_a_limiter. Menu: @ref policies.
/// @ingroup control
struct ThesisLimit {
  static constexpr double maximum_C() { return 60.0; }      ///< T_max, 0 .. 170 degC.
  static constexpr double safety_time_s() { return 30.0; }  ///< t_safety, 0.1 to 240 s.
  /// Read by `PerSecond` only: counts per second, 0.1 .. 3900.
  static constexpr double rate_per_s() { return 1.0 / 0.03; }
};

/// The thesis's rule: one count per call, so the speed depends on the loop rate.
/// @tparam Constants  ThesisLimit, or your own
///
/// @snippet fixed_point_examples.cpp fixed-point parts
/// How to: @ref choose_a_limiter. Menu: @ref policies.
/// @ingroup control
template <class Constants = ThesisLimit>
class PerCycle {
  static_assert(
      detail::IsLimit<Constants>::value,
      "thermopower: the parameter of fixed_point::PerCycle must be the constants of its limiter, such as fixed_point::ThesisLimit: a type with constexpr maximum_C() and safety_time_s()");

public:
  /// Too warm: one count down, whatever the time.
  void lower(Ticks) noexcept {
    if (ceiling_ > least_power()) --ceiling_;
  }
  /// Cool enough: one count up, whatever the time.
  void raise(Ticks) noexcept {
    if (ceiling_ < 255) ++ceiling_;
  }
  void cut() noexcept { ceiling_ = least_power(); }      ///< Much too warm, or a fault.
  uint8_t ceiling() const noexcept { return ceiling_; }  ///< Highest power granted, 1 .. 255.

private:
  uint8_t ceiling_ = 255;
};

/// The same rule in counts per second: independent of the loop rate.
/// @tparam Constants  ThesisLimit, or your own
///
/// @snippet fixed_point_examples.cpp fixed-point constants
/// How to: @ref choose_a_limiter. Menu: @ref policies.
/// @ingroup control
template <class Constants = ThesisLimit>
class PerSecond {
  static_assert(
      detail::IsCeilingRate<Constants>::value,
      "thermopower: the parameter of fixed_point::PerSecond must be its constants, such as fixed_point::ThesisLimit: a type with constexpr rate_per_s()");

public:
  /// Too warm: down, as far as the time allows.
  void lower(Ticks ticks) noexcept {
    const uint32_t way = static_cast<uint32_t>(ticks) * per_tick;
    const uint32_t room = ceiling_ - (static_cast<uint32_t>(least_power()) << 16);
    ceiling_ -= way < room ? way : room;
  }
  /// Cool enough: up, as far as the time allows.
  void raise(Ticks ticks) noexcept {
    const uint32_t way = static_cast<uint32_t>(ticks) * per_tick;
    const uint32_t room = (uint32_t(255) << 16) - ceiling_;
    ceiling_ += way < room ? way : room;
  }
  /// Much too warm, or a fault.
  void cut() noexcept { ceiling_ = static_cast<uint32_t>(least_power()) << 16; }
  /// Highest power granted, 1 .. 255.
  uint8_t ceiling() const noexcept { return static_cast<uint8_t>(ceiling_ >> 16); }

private:
  static_assert(Constants::rate_per_s() >= 0.1 && Constants::rate_per_s() <= 3900.0,
                "thermopower: rate_per_s must be within 0.1 .. 3900 counts per second");
  static constexpr uint16_t per_tick =
      static_cast<uint16_t>(detail::nearest(Constants::rate_per_s() / detail::ticks_per_s() * 65536.0));

  uint32_t ceiling_ = uint32_t(255) << 16;  // 2^-16
};

/// Limits the power so that the actuator stays below its limit temperature.
///
/// Guarantees: the power is never above the demand; above T_max it is the least; at equal history a hotter
/// actuator never gets more. There is no number here that is not one, so nothing needs to be asked about it.
/// @tparam Constants  ThesisLimit, or your own
/// @tparam Rule       how the ceiling moves
///
/// @snippet fixed_point_examples.cpp fixed-point constants
/// How to: @ref choose_a_limiter. Menu: @ref policies.
/// @ingroup control
template <class Constants = ThesisLimit, template <class> class Rule = PerSecond>
class SafetyLimiter {
  static_assert(
      detail::IsLimit<Constants>::value,
      "thermopower: the first parameter of fixed_point::SafetyLimiter must be its constants, such as fixed_point::ThesisLimit: a type with constexpr maximum_C(), safety_time_s() and rate_per_s()");

  static_assert(
      detail::IsCeilingRule<Rule<Constants> >::value,
      "thermopower: the second parameter of fixed_point::SafetyLimiter must be a rule for the ceiling, such as fixed_point::PerSecond: a template with lower(ticks), raise(ticks), cut() and ceiling()");

  static_assert(Constants::maximum_C() >= 0.0 && Constants::maximum_C() <= 170.0,
                "thermopower: maximum_C must be within 0 .. 170 degC for a fixed-point limiter");
  static_assert(Constants::safety_time_s() >= 0.1 && Constants::safety_time_s() <= 240.0,
                "thermopower: safety_time_s must be within 0.1 .. 240 s for a fixed-point limiter");

public:
  /// @param demand  power parameter asked for
  /// @param told    temperature that somebody vouches for
  /// @param rate    dT/dt at the power of the last step
  /// @param ticks   time since the last step
  [[gnu::always_inline]] LimitedPower step(uint8_t demand, GuardedTemperature told, Rate rate,
                                           Ticks ticks) noexcept {
    const Temperature motor = told;
    constexpr Temperature maximum = detail::temperature_of(Constants::maximum_C());
    if (motor > maximum) return cut(LimitReason::over_temperature, demand);
    const int32_t soon = detail::scaled(rate, Horizon::factor);
    const bool is_safe = soon <= ((maximum - motor) >> Horizon::shift);
    if (is_safe) rule_.raise(ticks);
    else rule_.lower(ticks);
    const uint8_t ceiling = rule_.ceiling();
    LimitedPower granted = {demand, LimitReason::none};
    if (demand > ceiling) {
      granted.power = ceiling;
      granted.reason = is_safe ? LimitReason::recovering : LimitReason::safety_temperature;
    }
    return granted;
  }

  /// Least power, or the demand if that is less, for a reason found elsewhere; the ceiling starts again from
  /// there.
  LimitedPower cut(LimitReason reason, uint8_t demand = 255) noexcept {
    rule_.cut();
    const LimitedPower least = {demand < least_power() ? demand : least_power(), reason};
    return least;
  }

  uint8_t ceiling() const noexcept { return rule_.ceiling(); }  ///< Highest power granted now.

private:
  typedef detail::SafetyHorizon<Constants> Horizon;
  Rule<Constants> rule_;
};

}  // namespace fixed_point
}  // namespace thermopower
