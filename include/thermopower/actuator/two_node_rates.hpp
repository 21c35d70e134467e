// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../detail/numeric.hpp"

/// @file two_node_rates.hpp
/// How fast two thermal nodes settle: stated once, for the models, the observer and the desk.

namespace thermopower {

/// Decay rates of two nodes that exchange heat and of which one loses it: the eigenvalues, with their signs
/// turned, of
///
///     dT_w/dt = -a (T_w - T_b)
///     dT_b/dt =  b (T_w - T_b) - g (T_b - T_air)
///
/// Both are real and not negative, as the network has no way to store what would oscillate.
/// @ingroup actuator
template <class Number>
struct TwoNodeRates {
  static_assert(
      detail::IsModelNumber<Number>::value,
      "thermopower: the Number of TwoNodeRates must be float, double or a class that stands for one");

  Number fast_per_s;  ///< The nodes against each other, 1/s.
  Number slow_per_s;  ///< Both together against the air, 1/s; 0 where nothing is lost.
};

/// @param winding_to_body_per_s  a, coupling over the winding's heat capacity, > 0
/// @param body_to_winding_per_s  b, coupling over the body's heat capacity, > 0
/// @param body_to_air_per_s      g, conductance to the air over the body's heat capacity, >= 0
template <class Number>
inline TwoNodeRates<Number> two_node_rates(const Number& winding_to_body_per_s,
                                           const Number& body_to_winding_per_s,
                                           const Number& body_to_air_per_s) noexcept {
  typedef typename detail::Numeric<Number>::Real Real;
  const Number half_trace = (winding_to_body_per_s + body_to_winding_per_s + body_to_air_per_s) * Real(0.5);
  // A sum of squares: half_trace^2 less the determinant could come out negative where the eigenvalues nearly
  // meet.
  const Number half_difference =
      (winding_to_body_per_s - body_to_winding_per_s - body_to_air_per_s) * Real(0.5);
  TwoNodeRates<Number> rates;
  rates.fast_per_s =
      half_trace + detail::Numeric<Number>::square_root(Number(
                       half_difference * half_difference + winding_to_body_per_s * body_to_winding_per_s));
  // Not half_trace less the root, which cancels when the nodes' time constants lie far apart.
  rates.slow_per_s = winding_to_body_per_s * body_to_air_per_s / rates.fast_per_s;
  return rates;
}

}  // namespace thermopower
