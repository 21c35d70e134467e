// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/simulation/lanes.hpp>

/// @file vector_math.hpp
/// What the mechanics need from their scalar beyond `detail::Numeric`, where lanes have something faster than
/// the same in single operations.

namespace thermopower::simulation {

/// Functions of one kind of scalar: a number, or a class that behaves like one.
///
/// @snippet simulation_examples.cpp vector math
/// How to: @ref rig.
template <class Number>
struct VectorMath {
  using Math = thermopower::detail::Numeric<Number>;  ///< Its operations.
  using Real = typename Math::Real;                   ///< Of literals.

  /// |x|; NaN stays NaN.
  static Number absolute(const Number& x) {
    return Math::choose_if_greater(x, Math::constant(Real(0)), x, Number(-x));
  }
  /// 1 / sqrt(x) for x > 0.
  static Number inverse_root(const Number& x) { return Number(Real(1) / Math::square_root(x)); }
};

/// On lanes: a bit is cleared, and an estimate improved, which costs a third of a root and a division.
template <class RealNumber, int lane_count, int options>
struct VectorMath<Eigen::Array<RealNumber, lane_count, 1, options, lane_count, 1>> {
  using Number = Eigen::Array<RealNumber, lane_count, 1, options, lane_count, 1>;  ///< One number per lane.

  /// |x|; NaN stays NaN.
  static Number absolute(const Number& x) { return x.abs(); }
  /// 1 / sqrt(x) for x > 0, right to some units of the last digit.
  static Number inverse_root(const Number& x) { return x.rsqrt(); }
};

}  // namespace thermopower::simulation
