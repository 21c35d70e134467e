// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <Eigen/Core>
#include <unsupported/Eigen/AutoDiff>

#include <cmath>

namespace thermopower::gap {

/// Directions that one automatic-differentiation pass carries.
inline constexpr int dual_width = 8;

/// A value with its derivative in `dual_width` directions. The models are templated on their scalar: stepped
/// in this one they yield the exact derivative of what they simulate.
using Dual = Eigen::AutoDiffScalar<Eigen::Matrix<double, dual_width, 1>>;

/// Plain value of a scalar.
inline double value_of(double x) { return x; }
/// Plain value of a scalar.
inline double value_of(const Dual& x) { return x.value(); }

/// A constant as a scalar: no derivative in any direction.
template <class Scalar>
Scalar constant(double value);
template <>
inline double constant<double>(double value) {
  return value;
}
template <>
inline Dual constant<Dual>(double value) {
  return Dual(value, Eigen::Matrix<double, dual_width, 1>::Zero());
}

/// Makes `x` vary with direction `direction` at unit speed; nothing for a plain number.
inline void seed(double&, int) {}
/// Makes `x` vary with direction `direction` at unit speed.
inline void seed(Dual& x, int direction) { x.derivatives()[direction] = 1.0; }

/// Derivative of a scalar in a direction; 0 for a plain number.
inline double derivative_of(double, int) { return 0.0; }
/// Derivative of a scalar in a direction.
inline double derivative_of(const Dual& x, int direction) { return x.derivatives()[direction]; }

/// The functions that effects use, for both scalars.
inline double power(double base, double exponent) { return std::pow(base, exponent); }
/// base^exponent for a base above 0.
inline Dual power(const Dual& base, const Dual& exponent) {
  using std::exp;
  using std::log;
  return exp(exponent * log(base));
}

/// |x|, with the derivative of the side x is on.
template <class Scalar>
Scalar magnitude(const Scalar& x) {
  return value_of(x) < 0.0 ? Scalar(-x) : x;
}

/// The larger of x and a number.
template <class Scalar>
Scalar at_least(const Scalar& x, double floor) {
  return value_of(x) > floor ? x : constant<Scalar>(floor);
}

}  // namespace thermopower::gap
