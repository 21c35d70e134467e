// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/linear_solve.hpp>
#include <thermopower/gap/data/matrix_product.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
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

/// Cubic splines over evenly spaced knots, and what samples say of their coefficients, each stretch of the recording apart.
class SplineSamples {
public:
  static constexpr int stretches = 8;
  static constexpr Eigen::Index segments = 72, size = segments + 3;

  /// Samples that are NaN, or not between the ends, are left out.
  /// @param pieces  that the recording is cut into; every eighth belongs to the same stretch
  SplineSamples(const Eigen::VectorXd& x, const Eigen::VectorXd& y, double from, double to,
                Eigen::Index pieces)
      : from_(from), width_((to - from) / static_cast<double>(segments)) {
    assert(from < to && pieces > 0);
    const Eigen::Index count = std::min(x.size(), y.size());
    Eigen::MatrixXi crowd = Eigen::MatrixXi::Zero(segments, stretches);
    const auto counts = [&](Eigen::Index i) { return std::isfinite(y[i]) && x[i] >= from && x[i] <= to; };
    const auto stretch_of = [&](Eigen::Index i) { return i * pieces / count % stretches; };
    for (Eigen::Index i = 0; i < count; ++i)
      if (counts(i)) crowd(at(x[i]).first, stretch_of(i)) += 1;
    for (Eigen::Index i = 0; i < count; ++i) {
      if (!counts(i)) continue;
      const Piece piece = at(x[i]);
      const auto stretch = static_cast<std::size_t>(stretch_of(i));
      of_[stretch].add(piece, y[i]);
      all_.add(piece, y[i]);
      if (crowd.row(piece.first).sum() > crowd(piece.first, stretch_of(i))) shared_[stretch].add(piece, y[i]);
    }
    // Where there are no samples the curve goes straight on; were they all at one place, level.
    constexpr double level = 1e-9;
    for (Eigen::Index k = 0; k + 1 < size; ++k) {
      add_penalty(k, {-1.0, 1.0}, level);
      if (k + 2 < size) add_penalty(k, {1.0, -2.0, 1.0}, 1.0);
    }
  }

  double count() const { return all_.count; }
  /// Share of the samples that lie where other stretches have some, too.
  double shared() const {
    double sum = 0.0;
    for (const Sums& one : shared_) sum += one.count;
    return sum / all_.count;
  }
  /// Of the ordinates.
  double variance() const {
    const double mean = all_.sum / all_.count;
    return std::max(0.0, all_.squares / all_.count - mean * mean);
  }

  /// Mean square of the error of splines on the one stretch that they have not seen, if others have samples there.
  /// Elsewhere a hit would be luck. @param stiffness  weight of the bends
  double missed(double stiffness) const {
    double sum = 0.0, count = 0.0;
    for (std::size_t i = 0; i < of_.size(); ++i) {
      const Sums &seen_by_one = of_[i], &asked = shared_[i];
      if (!(asked.count > 0.0)) continue;
      const Eigen::VectorXd a =
          SymmetricSystem(all_.left - seen_by_one.left + stiffness * all_.count * penalty_)
              .solve(all_.right - seen_by_one.right);
      sum += asked.squares - 2.0 * a.dot(asked.right) + quadratic_form(asked.left, a);
      count += asked.count;
    }
    return count > 0.0 ? std::max(0.0, sum / count) : 0.0;
  }

  /// The spline of all samples at places.
  SmoothCurve curve(double stiffness, const Eigen::VectorXd& places) const {
    const SymmetricSystem solver(all_.left + stiffness * all_.count * penalty_);
    const Eigen::VectorXd a = solver.solve(all_.right);
    SmoothCurve curve;
    curve.x = places;
    curve.value = places;
    for (Eigen::Index i = 0; i < places.size(); ++i) {
      const Piece piece = at(places[i]);
      curve.value[i] = piece.share.dot(a.segment<4>(piece.first));
    }
    for (Eigen::Index k = 0; k < size; ++k) curve.freedom += solver.solve(all_.left.col(k))[k];
    return curve;
  }

private:
  /// The four splines that are not 0 at a place.
  struct Piece {
    Eigen::Index first;
    Eigen::Vector4d share;
  };
  /// The sums of samples.
  struct Sums {
    Eigen::MatrixXd left = Eigen::MatrixXd::Zero(size, size);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
    double count = 0.0, sum = 0.0, squares = 0.0;

    void add(const Piece& piece, double y) {
      for (int a = 0; a < 4; ++a) {
        right[piece.first + a] += piece.share[a] * y;
        for (int b = 0; b < 4; ++b) left(piece.first + a, piece.first + b) += piece.share[a] * piece.share[b];
      }
      count += 1.0;
      sum += y;
      squares += y * y;
    }
  };

  /// Adds the square of a difference of neighbouring coefficients. @param first  of them
  void add_penalty(Eigen::Index first, const std::vector<double>& difference, double weight) {
    for (std::size_t a = 0; a < difference.size(); ++a)
      for (std::size_t b = 0; b < difference.size(); ++b)
        penalty_(first + static_cast<Eigen::Index>(a), first + static_cast<Eigen::Index>(b)) +=
            weight * difference[a] * difference[b];
  }

  Piece at(double x) const {
    const double place = (x - from_) / width_;
    Piece piece;
    piece.first = std::clamp<Eigen::Index>(static_cast<Eigen::Index>(place), 0, segments - 1);
    const double t = place - static_cast<double>(piece.first), s = 1.0 - t;
    piece.share << s * s * s, 3.0 * t * t * t - 6.0 * t * t + 4.0, 3.0 * s * s * s - 6.0 * s * s + 4.0,
        t * t * t;
    piece.share /= 6.0;
    return piece;
  }

  double from_, width_;
  std::array<Sums, stretches> of_, shared_;  // by stretch; `shared_`: where other stretches have samples, too
  Sums all_;
  Eigen::MatrixXd penalty_ = Eigen::MatrixXd::Zero(size, size);
};

}  // namespace detail

/// A smooth curve through samples: cubic splines whose bends cost (Eilers and Marx, "Flexible smoothing with B-splines and
/// penalties", Statistical Science 11, 1996). Its slope and the slope's slope have no jumps; across a gap between samples it goes
/// nearly straight on.
///
/// The largest weight of the bends is taken that predicts unseen eighths of the recording as well as the best one does. It
/// may miss a hundredth more, and a two-thousandth of the samples' variance. So a function of the variable keeps its bends,
/// and what the variable does not order is no zigzag. Eighths count only where others have samples, too. For a variable
/// that passes most places only once, they are short pieces from all over the recording.
///
/// @param x, y  samples in the order in which they were recorded; NaN is left out
/// @param from, to  ends of the curve; samples up to a tenth of their distance further out count, too
/// @return empty where fewer than four samples count or the ends are none
inline SmoothCurve smooth_curve(const Eigen::VectorXd& x, const Eigen::VectorXd& y, double from, double to) {
  constexpr Eigen::Index places = 241;
  constexpr double as_good = 1.0 / 100.0, as_good_of_all = 1.0 / 2000.0, margin = 0.1;
  constexpr double least_samples = 4.0, least_shared = 0.25;
  constexpr Eigen::Index short_pieces = 400;
  constexpr double softest = 1e-7, stiffest = 1e4, step = 3.1622776601683795;  // half a decade
  if (!(from < to) || !std::isfinite(to - from)) return {};
  const double more = margin * (to - from);
  detail::SplineSamples samples(x, y, from - more, to + more, detail::SplineSamples::stretches);
  if (samples.count() < least_samples) return {};
  if (samples.shared() < least_shared)
    samples = detail::SplineSamples(x, y, from - more, to + more, short_pieces);
  double least = std::numeric_limits<double>::infinity();
  for (double stiffness = softest; stiffness < stiffest; stiffness *= step)
    least = std::min(least, samples.missed(stiffness));
  const double enough = (1.0 + as_good) * least + as_good_of_all * samples.variance();
  double chosen = softest;
  for (double stiffness = softest; stiffness < stiffest; stiffness *= step)
    if (samples.missed(stiffness) <= enough) chosen = stiffness;
  return samples.curve(chosen, Eigen::VectorXd::LinSpaced(places, from, to));
}

}  // namespace thermopower::gap::engine
