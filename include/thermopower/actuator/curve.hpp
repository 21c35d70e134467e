// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../detail/flash.hpp"

#include <stdint.h>

/// @file curve.hpp
/// A smooth function that is known by its values at evenly spaced knots: what a diagnosis found and nobody has named, as a
/// table in program memory.

namespace thermopower {
namespace detail {

/// Where a value lies among the knots of a curve, and what each of the four knots around it contributes.
///
/// Between two knots it is the cubic with the slopes of a Catmull-Rom spline.
/// @tparam Real  float or double
template <class Real>
struct CurvePlace {
  int first;       ///< the knot at or below; the four are `first - 1` to `first + 2`
  Real weight[4];  ///< of their values; 0 of a knot that is not there
  Real slope[4];   ///< the same of the slope, per knot
  bool inside;     ///< within the outermost knots; beyond, the curve keeps its value there

  /// @param at     in knots: 0 at the first, `count - 1` at the last; a number
  /// @param count  of the knots, 4 or more
  CurvePlace(Real at, int count) : inside(at >= Real(0) && at <= Real(count - 1)) {
    if (!(at > Real(0))) at = Real(0);
    if (at > Real(count - 1)) at = Real(count - 1);
    first = static_cast<int>(at);
    if (first > count - 2) first = count - 2;
    const Real s = at - Real(first), s2 = s * s, s3 = s2 * s;
    const Real h01 = Real(3) * s2 - Real(2) * s3, h10 = s3 - Real(2) * s2 + s, h11 = s3 - s2;
    combine(Real(1) - h01, h10, h01, h11, count, weight);
    const Real d01 = Real(6) * (s - s2);
    combine(-d01, Real(3) * s2 - Real(4) * s + Real(1), d01, Real(3) * s2 - Real(2) * s, count, slope);
  }

private:
  /// Values and slopes at both ends of a piece, in terms of the four knots.
  void combine(Real h00, Real h10, Real h01, Real h11, int count, Real* to) const {
    const bool starts = first == 0, ends = first == count - 2;
    // An end's slope is that of the parabola through the three outermost knots.
    to[0] = (starts ? Real(0) : -h10 / Real(2)) + (ends ? h11 / Real(2) : Real(0));
    to[1] = h00 - (starts ? Real(1.5) * h10 : Real(0)) - (ends ? Real(2) * h11 : h11 / Real(2));
    to[2] = h01 + (starts ? Real(2) * h10 : h10 / Real(2)) + (ends ? Real(1.5) * h11 : Real(0));
    to[3] = (ends ? Real(0) : h11 / Real(2)) - (starts ? h10 / Real(2) : Real(0));
  }
};

}  // namespace detail

/// Value of a curve, in the unit of its table; NaN where `x` is not a number.
/// @param table  values at the knots, declared with `thermopower_flash`
/// @param count  of the knots, 4 or more
/// @param from   x of the first knot
/// @param to     x of the last knot, > from; beyond both ends the curve keeps its value
/// @param x      where it is asked for
/// @ingroup actuator
inline float curve_value(const float* table, uint8_t count, float from, float to, float x) noexcept {
  const float at = (x - from) / (to - from) * static_cast<float>(count - 1);
  if (!(at >= 0.0f) && !(at < 0.0f)) return at;  // not a number
  const detail::CurvePlace<float> place(at, count);
  float sum = 0.0f;
  for (int k = 0; k < 4; ++k)
    if (place.first + k >= 1 && place.first + k <= count)
      sum += place.weight[k] * detail::read_flash(detail::flash_pointer(table) + (place.first + k - 1));
  return sum;
}

/// Slope of a curve, in the unit of its table per unit of `x`; 0 beyond its ends, NaN where `x` is not a number. Arguments as of
/// curve_value().
/// @ingroup actuator
inline float curve_slope(const float* table, uint8_t count, float from, float to, float x) noexcept {
  const float per_x = static_cast<float>(count - 1) / (to - from), at = (x - from) * per_x;
  if (!(at >= 0.0f) && !(at < 0.0f)) return at;  // not a number
  const detail::CurvePlace<float> place(at, count);
  if (!place.inside) return 0.0f;
  float sum = 0.0f;
  for (int k = 0; k < 4; ++k)
    if (place.first + k >= 1 && place.first + k <= count)
      sum += place.slope[k] * detail::read_flash(detail::flash_pointer(table) + (place.first + k - 1));
  return sum * per_x;
}

}  // namespace thermopower
