// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../detail/numeric.hpp"

/// @file thermal_step.hpp
/// How one node's temperature is carried over a time step.
///
/// | step | when to take it |
/// |---|---|
/// | `EulerStep` | eq 4.21 as programmed; right when the step is far below the time constant (30 ms against minutes) |
/// | `ExactStep` | linear laws: exact for constant inputs at any step size. The default |
/// | `LinearizedStep` | laws that are not linear: exact for their tangent, never unstable, second order in the step |

namespace thermopower {

/// Forward Euler, eq 4.21: T += rate dt. Unstable when dt exceeds twice the time constant.
///
/// @snippet actuator_examples.cpp steps
/// How to: @ref laws. Menu: @ref policies.
/// @ingroup actuator
struct EulerStep {
  static constexpr bool needs_linear_laws() { return false; }  ///< Takes any law.
  /// @param rate_K_per_s  dT/dt at the start of the step
  /// @param dt_s          >= 0
  /// @return change of temperature, K
  template <class Number>
  static Number change_K(const Number& rate_K_per_s, const Number&, const Number& dt_s) noexcept {
    return rate_K_per_s * dt_s;
  }
};

/// The solution of dT/dt = a - s T for inputs that are constant over the step.
///
/// @snippet actuator_examples.cpp steps
/// How to: @ref laws. Menu: @ref policies.
/// @ingroup actuator
struct LinearizedStep {
  static constexpr bool needs_linear_laws() { return false; }  ///< Takes any law; exact for a linear one.
  /// @param slope_per_s  s = -d rate / dT, >= 0. A negative slope (runaway) is stepped as 0, that is by
  /// Euler.
  template <class Number>
  static Number change_K(const Number& rate_K_per_s, const Number& slope_per_s, const Number& dt_s) noexcept {
    typedef detail::Numeric<Number> Math;
    const Number decay = detail::at_least(Number(slope_per_s * dt_s), Math::constant(typename Math::Real(0)));
    return rate_K_per_s * dt_s * detail::mean_decay(decay);
  }
};

/// As LinearizedStep, but only for laws that are linear, where it is exact: two half steps equal one whole
/// step.
///
/// @snippet actuator_examples.cpp steps
/// How to: @ref laws. Menu: @ref policies.
/// @ingroup actuator
struct ExactStep : LinearizedStep {
  /// Refuses, at compile time, laws that are not linear.
  static constexpr bool needs_linear_laws() { return true; }
};

}  // namespace thermopower
