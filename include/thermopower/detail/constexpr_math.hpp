// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

/// @file constexpr_math.hpp
/// Powers at compile time, in the one-expression functions that C++11 allows: for tables that are computed by
/// the compiler.

namespace thermopower {
namespace detail {

/// 2 atanh(y) / y as a series in y^2, from term `from` on. For |y| <= 0.2 twelve terms reach a double's
/// rounding.
constexpr double atanh_series(double squared, int from) {
  return from > 11 ? 0.0 : 2.0 / (2 * from + 1) + squared * atanh_series(squared, from + 1);
}

/// ln x at compile time, x > 0; anything else does not compile where a constant is needed.
constexpr double constexpr_log(double x) {
  return x > 1.5 ? constexpr_log(x * 0.5) + 0.69314718055994530942
         : x < 0.75
             ? constexpr_log(x * 2.0) - 0.69314718055994530942
             : (x - 1.0) / (x + 1.0) * atanh_series((x - 1.0) / (x + 1.0) * ((x - 1.0) / (x + 1.0)), 0);
}

/// exp(x) as a series, from term `from` on: 1 + x / from (1 + ...).
constexpr double exp_series(double x, int from) {
  return from > 14 ? 1.0 : 1.0 + x / from * exp_series(x, from + 1);
}

/// x squared, so that a recursion is evaluated once.
constexpr double squared(double x) { return x * x; }

/// exp x at compile time.
constexpr double constexpr_exp(double x) {
  return x > 0.5 || x < -0.5 ? squared(constexpr_exp(x * 0.5)) : exp_series(x, 1);
}

/// base^exponent at compile time; base >= 0, exponent > 0. Right to some 1e-14 (1e-5 where a double has 32
/// bits).
constexpr double constexpr_pow(double base, double exponent) {
  return base > 0.0 ? constexpr_exp(exponent * constexpr_log(base)) : 0.0;
}

/// A list of numbers to expand a table with; C++11 has none without its standard library.
template <int... index>
struct Indices {};

/// `MakeIndices<3>::Type` is `Indices<0, 1, 2>`.
template <int count, int... index>
struct MakeIndices : MakeIndices<count - 1, count - 1, index...> {};
template <int... index>
struct MakeIndices<0, index...> {
  typedef Indices<index...> Type;
};

}  // namespace detail
}  // namespace thermopower
