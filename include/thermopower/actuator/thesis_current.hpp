// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../detail/check.hpp"

/// @file thesis_current.hpp
/// The current law fitted in the thesis, eq 4.1 to 4.5.

namespace thermopower {

/// Current law of the thesis, eq 4.1, with eq 4.2 and 4.4 for m and eq 4.3 and 4.5 for b; T in degC.
/// \f[
/// I = m(V) \, T + b(V), \qquad m(V) = m_2 V^2 + m_1 V + m_0, \qquad b(V) = b_1 V^{\,n}
/// \f]
/// Zero at or below `minimum_V_rms`, and never negative (as
/// programmed).
///
/// The text prints m2 with a plus sign; the program and the regression of Tables 4.1 and 4.2 have a minus.
/// The motor constants in `motors/` carry the minus. Take it for the two thesis motors; it is an
/// interpolation of measurements, not physics: outside 5.8 .. 12.9 V and 25 .. 75 degC it extrapolates, and
/// below about 4 V the 5208's current comes out as zero.
/// @tparam Number  see OhmicCurrent
///
/// @snippet actuator_examples.cpp thesis current
/// How to: @ref custom_motor, @ref laws. Menu: @ref policies.
/// @ingroup actuator
template <class Number = float>
struct ThesisCurrent {
  typedef typename detail::ModelNumber<Number>::Type Scalar;  ///< What it computes in.

  Number slope_V2_A_per_K;  ///< m2, A/(K V^2)
  Number slope_V1_A_per_K;  ///< m1, A/(K V)
  Number slope_V0_A_per_K;  ///< m0, A/K
  Number base_A;            ///< Current at 1 V and 0 degC, above 0.
  Number exponent;          ///< 1 .. 6
  Number minimum_V_rms;     ///< At or below this voltage the current is taken as 0 (the program: 1 V).

  /// The law with its constants as the thesis prints them, in milliampere. The conversion to SI happens here
  /// and nowhere else.
  static constexpr ThesisCurrent from_milliampere(Number slope_V2, Number slope_V1, Number slope_V0,
                                                  Number base, Number exponent,
                                                  Number minimum_V_rms) noexcept {
    typedef typename detail::Numeric<Number>::Real Real;
    return ThesisCurrent{
        slope_V2 * Real(0.001), slope_V1 * Real(0.001), slope_V0 * Real(0.001), base * Real(0.001), exponent,
        minimum_V_rms};
  }

  /// m(V): how much the current changes with temperature. @return A/K
  constexpr Number slope_A_per_K(const Number& v_rms_V) const noexcept {
    return (slope_V2_A_per_K * v_rms_V + slope_V1_A_per_K) * v_rms_V + slope_V0_A_per_K;
  }

  /// b(V): the current extrapolated to 0 degC. @return ampere
  Number intercept_A(const Number& v_rms_V) const noexcept {
    return base_A * detail::Numeric<Number>::power(v_rms_V, exponent);
  }

  /// Current drawn at a voltage. @return ampere, >= 0
  Number current_A(const Number& v_rms_V, const Number& motor_C) const noexcept {
    typedef detail::Numeric<Number> Math;
    typedef typename Math::Real Real;
    // Not a plain 0: a NaN voltage must stay visible, or a broken measurement would read as "no current, cold
    // motor".
    const Number zero = v_rms_V * Real(0);
    // Kept off 0 V before the power: the derivative of V^exponent there would be 0 * infinity.
    const Number driven_V = detail::at_least(v_rms_V, Math::constant(Real(1e-3)));
    const Number linear = slope_A_per_K(driven_V) * motor_C + intercept_A(driven_V);
    return Math::choose_if_greater(v_rms_V, minimum_V_rms, detail::at_least(linear, zero), zero);
  }

  /// Hands each field to an archive, in the order of a record: config_record.hpp.
  template <class Self, class Archive>
  static void each_field(Self& self, Archive& archive) {
    archive(self.slope_V2_A_per_K, self.slope_V1_A_per_K, self.slope_V0_A_per_K, self.base_A, self.exponent,
            self.minimum_V_rms);
  }
  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept {
    return first_error(
        detail::require_finite(slope_V2_A_per_K + slope_V1_A_per_K + slope_V0_A_per_K,
                               ConfigError::slope_A_per_K),
        first_error(detail::require_positive(base_A, ConfigError::base_A),
                    first_error(detail::require_within(exponent, Number(1), Number(6), ConfigError::exponent),
                                detail::require_not_negative(minimum_V_rms, ConfigError::minimum_V_rms))));
  }
};

}  // namespace thermopower
