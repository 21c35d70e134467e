// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../detail/check.hpp"
#include "detail/composition.hpp"
#include "surroundings.hpp"

/// @file sum_of_cooling.hpp
/// Several ways to lose heat at once. Menu: cooling.hpp.

namespace thermopower {

/// Two cooling paths in parallel.
///
/// @snippet actuator_examples.cpp cooling
/// How to: @ref custom_motor, @ref laws. Menu: @ref policies.
/// @ingroup actuator
template <class First, class Second>
struct SumOfCooling {
  static_assert(detail::IsCoolingLaw<First>::value && detail::IsCoolingLaw<Second>::value,
                "thermopower: both parameters of SumOfCooling must be cooling laws, such as NewtonCooling");

  typedef typename First::Scalar Scalar;  ///< What it computes in.

  First first;    ///< One path.
  Second second;  ///< The other; may itself be a sum.

  static constexpr bool is_linear() { return First::is_linear() && Second::is_linear(); }  ///< When both are.
  /// When one is.
  static constexpr bool is_in_watts() { return First::is_in_watts() || Second::is_in_watts(); }
  /// Loss, W; needs two laws stated in watts.
  Scalar loss_W(const Scalar& motor_C, const Surroundings<Scalar>& around) const noexcept {
    return first.loss_W(motor_C, around) + second.loss_W(motor_C, around);
  }
  /// Cooling rate, K/s.
  Scalar rate_K_per_s(const Scalar& motor_C, const Surroundings<Scalar>& around,
                      const Scalar& rise_K_per_J) const noexcept {
    return first.rate_K_per_s(motor_C, around, rise_K_per_J) +
           second.rate_K_per_s(motor_C, around, rise_K_per_J);
  }
  /// d rate / dT, 1/s.
  Scalar slope_per_s(const Scalar& motor_C, const Surroundings<Scalar>& around,
                     const Scalar& rise_K_per_J) const noexcept {
    return first.slope_per_s(motor_C, around, rise_K_per_J) +
           second.slope_per_s(motor_C, around, rise_K_per_J);
  }
  /// Hands each field to an archive, in the order of a record: config_record.hpp.
  template <class Self, class Archive>
  static void each_field(Self& self, Archive& archive) {
    archive(self.first, self.second);
  }
  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept { return first_error(first.validate(), second.validate()); }
};

}  // namespace thermopower
