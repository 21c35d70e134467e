// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../detail/check.hpp"
#include "surroundings.hpp"

/// @file forced_airflow.hpp
/// Moving air. Menu: cooling.hpp.

namespace thermopower {

/// Conductance that grows with the speed of the air: G (1 + g v^n). n is about 0.5 (laminar) to 0.8
/// (turbulent).
///
/// @snippet actuator_examples.cpp cooling
/// How to: @ref custom_motor, @ref laws. Menu: @ref policies.
/// @ingroup actuator
template <class Number = float>
struct ForcedAirflow {
  typedef typename detail::ModelNumber<Number>::Type Scalar;  ///< What it computes in.

  Number conductance_W_per_K;  ///< G in still air, above 0.
  Number airflow_gain;         ///< g: relative growth at 1 m/s, >= 0.
  Number exponent;             ///< n, 0.2 .. 1.

  static constexpr bool is_linear() { return true; }    ///< The airspeed is constant over a step.
  static constexpr bool is_in_watts() { return true; }  ///< Needs a heat capacity to become a rate.
  /// Loss, W.
  Number loss_W(const Number& motor_C, const Surroundings<Number>& around) const noexcept {
    return conductance_at(around) * (motor_C - around.air_C);
  }
  /// Cooling rate, K/s.
  Number rate_K_per_s(const Number& motor_C, const Surroundings<Number>& around,
                      const Number& rise_K_per_J) const noexcept {
    return rise_K_per_J * loss_W(motor_C, around);
  }
  /// d rate / dT, 1/s.
  Number slope_per_s(const Number&, const Surroundings<Number>& around,
                     const Number& rise_K_per_J) const noexcept {
    return rise_K_per_J * conductance_at(around);
  }
  /// Hands each field to an archive, in the order of a record: config_record.hpp.
  template <class Self, class Archive>
  static void each_field(Self& self, Archive& archive) {
    archive(self.conductance_W_per_K, self.airflow_gain, self.exponent);
  }
  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept {
    return first_error(
        detail::require_positive(conductance_W_per_K, ConfigError::conductance_W_per_K),
        first_error(detail::require_not_negative(airflow_gain, ConfigError::airflow_gain),
                    detail::require_within(exponent, Number(0.2), Number(1), ConfigError::exponent)));
  }

private:
  Number conductance_at(const Surroundings<Number>& around) const noexcept {
    typedef detail::Numeric<Number> Math;
    typedef typename Math::Real Real;
    // Kept off zero, where v^n has an infinite derivative; so little that still air still has G to rounding
    // at any n.
    const Number speed = detail::at_least(around.airspeed_mps, Math::constant(Real(1e-36)));
    return conductance_W_per_K * (Real(1) + airflow_gain * Math::power(speed, exponent));
  }
};

}  // namespace thermopower
