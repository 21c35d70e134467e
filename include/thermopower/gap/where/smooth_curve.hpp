// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/linear_solve.hpp>
#include <thermopower/gap/data/matrix_product.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

/// @file
/// A smooth curve through samples.

namespace thermopower::gap::engine {

/// A curve at evenly spaced places.
struct SmoothCurve {
  Eigen::VectorXd x;      ///< places, ascending; empty where there is no curve
  Eigen::VectorXd value;  ///< the curve there
  double freedom = 0.0;   ///< effective degrees of freedom: 2 is a straight line
};

namespace detail {

/// Sums of samples over cubic splines on evenly spaced knots.
struct SplineSums {
  static constexpr Eigen::Index segments = 72, size = segments + 3;
  Eigen::MatrixXd left = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
  double count = 0.0, sum = 0.0, squares = 0.0;

  /// The first spline that is not 0 at a place, and the four. @param place  0 at the first knot, `segments` at the last
  static Eigen::Vector4d splines_at(double place, Eigen::Index& first) {
    first = std::clamp<Eigen::Index>(static_cast<Eigen::Index>(place), 0, segments - 1);
    const double t = place - static_cast<double>(first), s = 1.0 - t;
    return Eigen::Vector4d(s * s * s, 3.0 * t * t * t - 6.0 * t * t + 4.0,
                           3.0 * s * s * s - 6.0 * s * s + 4.0, t * t * t) /
           6.0;
  }

  void add(double place, double y) {
    Eigen::Index first = 0;
    const Eigen::Vector4d splines = splines_at(place, first);
    for (int a = 0; a < 4; ++a) {
      right[first + a] += splines[a] * y;
      for (int b = 0; b < 4; ++b) left(first + a, first + b) += splines[a] * splines[b];
    }
    count += 1.0;
    sum += y;
    squares += y * y;
  }

  /// What coefficients leave of the samples' squares.
  double left_by(const Eigen::VectorXd& a) const {
    return squares - 2.0 * a.dot(right) + quadratic_form(left, a);
  }
};

}  // namespace detail

/// A smooth curve through samples: cubic splines whose bends cost (Eilers and Marx, "Flexible smoothing with B-splines and
/// penalties", Statistical Science 11, 1996). Its slope and the slope's slope have no jumps; across a gap between samples it goes
/// nearly straight on.
///
/// The largest weight of the bends is taken that predicts unseen eighths of the recording as well as the best one does. It
/// may miss a hundredth more, and a two-thousandth of the samples' variance. So a function of the variable keeps its bends,
/// and what the variable does not order is no zigzag. An eighth is made of pieces from all over the recording, so that others
/// have samples near its own, even if the variable passes each place once.
///
/// @param x, y  samples in the order in which they were recorded; NaN is left out
/// @param from, to  ends of the curve; samples up to a tenth of their distance further out count, too
/// @return empty where fewer than four samples count or the ends are none
inline SmoothCurve smooth_curve(const Eigen::VectorXd& x, const Eigen::VectorXd& y, double from, double to) {
  using Sums = detail::SplineSums;
  constexpr Eigen::Index places = 241, pieces = 64;
  constexpr std::size_t folds = 8;
  constexpr double as_good = 1.0 / 100.0, as_good_of_all = 1.0 / 2000.0, margin = 0.1, least_samples = 4.0;
  constexpr double softest = 1e-7, stiffest = 1e4, step = 3.1622776601683795;  // half a decade
  if (!(from < to) || !std::isfinite(to - from)) return {};
  const double begin = from - margin * (to - from),
               width = (1.0 + 2.0 * margin) * (to - from) / static_cast<double>(Sums::segments);
  const Eigen::Index count = std::min(x.size(), y.size());
  std::array<Sums, folds> of;
  Sums all;
  for (Eigen::Index i = 0; i < count; ++i) {
    const double place = (x[i] - begin) / width;
    if (!std::isfinite(y[i]) || !(place >= 0.0 && place <= static_cast<double>(Sums::segments))) continue;
    of[static_cast<std::size_t>(i * pieces / count) % folds].add(place, y[i]);
    all.add(place, y[i]);
  }
  if (all.count < least_samples) return {};
  // Where there are no samples the curve goes straight on; were they all at one place, level.
  constexpr double level = 1e-9;
  Eigen::MatrixXd bends = Eigen::MatrixXd::Zero(Sums::size, Sums::size);
  const Eigen::Vector3d second(1.0, -2.0, 1.0);
  const Eigen::Vector2d first(-1.0, 1.0);
  for (Eigen::Index k = 0; k + 1 < Sums::size; ++k) {
    bends.block<2, 2>(k, k) += level * first * first.transpose();
    if (k + 2 < Sums::size) bends.block<3, 3>(k, k) += second * second.transpose();
  }
  std::vector<double> stiffnesses, missed;  // by each the mean square that the eighths' predictions miss by
  double least = std::numeric_limits<double>::infinity();
  for (double stiffness = softest; stiffness < stiffest; stiffness *= step) {
    double squares = 0.0;
    for (const Sums& one : of)
      squares += one.left_by(
          SymmetricSystem(all.left - one.left + stiffness * all.count * bends).solve(all.right - one.right));
    stiffnesses.push_back(stiffness);
    missed.push_back(std::max(0.0, squares / all.count));
    least = std::min(least, missed.back());
  }
  const double mean = all.sum / all.count, variance = std::max(0.0, all.squares / all.count - mean * mean);
  double chosen = softest;
  for (std::size_t i = 0; i < missed.size(); ++i)
    if (missed[i] <= (1.0 + as_good) * least + as_good_of_all * variance) chosen = stiffnesses[i];
  const SymmetricSystem solver(all.left + chosen * all.count * bends);
  const Eigen::VectorXd a = solver.solve(all.right);
  SmoothCurve curve{Eigen::VectorXd::LinSpaced(places, from, to), Eigen::VectorXd(places)};
  for (Eigen::Index i = 0; i < places; ++i) {
    Eigen::Index at = 0;
    const Eigen::Vector4d splines = Sums::splines_at((curve.x[i] - begin) / width, at);
    curve.value[i] = splines.dot(a.segment<4>(at));
  }
  for (Eigen::Index k = 0; k < Sums::size; ++k) curve.freedom += solver.solve(all.left.col(k))[k];
  return curve;
}

}  // namespace thermopower::gap::engine
