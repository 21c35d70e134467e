// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <Eigen/Core>

#include <thermopower/detail/numeric.hpp>

/// @file lanes.hpp
/// Many actuators stepped at once: the models on fixed-size columns of numbers, one lane per actuator.

namespace thermopower {

/// A column of `lane_count` numbers that the models take as their scalar:
/// `ThermalModel<HeatCapacityHeating<Lanes<double, 8>>, ...>`. Every constant, input and state is then per
/// lane. Lanes do not see each other: a NaN in one stays in that one.
///
/// `validate()` is for one actuator: check the constants lane by lane in a plain scalar before packing them.
/// @tparam Real        float or double
/// @tparam lane_count  above 0; a multiple of the vector width (8 doubles fill an AVX-512 register, two AVX
/// ones) runs fastest
/// @ingroup simulation
template <class Real, int lane_count>
using Lanes = Eigen::Array<Real, lane_count, 1>;

namespace detail {

/// The models' operations on every lane. Decisions become selections: both sides are computed, each lane
/// takes its own.
template <class RealNumber, int lane_count, int options>
struct Numeric<Eigen::Array<RealNumber, lane_count, 1, options, lane_count, 1>> {
  static_assert(lane_count > 0,
                "thermopower: lanes have a fixed size; dynamic arrays would allocate in every step");

  using Number = Eigen::Array<RealNumber, lane_count, 1, options, lane_count, 1>;  ///< One number per lane.
  using Real = RealNumber;  ///< Literals: the same for every lane.

  static Number constant(Real value) { return Number::Constant(value); }
  static Number square_root(const Number& x) { return x.sqrt(); }
  // Calls: inlined, their hundreds of instructions push the lanes of the loop around them out of the registers.
  [[gnu::noinline]] static Number exponential(const Number& x) { return x.exp(); }
  // As in the primary template; of a base of 0 less than the smallest normal number. Eigen's own rounds better and
  // takes longer.
  [[gnu::noinline]] static Number power(const Number& base, const Number& exponent) {
    return (exponent * base.log()).exp();
  }
  static Number choose_if_greater(const Number& left, const Number& right, const Number& yes,
                                  const Number& no) {
    return (left > right).select(yes, no);
  }
};

}  // namespace detail
}  // namespace thermopower
