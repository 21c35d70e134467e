// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../../../detail/probe.hpp"
#include "../../../fixed_point/units.hpp"
#include "../../limit_reason.hpp"
#include "../guarded_temperature.hpp"

/// @file control/fixed_point/detail/composition.hpp
/// Asks whether a type can play a part in a controller in whole numbers.

namespace thermopower {
namespace fixed_point {
namespace detail {

/// A motor's model: a `Core`, a `cooling_factor` and `heating(power, motor)`.
template <class Candidate, class = int>
struct IsThermalModel {
  static constexpr bool value = false;
};
template <class Candidate>
struct IsThermalModel<Candidate, typename thermopower::detail::Exists<
                                     typename Candidate::Core, decltype(Candidate::cooling_factor),
                                     decltype(Candidate::heating(uint8_t(1), Temperature(0)))>::Type> {
  static constexpr bool value = true;
};

/// A power law: `step(error_units)`.
template <class Candidate, class = int>
struct IsPowerLaw {
  static constexpr bool value = false;
};
template <class Candidate>
struct IsPowerLaw<Candidate, typename thermopower::detail::Exists<
                                 decltype(thermopower::detail::probe<Candidate>().step(uint16_t(1)))>::Type> {
  static constexpr bool value = true;
};

/// A limiter: `step(demand, motor, rate, ticks)`, `cut(reason, demand)` and `ceiling()`.
template <class Candidate, class = int>
struct IsLimiter {
  static constexpr bool value = false;
};
template <class Candidate>
struct IsLimiter<Candidate,
                 typename thermopower::detail::Exists<
                     decltype(thermopower::detail::probe<Candidate>().step(
                         uint8_t(1), GuardedTemperature::unchecked(0), Rate(0), Ticks(0))),
                     decltype(thermopower::detail::probe<Candidate>().cut(LimitReason::none, uint8_t(1))),
                     decltype(thermopower::detail::probe<const Candidate>().ceiling())>::Type> {
  static constexpr bool value = true;
};

/// A gain: `gain(power)`.
template <class Candidate, class = int>
struct IsGain {
  static constexpr bool value = false;
};
template <class Candidate>
struct IsGain<Candidate, typename thermopower::detail::Exists<decltype(Candidate::gain(uint8_t(1)))>::Type> {
  static constexpr bool value = true;
};

/// A controller of one axis: a gain to begin with, and `prepare()`.
template <class Candidate, class = int>
struct IsAxis {
  static constexpr bool value = false;
};
template <class Candidate>
struct IsAxis<Candidate, typename thermopower::detail::Exists<
                             decltype(Candidate::first_gain()),
                             decltype(thermopower::detail::probe<Candidate>().prepare())>::Type> {
  static constexpr bool value = true;
};

/// The supply that a thermal model was made for, V; beyond any where it does not say.
template <class Thermal>
constexpr auto supply_of(int) noexcept -> decltype(Thermal::supply_V()) {
  return Thermal::supply_V();
}
template <class Thermal>
constexpr double supply_of(long) noexcept {
  return 600.0;
}

/// Constants of a gimbal: `minimum_supply_V()`, `supply_margin()`, `timeout_s()` and `Air`.
template <class Candidate, class = int>
struct IsGimbalConstants {
  static constexpr bool value = false;
};
template <class Candidate>
struct IsGimbalConstants<Candidate,
                         typename thermopower::detail::Exists<
                             typename Candidate::Air, decltype(Candidate::minimum_supply_V()),
                             decltype(Candidate::supply_margin()), decltype(Candidate::timeout_s())>::Type> {
  static constexpr bool value = true;
};

/// Constants of a limiter: `maximum_C()` and `safety_time_s()`.
template <class Candidate, class = int>
struct IsLimit {
  static constexpr bool value = false;
};
template <class Candidate>
struct IsLimit<Candidate, typename thermopower::detail::Exists<decltype(Candidate::maximum_C()),
                                                               decltype(Candidate::safety_time_s())>::Type> {
  static constexpr bool value = true;
};

/// Constants of a ceiling that moves in counts per second: `rate_per_s()`.
template <class Candidate, class = int>
struct IsCeilingRate {
  static constexpr bool value = false;
};
template <class Candidate>
struct IsCeilingRate<Candidate,
                     typename thermopower::detail::Exists<decltype(Candidate::rate_per_s())>::Type> {
  static constexpr bool value = true;
};

/// A rule for a ceiling: `lower(ticks)`, `raise(ticks)`, `cut()` and `ceiling()`.
template <class Candidate, class = int>
struct IsCeilingRule {
  static constexpr bool value = false;
};
template <class Candidate>
struct IsCeilingRule<Candidate,
                     typename thermopower::detail::Exists<
                         decltype(thermopower::detail::probe<Candidate>().lower(Ticks(0))),
                         decltype(thermopower::detail::probe<Candidate>().raise(Ticks(0))),
                         decltype(thermopower::detail::probe<Candidate>().cut()),
                         decltype(thermopower::detail::probe<const Candidate>().ceiling())>::Type> {
  static constexpr bool value = true;
};

/// Constants of power levels: `full_power_error_deg()` and `power_step()`.
template <class Candidate, class = int>
struct IsLevels {
  static constexpr bool value = false;
};
template <class Candidate>
struct IsLevels<Candidate, typename thermopower::detail::Exists<decltype(Candidate::full_power_error_deg()),
                                                                decltype(Candidate::power_step())>::Type> {
  static constexpr bool value = true;
};

/// The same with `hysteresis_deg()`.
template <class Candidate, class = int>
struct IsHysteresis {
  static constexpr bool value = false;
};
template <class Candidate>
struct IsHysteresis<Candidate,
                    typename thermopower::detail::Exists<decltype(Candidate::hysteresis_deg())>::Type> {
  static constexpr bool value = true;
};

}  // namespace detail
}  // namespace fixed_point
}  // namespace thermopower
