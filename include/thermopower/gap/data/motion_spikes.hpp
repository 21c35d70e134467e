// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/mask_thresholds.hpp>
#include <thermopower/gap/data/neighbour_motion.hpp>
#include <thermopower/gap/data/robust.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

/// @file motion_spikes.hpp
/// Samples that lie far from what the neighbours on either side make of the motion, however it bends.

namespace thermopower::gap::engine {

/// Tells how far samples of one column stand out of their neighbours' motion. A corner, a step and a swing leave as much of the
/// neighbours as of the sample, and are none.
class MotionSpikes {
public:
  /// Of no column: nothing stands out.
  MotionSpikes() = default;

  /// @param values  of the column, NaN where missing
  /// @param t_s     stamps; nullptr: rows
  /// @param runs    inside which rows follow on each other
  /// @param quantum in which it is measured
  MotionSpikes(const Eigen::VectorXd& values, const Eigen::VectorXd* t_s, const std::vector<RunSpan>& runs,
               double quantum)
      : noise_(noise_on_motion(values, t_s, runs)) {
    std::vector<double> off;
    const std::size_t each = each_of_many(runs);
    for (const RunSpan& run : runs) {
      const OrderedSamples samples(values, t_s, run);
      for (std::size_t i = 2; i + 2 < samples.size(); i += each)
        off.push_back(std::abs(samples.off_neighbours<2>(i)));
    }
    least_ = std::max({limit_.quanta * quantum, limit_.worth_a_look * noise_,
                       limit_.than_often * quantile_of(off, limit_.often_off)});
  }

  /// Scale of the noise on the motion, as a standard deviation.
  double noise() const { return noise_; }

  /// How far each sample of a run stands out; 0 where it does not.
  std::vector<double> off(const OrderedSamples& samples) const {
    const std::size_t count = samples.size();
    std::vector<double> result(count, 0.0);
    if (!(noise_ > 0.0) || count < 7) return result;
    std::vector<double> between;
    for (std::size_t i = 1; i < count; ++i) between.push_back(samples.at[i] - samples.at[i - 1]);
    const double usually_between = median_of(between);
    for (std::size_t i = 2; i + 2 < count; ++i) {
      // Most samples need no closer look. Stamps may stray though the readings were taken evenly.
      const double off_four =
          std::min(std::abs(samples.off_neighbours<2>(i)), std::abs(off_evenly_spaced(samples.values, i)));
      if (!(off_four > least_)) continue;
      // An axis that rests for most of the time, or is loud where it is fast, has another noise here.
      const double noise_here = noise_around(samples, i, limit_.noise_around, limit_.drawn_along);
      for (const Stencil& stencil : stencils_)
        if (has(samples, i, stencil, usually_between))
          result[i] = std::max(result[i], off_alone(samples, i, stencil, noise_here));
    }
    return result;
  }

private:
  /// Neighbours and the polynomial through them.
  struct Stencil {
    std::size_t beside, degree;
    double
        rests;  ///< of what is left of the neighbours: how far a spike lies. No corner or step of any motion comes up to that
  };

  /// Off the cubic through four neighbours, were they evenly spaced.
  static double off_evenly_spaced(const std::vector<double>& x, std::size_t i) {
    return x[i] - (4.0 * (x[i - 1] + x[i + 1]) - x[i - 2] - x[i + 2]) / 6.0;
  }

  /// Whether a sample has all neighbours of a stencil, and hardly any row is lost among them.
  static bool has(const OrderedSamples& samples, std::size_t i, const Stencil& stencil,
                  double usually_between) {
    if (i < stencil.beside || i + stencil.beside >= samples.size()) return false;
    const double lasts = samples.at[i + stencil.beside] - samples.at[i - stencil.beside];
    return lasts < limit_.with_lost_rows * usually_between * static_cast<double>(2 * stencil.beside);
  }

  bool stands_out(const NeighbourMotion& motion, double rests, double noise_here) const {
    const double off = std::abs(motion.off) / motion.gain;
    return std::abs(motion.off) > least_ && off > limit_.motion_scales * noise_ &&
           off > limit_.motion_scales_here * noise_here && off > rests * motion.rest;
  }

  /// How far a sample lies from the motion of good neighbours; 0 where it does not stand out.
  double off_alone(const OrderedSamples& samples, std::size_t i, const Stencil& stencil,
                   double noise_here) const {
    const NeighbourMotion motion = neighbour_motion(samples, i, stencil.beside, stencil.degree);
    if (!stands_out(motion, stencil.rests, noise_here)) return 0.0;
    const double off = std::abs(motion.off);
    // With many coefficients little may be left of the neighbours of a corner by chance.
    const bool leaves_much = motion.rest > limit_.rests_like_noise * noise_;
    const bool may_be_corner = leaves_much || stencil.degree >= 5;
    const double within = (may_be_corner ? limit_.corner : limit_.sharp_corner) * off,
                 within_noise = may_be_corner ? limit_.on_a_line * noise_ : 0.0;
    if (continues<2>(samples, i, within, within_noise)) return 0.0;
    if (leaves_much && continues<3>(samples, i, within, within_noise)) return 0.0;
    return off;
  }

  /// Whether a sample lies where those before it go on to, or those after it come from: a corner. So many and one more must agree
  /// about the straight line, or the parabola.
  /// @tparam through      samples that tell where it goes on: 2 of a line, 3 of a parabola
  /// @param within        how near it must lie
  /// @param within_noise  or how near, in the unit of the column, were there no noise on what the others tell
  template <std::size_t through>
  static bool continues(const OrderedSamples& samples, std::size_t i, double within, double within_noise) {
    // Whether a sample lies where those one step on, two steps on, ... predict.
    const auto is_on = [&](std::size_t k, std::ptrdiff_t step) {
      std::array<double, through> where{}, what{};
      for (std::size_t j = 0; j < through; ++j) {
        const auto steps = step * static_cast<std::ptrdiff_t>(j + 1);
        const auto next = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(k) + steps);
        where[j] = samples.at[next] - samples.at[k];
        what[j] = samples.values[next];
      }
      double squares = 1.0;
      for (std::size_t j = 0; j < through; ++j) {
        std::array<double, through> one{};
        one[j] = 1.0;
        const double weight = polynomial_at_zero(where, one);
        squares += weight * weight;
      }
      const double off = std::abs(samples.values[k] - polynomial_at_zero(where, what));
      return off < std::max(within, within_noise * std::sqrt(squares));
    };
    constexpr std::size_t needed = through + 1;
    return (i >= needed && is_on(i - needed, 1) && is_on(i, -1)) ||
           (i + needed < samples.size() && is_on(i + needed, -1) && is_on(i, 1));
  }

  static constexpr MaskThresholds limit_{};
  static constexpr std::array<Stencil, 6> stencils_{
      {{2, 1, 5.0}, {3, 3, 6.0}, {4, 3, 5.0}, {5, 5, 5.0}, {4, 5, 6.0}, {5, 7, 6.0}}};
  double noise_ = 0.0;
  double least_ = 0.0;  // that a sample lies off its four neighbours
};

}  // namespace thermopower::gap::engine
