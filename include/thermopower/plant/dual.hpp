// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/hyperbolic_tangent.hpp>
#include <thermopower/plant/sine_cosine.hpp>

#include <cassert>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace thermopower::plant {

/// Directions that one automatic-differentiation pass carries: an axis with two causes and the starts of its windows.
inline constexpr int dual_width = 12;
/// Directions of a wide one, for causes with many parameters: a third more of them in a quarter more time.
inline constexpr int wide_dual_width = 16;

/// A value with its derivative in some directions (forward-mode automatic differentiation).
///
/// The models are templated on their scalar: stepped in this one they yield the derivative of what they simulate,
/// by the chain rule rather than by differences. It does what Eigen's AutoDiffScalar does with plain loops of fixed
/// length, which compilers turn into vector instructions; measured here that is three times as fast.
///
/// Values are double precision, derivatives single: a fit is judged by its values, and its steps need a direction
/// right to some digits. Twelve directions then go in one pass of half the size, which halves the time of a search
/// through pairs.
///
/// @tparam width  directions; a multiple of 4, the numbers that a vector instruction takes at least
///
/// @snippet plant_examples.cpp dual
/// How to: @ref gap_method.
template <int width>
class DualOf {
public:
  using Scalar = double;  ///< the type of literals, as the actuator's laws ask for it

  DualOf() = default;
  /// A constant: no derivative in any direction.
  DualOf(double value) : slope_{}, value_(value) {}  // NOLINT: literals mix with duals in every law

  /// Plain value.
  double value() const { return value_; }
  /// Derivative in a direction, to single precision: six digits after some hundred steps of a simulation; beyond
  /// some 1e38 it is Inf.
  double slope(int direction) const { return static_cast<double>(slope_[direction]); }
  /// Whether it may vary in some direction.
  bool varies() const {
    std::uint32_t bits[width], any = 0;
    std::memcpy(bits, slope_, sizeof bits);
    for (const std::uint32_t one : bits) any |= one;
    return any != 0;
  }
  /// Makes it vary with a direction at unit speed. @param direction  from 0, below `width`
  void seed(int direction) {
    assert(direction >= 0 && direction < width);
    slope_[direction] = 1.0f;
  }
  /// Forgets the directions from `first` on.
  void forget(int first) {
    for (int i = first < 0 ? 0 : first; i < width; ++i) slope_[i] = 0.0f;
  }

  /// @name As with plain numbers
  /// Derivatives follow the product, quotient and chain rules in every direction; a plain number is a
  /// constant. Comparisons look at values alone. As with `double`, a division by zero, a root or a logarithm
  /// outside its domain yields Inf or NaN, in the derivatives too, and so does a derivative beyond single precision.
  /// @{

  /// See above.
  DualOf operator-() const { return chain(*this, -value_, -1.0); }
  [[gnu::always_inline]] DualOf& operator+=(const DualOf& b) {
    value_ += b.value_;
    for (int i = 0; i < width; ++i) slope_[i] += b.slope_[i];
    return *this;
  }
  [[gnu::always_inline]] DualOf& operator-=(const DualOf& b) {
    value_ -= b.value_;
    for (int i = 0; i < width; ++i) slope_[i] -= b.slope_[i];
    return *this;
  }
  [[gnu::always_inline]] DualOf& operator*=(const DualOf& b) {
    const float by = static_cast<float>(b.value_), from = static_cast<float>(value_);
    for (int i = 0; i < width; ++i) slope_[i] = slope_[i] * by + from * b.slope_[i];
    value_ *= b.value_;
    return *this;
  }
  [[gnu::always_inline]] DualOf& operator/=(const DualOf& b) {
    const double inverse = 1.0 / b.value_;
    value_ *= inverse;
    const float by = static_cast<float>(value_), per = static_cast<float>(inverse);
    for (int i = 0; i < width; ++i) slope_[i] = (slope_[i] - by * b.slope_[i]) * per;
    return *this;
  }
  [[gnu::always_inline]] DualOf& operator+=(double b) { return value_ += b, *this; }
  [[gnu::always_inline]] DualOf& operator-=(double b) { return value_ -= b, *this; }
  [[gnu::always_inline]] DualOf& operator*=(double b) {
    value_ *= b;
    const float by = static_cast<float>(b);
    for (int i = 0; i < width; ++i) slope_[i] *= by;
    return *this;
  }
  [[gnu::always_inline]] DualOf& operator/=(double b) { return *this *= 1.0 / b; }

  friend DualOf operator+(DualOf a, const DualOf& b) { return a += b; }
  friend DualOf operator-(DualOf a, const DualOf& b) { return a -= b; }
  friend DualOf operator*(DualOf a, const DualOf& b) { return a *= b; }
  friend DualOf operator/(DualOf a, const DualOf& b) { return a /= b; }
  friend DualOf operator+(DualOf a, double b) { return a += b; }
  friend DualOf operator-(DualOf a, double b) { return a -= b; }
  friend DualOf operator*(DualOf a, double b) { return a *= b; }
  friend DualOf operator/(DualOf a, double b) { return a /= b; }
  friend DualOf operator+(double a, DualOf b) { return b += a; }
  friend DualOf operator-(double a, const DualOf& b) { return chain(b, a - b.value_, -1.0); }
  friend DualOf operator*(double a, DualOf b) { return b *= a; }
  friend DualOf operator/(double a, const DualOf& b) {
    return chain(b, a / b.value_, -a / (b.value_ * b.value_));
  }

  friend bool operator<(const DualOf& a, const DualOf& b) { return a.value_ < b.value_; }
  friend bool operator>(const DualOf& a, const DualOf& b) { return a.value_ > b.value_; }
  friend bool operator<=(const DualOf& a, const DualOf& b) { return a.value_ <= b.value_; }
  friend bool operator>=(const DualOf& a, const DualOf& b) { return a.value_ >= b.value_; }

  friend DualOf exp(const DualOf& x) { return scaled(x, std::exp(x.value_)); }
  friend DualOf log(const DualOf& x) { return chain(x, std::log(x.value_), 1.0 / x.value_); }
  friend DualOf sin(const DualOf& x) {
    const SineCosine at(x.value_);
    return chain(x, at.sine, at.cosine);
  }
  friend DualOf cos(const DualOf& x) {
    const SineCosine at(x.value_);
    return chain(x, at.cosine, -at.sine);
  }
  friend DualOf tanh(const DualOf& x) {
    const double value = hyperbolic_tangent(x.value_);
    return chain(x, value, 1.0 - value * value);
  }
  friend DualOf sqrt(const DualOf& x) {
    const double root = std::sqrt(x.value_);
    return chain(x, root, 0.5 / root);
  }
  friend DualOf abs(const DualOf& x) { return x.value_ < 0.0 ? -x : x; }
  /// @}

  /// A function of two from its value and its derivatives by them, where these are known in plain numbers.
  static DualOf composed(double value, const DualOf& x, double by_x, const DualOf& y, double by_y) {
    DualOf result;
    result.value_ = value;
    const float of_x = static_cast<float>(by_x), of_y = static_cast<float>(by_y);
    for (int i = 0; i < width; ++i) result.slope_[i] = x.slope_[i] * of_x + y.slope_[i] * of_y;
    return result;
  }

private:
  /// f(x) with f' = f: the exponential.
  static DualOf scaled(const DualOf& x, double value) { return chain(x, value, value); }

  /// f(x) from f and f' at its value.
  static DualOf chain(const DualOf& x, double value, double derivative) {
    DualOf result;
    result.value_ = value;
    const float by = static_cast<float>(derivative);
    for (int i = 0; i < width; ++i) result.slope_[i] = x.slope_[i] * by;
    return result;
  }

  float slope_[width];  // first: vector instructions like it aligned
  double value_;
};

/// The one that fits are made with.
using Dual = DualOf<dual_width>;
/// The one for more directions than that.
using WideDual = DualOf<wide_dual_width>;

/// Plain value of a scalar.
inline double value_of(double x) { return x; }
/// Plain value of a scalar.
template <int width>
double value_of(const DualOf<width>& x) {
  return x.value();
}

/// Whether a scalar is a value and varies in no direction.
inline bool is_constant(double x, double value) { return x == value; }
/// Whether a scalar is a value and varies in no direction.
template <int width>
bool is_constant(const DualOf<width>& x, double value) {
  return x.value() == value && !x.varies();
}

/// A number as a scalar: no derivative in any direction.
template <class Scalar>
Scalar constant(double value) {
  return Scalar(value);
}

/// Makes `x` vary with direction `direction` at unit speed; nothing for a plain number.
inline void seed(double&, int) {}
/// Makes `x` vary with direction `direction` at unit speed.
template <int width>
void seed(DualOf<width>& x, int direction) {
  x.seed(direction);
}

/// Forgets the derivatives in the directions from `first` on.
inline void forget(double&, int) {}
/// Forgets the derivatives in the directions from `first` on.
template <int width>
void forget(DualOf<width>& x, int first) {
  x.forget(first);
}

/// Derivative of a scalar in a direction; 0 for a plain number.
inline double derivative_of(double, int) { return 0.0; }
/// Derivative of a scalar in a direction.
template <int width>
double derivative_of(const DualOf<width>& x, int direction) {
  return x.slope(direction);
}

/// |x|, with the derivative of the side x is on.
template <class Scalar>
Scalar magnitude(const Scalar& x) {
  return value_of(x) < 0.0 ? Scalar(-x) : x;
}

/// The larger of x and a number, with the derivative of the one that holds.
template <class Scalar>
Scalar at_least(const Scalar& x, double floor) {
  return value_of(x) > floor ? x : constant<Scalar>(floor);
}

/// The larger of two, with its derivative.
template <class Scalar>
Scalar larger(const Scalar& a, const Scalar& b) {
  return value_of(b) > value_of(a) ? b : a;
}

}  // namespace thermopower::plant
