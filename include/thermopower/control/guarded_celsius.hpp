// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../detail/numeric.hpp"
#include "limit_reason.hpp"

/// @file guarded_celsius.hpp
/// A temperature that a limiter may believe. A bare number is not one.

namespace thermopower {

class SensorGuard;

/// A temperature that somebody vouches for, degC, or the reason why nobody does.
///
/// | made by | the temperature is |
/// |---|---|
/// | `SensorGuard::step()` | measured, and checked |
/// | `hottest_of(model)`, `body_of(model)`, `upper_of(observer, sigmas)` | estimated by a model |
/// | `unchecked(temperature_C)` | whatever the caller says: nobody has looked at it |
///
/// No limiter takes a plain float for a temperature. A torn cable that reads -88.6 degC would be a cold motor to it, and would get full
/// power. `unchecked()` is the way around this, and easy to find in a review.
///
/// @snippet control_examples.cpp sensor guard
/// How to: @ref choose_a_limiter.
/// @ingroup control
class GuardedCelsius {
public:
  /// Not known: NaN. @param reason  why; a fault
  explicit GuardedCelsius(LimitReason reason = LimitReason::temperature_not_finite) noexcept
      : value_C_(detail::not_a_number()), reason_(reason) {}

  /// A bare number is refused, in a sentence.
  template <class Number>
  GuardedCelsius(Number) noexcept {
    static_assert(
        sizeof(Number) == 0,
        "thermopower: a limiter does not take a bare number for a temperature: check a reading with "
        "SensorGuard, name the model with GuardedCelsius::hottest_of(model), or write "
        "GuardedCelsius::unchecked(temperature_C)");
  }

  /// The hottest node of a thermal model.
  template <class Thermal>
  static GuardedCelsius hottest_of(const Thermal& model) noexcept {
    return GuardedCelsius(model.hottest_C(), LimitReason::temperature_not_finite);
  }
  /// The node of a thermal model that a thermometer on the housing would read.
  template <class Thermal>
  static GuardedCelsius body_of(const Thermal& model) noexcept {
    return GuardedCelsius(body_C(model, 0), LimitReason::temperature_not_finite);
  }
  /// An observer's estimate of the winding plus some standard deviations. @param sigmas  3 covers 99.9 % of normal errors
  template <class Observer>
  static GuardedCelsius winding_upper_of(const Observer& observer, float sigmas) noexcept {
    return GuardedCelsius(observer.winding_upper_C(sigmas), LimitReason::temperature_not_finite);
  }
  /// The same of the body.
  template <class Observer>
  static GuardedCelsius body_upper_of(const Observer& observer, float sigmas) noexcept {
    return GuardedCelsius(observer.body_upper_C(sigmas), LimitReason::temperature_not_finite);
  }
  /// A temperature that nobody has checked. @param temperature_C  degC; NaN: not known
  static GuardedCelsius unchecked(float temperature_C) noexcept {
    return GuardedCelsius(temperature_C, LimitReason::temperature_not_finite);
  }

  /// The number, degC; NaN when there is none.
  operator float() const noexcept { return value_C_; }
  /// Why there is no temperature. It means something only where there is none.
  LimitReason reason() const noexcept { return reason_; }
  /// `none` when there is a temperature, otherwise why there is none.
  LimitReason fault() const noexcept {
    if (detail::is_finite(value_C_) && value_C_ >= -273.15f) return LimitReason::none;
    return is_fault(reason_) ? reason_ : LimitReason::temperature_not_finite;
  }
  /// Another place whose distance in kelvin is known; without a temperature still without one, for the same reason.
  GuardedCelsius warmer_by(float difference_K) const noexcept {
    return GuardedCelsius(value_C_ + difference_K, reason_);
  }

private:
  friend class SensorGuard;
  GuardedCelsius(float value_C, LimitReason reason) noexcept : value_C_(value_C), reason_(reason) {}

  template <class Thermal>
  static auto body_C(const Thermal& model, int) noexcept -> decltype(model.state().body_C + 0.0f) {
    return model.state().body_C;
  }
  template <class Thermal>
  static float body_C(const Thermal& model, long) noexcept {
    return model.hottest_C();
  }

  float value_C_;
  LimitReason reason_;
};

}  // namespace thermopower
