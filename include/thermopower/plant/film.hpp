// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>

#include <cmath>

namespace thermopower::plant {

/// The share of dry friction that acts at a rate, with its sign: tanh(x) where `tail` is 0, x / (1 + |x|) where it is
/// 1, x cut off at -1 and 1 where it is -1, and what lies between in proportion. A film that is sheared carries a torque
/// that turns over with the rate; how soon it becomes the full one differs from joint to joint, and a creeping motion
/// shows it. Many simulators use the last of the three, a damper with a limit, in dry friction's place.
/// @param x     rate over the transition
/// @param tail  -1..1
template <class Scalar>
Scalar film_share(const Scalar& x, const Scalar& tail) {
  const Scalar steep = hyperbolic_tangent(x), gentle = x / (magnitude(x) + 1.0);
  const Scalar abrupt = (magnitude(Scalar(x + 1.0)) - magnitude(Scalar(x - 1.0))) * 0.5;
  const Scalar size = magnitude(tail);
  return steep + (size + tail) * 0.5 * (gentle - steep) + (size - tail) * 0.5 * (abrupt - steep);
}

/// The share with what it changes by, worked out in plain numbers: an axis with dry friction asks for them at every step.
struct FilmAt {
  double share;          ///< as `film_share`
  double slope;          ///< derivative of the share by x
  double by_tail;        ///< derivative of the share by the tail
  double slope_by_x;     ///< derivative of the slope by x
  double slope_by_tail;  ///< derivative of the slope by the tail

  /// @param x     rate over the transition
  /// @param tail  -1..1
  FilmAt(double x, double tail) {
    const double steep = hyperbolic_tangent(x), steep_slope = 1.0 - steep * steep;
    const double within = 1.0 / (std::abs(x) + 1.0), side = tail < 0.0 ? -1.0 : 1.0;
    const double other = tail < 0.0 ? 0.5 * (std::abs(x + 1.0) - std::abs(x - 1.0)) : x * within;
    const double other_slope = tail < 0.0 ? (std::abs(x) < 1.0 ? 1.0 : 0.0) : within * within;
    const double other_bend = tail < 0.0 ? 0.0 : (x < 0.0 ? 2.0 : -2.0) * within * within * within;
    const double steep_bend = -2.0 * steep * steep_slope, size = side * tail;
    share = steep + size * (other - steep);
    slope = steep_slope + size * (other_slope - steep_slope);
    slope_by_x = steep_bend + size * (other_bend - steep_bend);
    by_tail = side * (other - steep);
    slope_by_tail = side * (other_slope - steep_slope);
  }
};

/// The share of friction, see above.
template <int width>
DualOf<width> film_share(const DualOf<width>& x, const DualOf<width>& tail) {
  const FilmAt at(x.value(), tail.value());
  return DualOf<width>::composed(at.share, x, at.slope, tail, at.by_tail);
}

/// The share and its derivative by x.
template <class Scalar>
struct FilmWithSlope {
  Scalar share;  ///< as `film_share`
  Scalar slope;  ///< derivative of the share by the rate over the transition

  /// @param x     rate over the transition
  /// @param tail  -1..1
  FilmWithSlope(const Scalar& x, const Scalar& tail)
      : FilmWithSlope(FilmAt(value_of(x), value_of(tail)), x, tail) {}

private:
  FilmWithSlope(const FilmAt& at, double, double) : share(at.share), slope(at.slope) {}
  template <int width>
  FilmWithSlope(const FilmAt& at, const DualOf<width>& x, const DualOf<width>& tail)
      : share(DualOf<width>::composed(at.share, x, at.slope, tail, at.by_tail)),
        slope(DualOf<width>::composed(at.slope, x, at.slope_by_x, tail, at.slope_by_tail)) {}
};

}  // namespace thermopower::plant
