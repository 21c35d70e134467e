// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../detail/check.hpp"
#include "surroundings.hpp"

/// @file natural_convection.hpp
/// Still air around a warm body. Menu: cooling.hpp.

namespace thermopower {

/// Natural convection: a loss that grows faster than the temperature difference.
/// \f[
/// \mathrm{loss} = G \, (T - T_\mathrm{air}) \left( \frac{|T - T_\mathrm{air}|}{T_\mathrm{ref}} \right)^{n}
/// \f]
/// At a difference of `reference_K` it equals Newton's G. n is 0.25 for laminar, 1/3 for turbulent flow (VDI Heat Atlas, F2; Incropera, ch. 9).
///
/// @snippet actuator_examples.cpp cooling
/// How to: @ref custom_motor, @ref laws. Menu: @ref policies.
/// @ingroup actuator
template <class Number = float>
struct NaturalConvection {
  typedef typename detail::ModelNumber<Number>::Type Scalar;  ///< What it computes in.

  Number conductance_W_per_K;  ///< G at a difference of `reference_K`, above 0.
  Number exponent;             ///< n, 0 .. 1.
  Number reference_K;          ///< Temperature difference at which G holds, above 0.

  static constexpr bool is_linear() { return false; }   ///< Grows faster than T - T_air.
  static constexpr bool is_in_watts() { return true; }  ///< Needs a heat capacity to become a rate.
  /// Loss, W.
  Number loss_W(const Number& motor_C, const Surroundings<Number>& around) const noexcept {
    return conductance_at(motor_C, around) * (motor_C - around.air_C);
  }
  /// Cooling rate, K/s.
  Number rate_K_per_s(const Number& motor_C, const Surroundings<Number>& around,
                      const Number& rise_K_per_J) const noexcept {
    return rise_K_per_J * loss_W(motor_C, around);
  }
  /// d rate / dT, 1/s.
  Number slope_per_s(const Number& motor_C, const Surroundings<Number>& around,
                     const Number& rise_K_per_J) const noexcept {
    typedef typename detail::Numeric<Number>::Real Real;
    return rise_K_per_J * conductance_at(motor_C, around) * (Real(1) + exponent);
  }
  /// Hands each field to an archive, in the order of a record: config_record.hpp.
  template <class Self, class Archive>
  static void each_field(Self& self, Archive& archive) {
    archive(self.conductance_W_per_K, self.exponent, self.reference_K);
  }
  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept {
    return first_error(
        detail::require_positive(conductance_W_per_K, ConfigError::conductance_W_per_K),
        first_error(detail::require_within(exponent, Number(0), Number(1), ConfigError::exponent),
                    detail::require_positive(reference_K, ConfigError::reference_K)));
  }

private:
  Number conductance_at(const Number& motor_C, const Surroundings<Number>& around) const noexcept {
    typedef detail::Numeric<Number> Math;
    typedef typename Math::Real Real;
    const Number difference = motor_C - around.air_C;
    // Kept off zero, where |x|^n has an infinite derivative that no recording can show.
    const Number distance =
        detail::at_least(detail::at_least(difference, Number(-difference)), Math::constant(Real(1e-6)));
    return conductance_W_per_K * Math::power(distance / reference_K, exponent);
  }
};

}  // namespace thermopower
