// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../detail/check.hpp"
#include "surroundings.hpp"

/// @file newton_cooling.hpp
/// Newton's law of cooling, as a rate (the thesis) and as a conductance. Menu: cooling.hpp.

namespace thermopower {

/// Newton's law as a rate, eq 3.8: dT/dt = -k (T - T_air), whatever the heat capacity.
///
/// @snippet actuator_examples.cpp thesis heating
/// How to: @ref custom_motor, @ref laws. Menu: @ref policies.
/// @ingroup actuator
template <class Number = float>
struct RateCooling {
  typedef typename detail::ModelNumber<Number>::Type Scalar;  ///< What it computes in.

  Number cooling_per_s;  ///< k, above 0. The thesis prints s^-1 but means per minute: use `per_minute`.

  /// k as the thesis uses it (0.11 and 0.05 per minute).
  static constexpr RateCooling per_minute(Number cooling_per_min) noexcept {
    typedef typename detail::Numeric<Number>::Real Real;
    return RateCooling{cooling_per_min * (Real(1) / Real(60))};
  }

  static constexpr bool is_linear() { return true; }     ///< Proportional to T - T_air.
  static constexpr bool is_in_watts() { return false; }  ///< A rate by itself: goes with every heating law.
  /// Cooling rate, K/s.
  Number rate_K_per_s(const Number& motor_C, const Surroundings<Number>& around,
                      const Number&) const noexcept {
    return cooling_per_s * (motor_C - around.air_C);
  }
  /// d rate / dT, 1/s.
  Number slope_per_s(const Number&, const Surroundings<Number>&, const Number&) const noexcept {
    return cooling_per_s;
  }
  /// Hands each field to an archive, in the order of a record: config_record.hpp.
  template <class Self, class Archive>
  static void each_field(Self& self, Archive& archive) {
    archive(self.cooling_per_s);
  }
  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept {
    return detail::require_positive(cooling_per_s, ConfigError::cooling_per_s);
  }
};

/// Newton's law as a conductance: loss = G (T - T_air).
///
/// @snippet actuator_examples.cpp cooling
/// How to: @ref custom_motor, @ref laws. Menu: @ref policies.
/// @ingroup actuator
template <class Number = float>
struct NewtonCooling {
  typedef typename detail::ModelNumber<Number>::Type Scalar;  ///< What it computes in.

  Number conductance_W_per_K;  ///< G, above 0.

  static constexpr bool is_linear() { return true; }    ///< Proportional to T - T_air.
  static constexpr bool is_in_watts() { return true; }  ///< Needs a heat capacity to become a rate.
  /// Loss, W.
  Number loss_W(const Number& motor_C, const Surroundings<Number>& around) const noexcept {
    return conductance_W_per_K * (motor_C - around.air_C);
  }
  /// Cooling rate, K/s.
  Number rate_K_per_s(const Number& motor_C, const Surroundings<Number>& around,
                      const Number& rise_K_per_J) const noexcept {
    return rise_K_per_J * loss_W(motor_C, around);
  }
  /// d rate / dT, 1/s.
  Number slope_per_s(const Number&, const Surroundings<Number>&, const Number& rise_K_per_J) const noexcept {
    return rise_K_per_J * conductance_W_per_K;
  }
  /// Hands each field to an archive, in the order of a record: config_record.hpp.
  template <class Self, class Archive>
  static void each_field(Self& self, Archive& archive) {
    archive(self.conductance_W_per_K);
  }
  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept {
    return detail::require_positive(conductance_W_per_K, ConfigError::conductance_W_per_K);
  }
};

}  // namespace thermopower
