// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../detail/numeric.hpp"

/// @file duty.hpp
/// From the controller's 8-bit power parameter to the voltage that drives the winding (thesis eq 3.10
/// and 3.11).

namespace thermopower {

/// Duty cycle of a power parameter, eq 3.10: D = P_param / 255.
/// @param power_param  0 .. 255 (a real number, so that a simulation may use levels in between)
/// @return 0 .. 1
/// @ingroup actuator
template <class Scalar>
Scalar duty_from_power(const Scalar& power_param) noexcept {
  typedef typename detail::Numeric<Scalar>::Real Real;
  return power_param * (Real(1) / Real(255));
}

/// Root-mean-square voltage of a switched supply, eq 3.11: V_rms = V_supply sqrt(D).
/// @param supply_V  amplitude of the switched voltage, >= 0
/// @param duty      0 .. 1; a negative duty gives NaN, which every limiter treats as hot
/// @ingroup actuator
template <class Scalar>
Scalar v_rms_from_duty(const Scalar& supply_V, const Scalar& duty) noexcept {
  return supply_V * detail::Numeric<Scalar>::square_root(duty);
}

/// V_rms of a power parameter in one call: eq 3.10 in eq 3.11.
/// @ingroup actuator
template <class Scalar>
Scalar v_rms_from_power(const Scalar& supply_V, const Scalar& power_param) noexcept {
  return v_rms_from_duty<Scalar>(supply_V, duty_from_power<Scalar>(power_param));
}

}  // namespace thermopower
