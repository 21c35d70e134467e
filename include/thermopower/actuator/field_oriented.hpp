// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../detail/numeric.hpp"

/// @file field_oriented.hpp
/// Heat and limits of a field-oriented drive. Copper does not know which component a current belongs to: what
/// heats it is |i|^2 = i_d^2 + i_q^2, also while the field is weakened or the torque per ampere maximised.

namespace thermopower {

/// Squared magnitude of the current. NaN stays NaN. @return A^2
template <class Number>
Number current_squared_A2(const Number& d_A, const Number& q_A) {
  return d_A * d_A + q_A * q_A;
}

/// Heat in a three-phase winding from amplitude-invariant d and q currents: 3/2 R |i|^2. @param phase_ohm  of
/// one phase
template <class Number>
Number field_oriented_heat_W(const Number& d_A, const Number& q_A, const Number& phase_ohm) {
  typedef typename detail::Numeric<Number>::Real Real;
  return Real(1.5) * phase_ohm * current_squared_A2(d_A, q_A);
}

/// Largest i_q that keeps |i| within a limit beside an i_d that is already flowing: sqrt(limit^2 - i_d^2).
/// 0 where the root would be of a negative number, and where anything is NaN: no room is no torque, never
/// full torque.
inline float highest_q_current_A(float limit_A, float d_A) noexcept {
  const float room = limit_A * limit_A - d_A * d_A;
  return limit_A > 0.0f && room > 0.0f ? sqrtf(room) : 0.0f;
}

/// Largest |i| at which a winding bears `heat_W`: sqrt(heat / (3/2 R)). 0 for a heat that is negative or NaN,
/// and for R <= 0.
inline float highest_current_A(float heat_W, float phase_ohm) noexcept {
  return heat_W > 0.0f && phase_ohm > 0.0f ? sqrtf(heat_W / (1.5f * phase_ohm)) : 0.0f;
}

}  // namespace thermopower
