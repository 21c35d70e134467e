// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "probe.hpp"

#include <math.h>
#include <stdint.h>
#include <string.h>

/// @file numeric.hpp
/// What the models need from their scalar: avr-libc has neither `<cmath>` nor overloads, and the same models
/// also run on `Eigen::Array` (many actuators at once) and on automatic-differentiation scalars.

namespace thermopower {
namespace detail {

/// Whether a model can compute in it: `float`, `double`, or a class (lanes of numbers, a number that knows its
/// derivatives).
template <class Number, class = int>
struct IsModelNumber {
  static constexpr bool value = false;
};
template <>
struct IsModelNumber<float, int> {
  static constexpr bool value = true;
};
template <>
struct IsModelNumber<double, int> {
  static constexpr bool value = true;
};
template <class Number>
struct IsModelNumber<
    Number, typename Exists<int Number::*, decltype(probe<const Number>() * probe<const Number>())>::Type> {
  static constexpr bool value = true;
};

/// The number itself, where a model can compute in it.
template <class Number>
struct ModelNumber {
  static_assert(
      IsModelNumber<Number>::value,
      "thermopower: the Number of a law or model must be float, double or a class that stands for one; whole "
      "numbers have their own models in namespace fixed_point");
  typedef Number Type;
};

/// Operations on one kind of scalar. This primary template serves every class that has a nested `Scalar`,
/// compares to a plain `bool` and whose functions are found beside it (Eigen's AutoDiffScalar); lanes of
/// numbers specialise it in `simulation/lanes.hpp`.
template <class Number>
struct Numeric {
  typedef typename Number::Scalar Real;  ///< The built-in type of literals: `Real(0.5)` multiplies any
                                         ///< Number.

  static Number constant(Real value) { return Number(value); }
  static Number square_root(const Number& x) { return Number(sqrt(x)); }
  static Number exponential(const Number& x) { return Number(exp(x)); }
  static Number power(const Number& base, const Number& exponent) {
    return Number(exp(exponent * log(base)));
  }
  static Number choose_if_greater(const Number& left, const Number& right, const Number& yes,
                                  const Number& no) {
    return left > right ? yes : no;
  }
};

template <>
struct Numeric<float> {
  typedef float Real;
  static float constant(float value) { return value; }
  static float square_root(float x) { return sqrtf(x); }
  static float exponential(float x) { return expf(x); }
  static float power(float base, float exponent) { return powf(base, exponent); }
  static float choose_if_greater(float left, float right, float yes, float no) {
    return left > right ? yes : no;
  }
};

template <>
struct Numeric<double> {
  typedef double Real;
  static double constant(double value) { return value; }
  static double square_root(double x) { return sqrt(x); }
  static double exponential(double x) { return exp(x); }
  static double power(double base, double exponent) { return pow(base, exponent); }
  static double choose_if_greater(double left, double right, double yes, double no) {
    return left > right ? yes : no;
  }
};

/// The value, but not below the bound. A NaN value stays NaN: it must reach whoever decides about it.
template <class Number>
Number at_least(const Number& value, const Number& bound) {
  return Numeric<Number>::choose_if_greater(bound, value, bound, value);
}

/// The value, but not above the bound. A NaN value stays NaN.
template <class Number>
Number at_most(const Number& value, const Number& bound) {
  return Numeric<Number>::choose_if_greater(value, bound, bound, value);
}

/// (1 - exp(-x)) / x for x >= 0: the mean of a decay over a step. Right to rounding everywhere, also near 0,
/// where the quotient would lose every digit.
template <class Number>
Number mean_decay(const Number& x) {
  typedef Numeric<Number> Math;
  typedef typename Math::Real Real;
  // With y = x / 2 it is also exp(-y) sinh(y) / y, whose series in y^2 subtracts nothing. Up to x = 1 four
  // terms serve a float, eight a double; beyond, the quotient has its digits.
  const Number limit = Math::constant(Real(1));
  const Number half_decay = Math::exponential(Number(x * Real(-0.5)));
  const Number half = at_most(x, limit) * Real(0.5);
  const Number square = half * half;
  Number series = Math::constant(Real(1));
  if (sizeof(Real) > 4) {
    series = Real(1) + square * (Real(1) / Real(210));
    series = Real(1) + square * series * (Real(1) / Real(156));
    series = Real(1) + square * series * (Real(1) / Real(110));
    series = Real(1) + square * series * (Real(1) / Real(72));
  }
  series = Real(1) + square * series * (Real(1) / Real(42));
  series = Real(1) + square * series * (Real(1) / Real(20));
  series = Real(1) + square * series * (Real(1) / Real(6));
  const Number quotient = (Real(1) - half_decay * half_decay) / at_least(x, limit);
  return Math::choose_if_greater(x, limit, quotient, Number(half_decay * series));
}

/// True for every number but NaN and the infinities. By bits, so that it also holds under -ffast-math.
inline bool is_finite(float x) noexcept {
  uint32_t bits;
  memcpy(&bits, &x, sizeof bits);
  return (bits & 0x7f800000u) != 0x7f800000u;
}

#if defined(__SIZEOF_DOUBLE__) && __SIZEOF_DOUBLE__ == 8
/// @overload
inline bool is_finite(double x) noexcept {
  uint64_t bits;
  memcpy(&bits, &x, sizeof bits);
  return (bits & 0x7ff0000000000000u) != 0x7ff0000000000000u;
}
#else
/// @overload
inline bool is_finite(double x) noexcept { return is_finite(static_cast<float>(x)); }
#endif

/// The bits of |x|: they order as the numbers do, infinity after every number and NaN after infinity.
inline uint32_t magnitude_bits(float x) noexcept {
  uint32_t bits;
  memcpy(&bits, &x, sizeof bits);
  return bits & 0x7fffffffu;
}
/// True above 0 and below infinity.
inline bool is_finite_positive(float x) noexcept {
  uint32_t bits;
  memcpy(&bits, &x, sizeof bits);
  return bits - 1u < 0x7f7fffffu;
}
/// True from 0 to below `limit`, which must be positive; -0 and NaN are not.
inline bool is_from_zero_to(float x, float limit) noexcept {
  uint32_t bits, limit_bits;
  memcpy(&bits, &x, sizeof bits);
  memcpy(&limit_bits, &limit, sizeof limit_bits);
  return bits < limit_bits;
}
/// True from `lowest` to `highest`, both of which must be positive; NaN is not. By bits, which order as positive numbers do.
inline bool is_within(float x, float lowest, float highest) noexcept {
  uint32_t bits, lowest_bits, highest_bits;
  memcpy(&bits, &x, sizeof bits);
  memcpy(&lowest_bits, &lowest, sizeof lowest_bits);
  memcpy(&highest_bits, &highest, sizeof highest_bits);
  return bits - lowest_bits <= highest_bits - lowest_bits;
}
/// True when both are the same to the bit: also two NaNs of a kind, but not 0 and -0.
inline bool is_same(float left, float right) noexcept {
  uint32_t left_bits, right_bits;
  memcpy(&left_bits, &left, sizeof left_bits);
  memcpy(&right_bits, &right, sizeof right_bits);
  return left_bits == right_bits;
}

/// NaN as a float: avr-libc's own is a double.
inline float not_a_number() noexcept { return static_cast<float>(NAN); }

/// Absolute value. Arduino.h makes a macro of the usual name.
inline float magnitude(float x) noexcept {
  const uint32_t bits = magnitude_bits(x);
  float result;
  memcpy(&result, &bits, sizeof result);
  return result;
}
/// @overload
inline double magnitude(double x) noexcept { return x < 0.0 ? -x : x; }

}  // namespace detail
}  // namespace thermopower
