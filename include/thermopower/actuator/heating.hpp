// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../detail/check.hpp"

/// @file actuator/heating.hpp
/// Heating laws: how fast a watt warms the heated node. eq 3.7: dT/dt = r P, with r in K/J.
///
/// | law | r | when to take it |
/// |---|---|---|
/// | `HeatCapacityHeating` | 1 / C | always, unless the thesis's figures are to be reproduced |
/// | `ThesisHeating` | r(V_rms, T), eq 4.16 to 4.18 | the thesis motors, as measured, as printed or as programmed |
///
/// A law of your own has `Scalar`, `is_linear()` (true when r is a constant), `is_heat_capacity()` (true when
/// 1/r is a heat capacity at any voltage), `rise_K_per_J(v_rms_V, motor_C)`, `rise_slope_per_J(v_rms_V,
/// motor_C)` (its derivative by temperature) and `validate()`.

namespace thermopower {

/// Heating of a body with a heat capacity: r = 1 / C.
///
/// @snippet actuator_examples.cpp thermal model
/// How to: @ref custom_motor, @ref laws. Menu: @ref policies.
/// @ingroup actuator
template <class Number = float>
struct HeatCapacityHeating {
  typedef typename detail::ModelNumber<Number>::Type Scalar;  ///< What it computes in.

  Number heat_capacity_J_per_K;  ///< C, above 0.

  static constexpr bool is_linear() { return true; }  ///< r depends neither on temperature nor on voltage.
  /// 1/r is C: any cooling law may divide its watts by it.
  static constexpr bool is_heat_capacity() { return true; }

  /// r, in kelvin per joule.
  Number rise_K_per_J(const Number&, const Number&) const noexcept {
    typedef typename detail::Numeric<Number>::Real Real;
    return Real(1) / heat_capacity_J_per_K;
  }

  /// dr/dT, in 1/J.
  Number rise_slope_per_J(const Number&, const Number&) const noexcept {
    typedef detail::Numeric<Number> Math;
    return Math::constant(typename Math::Real(0));
  }

  /// Hands each field to an archive, in the order of a record: config_record.hpp.
  template <class Self, class Archive>
  static void each_field(Self& self, Archive& archive) {
    archive(self.heat_capacity_J_per_K);
  }
  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept {
    return detail::require_positive(heat_capacity_J_per_K, ConfigError::heat_capacity_J_per_K);
  }
};

/// The thesis's coefficient of heating, with V = V_rms and T the motor's temperature in degC.
/// \f[
/// \frac{1}{r} = (s_1 V + s_0) \, T + (o_1 V + o_0)
/// \f]
/// 1/r is an apparent heat capacity, so the constants are kept in J/K; `per_minute`
/// takes them as the thesis prints them. No heating at or below `minimum_V_rms`, nor, with a least capacity of
/// 0, where 1/r is not positive. As programmed that is so: the yaw motor below 2 degC is never believed to
/// warm (1/r = 0.2435 T - 0.4952), which is no thermal protection at all.
///
/// Eq 4.16 and 4.17 (BGM2606-90T) use all four constants. Eq 4.18 (BGM5208-200-12) prints o1 = 0.2435, o0 =
/// -0.4952; the program multiplies 0.2435 by the temperature instead, s0 = 0.2435. Both are in `motors/`, by
/// name.
///
/// @snippet actuator_examples.cpp thesis heating
/// How to: @ref custom_motor, @ref laws. Menu: @ref policies.
/// @ingroup actuator
template <class Number = float>
struct ThesisHeating {
  typedef typename detail::ModelNumber<Number>::Type Scalar;  ///< What it computes in.

  Number slope_V1_J_per_K2;  ///< s1, per volt
  Number slope_V0_J_per_K2;  ///< s0
  Number offset_V1_J_per_K;  ///< o1, per volt
  Number offset_V0_J_per_K;  ///< o0
  Number minimum_V_rms;      ///< At or below this voltage there is no heating (the program: 1 V).
  /// 1/r is not taken below this, J/K: outside the range it was measured in, the law has a pole and beyond it
  /// no heat at all, which would leave a cold motor unprotected. 0: as programmed.
  Number least_capacity_J_per_K;

  /// From the printed unit W min/K (and W min/K^2): the one place where minutes become seconds.
  static constexpr ThesisHeating per_minute(Number slope_V1, Number slope_V0, Number offset_V1,
                                            Number offset_V0, Number minimum_V_rms,
                                            Number least_capacity_J_per_K) noexcept {
    typedef typename detail::Numeric<Number>::Real Real;
    return ThesisHeating{slope_V1 * Real(60),  slope_V0 * Real(60), offset_V1 * Real(60),
                         offset_V0 * Real(60), minimum_V_rms,       least_capacity_J_per_K};
  }
  /// As programmed: with a least capacity of 0. (Written as a product: a number of several lanes that is only
  /// declared may hold anything.)
  static constexpr ThesisHeating per_minute(Number slope_V1, Number slope_V0, Number offset_V1,
                                            Number offset_V0, Number minimum_V_rms) noexcept {
    return per_minute(slope_V1, slope_V0, offset_V1, offset_V0, minimum_V_rms,
                      minimum_V_rms * typename detail::Numeric<Number>::Real(0));
  }

  static constexpr bool is_linear() { return false; }  ///< r depends on the temperature.
  /// 0 without voltage: a loss in watts would vanish with it.
  static constexpr bool is_heat_capacity() { return false; }

  /// 1/r, J/K; may be zero or negative outside the measured range.
  Number apparent_capacity_J_per_K(const Number& v_rms_V, const Number& motor_C) const noexcept {
    return capacity_slope_J_per_K2(v_rms_V) * motor_C + (offset_V1_J_per_K * v_rms_V + offset_V0_J_per_K);
  }

  /// r, in kelvin per joule; >= 0.
  Number rise_K_per_J(const Number& v_rms_V, const Number& motor_C) const noexcept {
    typedef typename detail::Numeric<Number>::Real Real;
    const Number capacity =
        detail::at_least(apparent_capacity_J_per_K(v_rms_V, motor_C), least_capacity_J_per_K);
    return where_heating(v_rms_V, capacity, Real(1) / capacity);
  }

  /// dr/dT = -r^2 (s1 V + s0), in 1/J.
  Number rise_slope_per_J(const Number& v_rms_V, const Number& motor_C) const noexcept {
    const Number capacity = apparent_capacity_J_per_K(v_rms_V, motor_C);
    const Number zero = (capacity + v_rms_V) * typename detail::Numeric<Number>::Real(0);
    return where_heating(v_rms_V, capacity,
                         detail::Numeric<Number>::choose_if_greater(
                             capacity, least_capacity_J_per_K,
                             -capacity_slope_J_per_K2(v_rms_V) / (capacity * capacity), zero));
  }

  /// Hands each field to an archive, in the order of a record: config_record.hpp.
  template <class Self, class Archive>
  static void each_field(Self& self, Archive& archive) {
    archive(self.slope_V1_J_per_K2, self.slope_V0_J_per_K2, self.offset_V1_J_per_K, self.offset_V0_J_per_K,
            self.minimum_V_rms, self.least_capacity_J_per_K);
  }
  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept {
    return first_error(
        detail::require_finite(slope_V1_J_per_K2 + slope_V0_J_per_K2 + offset_V1_J_per_K + offset_V0_J_per_K,
                               ConfigError::heating_J_per_K),
        first_error(detail::require_not_negative(minimum_V_rms, ConfigError::minimum_V_rms),
                    detail::require_not_negative(least_capacity_J_per_K, ConfigError::heating_J_per_K)));
  }

private:
  Number capacity_slope_J_per_K2(const Number& v_rms_V) const noexcept {
    return slope_V1_J_per_K2 * v_rms_V + slope_V0_J_per_K2;
  }

  Number where_heating(const Number& v_rms_V, const Number& capacity, const Number& value) const noexcept {
    typedef detail::Numeric<Number> Math;
    // Not a plain 0: NaN in temperature or voltage must stay visible instead of becoming "no heating".
    const Number zero = (capacity + v_rms_V) * typename Math::Real(0);
    return Math::choose_if_greater(v_rms_V, minimum_V_rms,
                                   Math::choose_if_greater(capacity, zero, value, zero), zero);
  }
};

}  // namespace thermopower
