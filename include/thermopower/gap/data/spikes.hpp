// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/finding_list.hpp>
#include <thermopower/gap/data/first_reading.hpp>
#include <thermopower/gap/data/mask_thresholds.hpp>
#include <thermopower/gap/data/neighbour_motion.hpp>
#include <thermopower/gap/data/robust.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

/// @file spikes.hpp
/// Samples of one column that lie far from all around them: from the median of five, or from what the neighbours on
/// either side make of the motion.

namespace thermopower::gap::engine {

/// Tells how far samples of one column stand out of their neighbours' motion. A corner, a step and a swing leave as
/// much of the neighbours as of the sample, and are none.
class MotionSpikes {
public:
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
      for (std::size_t i = 2; i + 2 < samples.size(); i += each) off.push_back(std::abs(samples.off_four(i)));
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
          std::min(std::abs(samples.off_four(i)), std::abs(off_evenly_spaced(samples.values, i)));
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
    /// Of what is left of the neighbours: how far a spike lies. No corner or step of any motion comes up to that.
    double rests;
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

  /// How far a sample lies from the motion of good neighbours; 0 where it does not stand out.
  double off_alone(const OrderedSamples& samples, std::size_t i, const Stencil& stencil,
                   double noise_here) const {
    const NeighbourMotion motion = neighbour_motion(samples, i, stencil.beside, stencil.degree);
    const double off = std::abs(motion.off), against_noise = off / motion.gain;
    if (!(off > least_ && against_noise > limit_.motion_scales * noise_ &&
          against_noise > limit_.motion_scales_here * noise_here &&
          against_noise > stencil.rests * motion.rest))
      return 0.0;
    // With many coefficients little may be left of the neighbours of a corner by chance.
    const bool leaves_much = motion.rest > limit_.rests_like_noise * noise_;
    const bool may_be_corner = leaves_much || stencil.degree >= 5;
    const double within = (may_be_corner ? limit_.corner : limit_.sharp_corner) * off,
                 within_noise = may_be_corner ? limit_.on_a_line * noise_ : 0.0;
    if (continues<2>(samples, i, within, within_noise)) return 0.0;
    if (leaves_much && continues<3>(samples, i, within, within_noise)) return 0.0;
    return off;
  }

  /// Whether a sample lies where those before it go on to, or those after it come from: a corner. So many and one
  /// more must agree about the straight line, or the parabola.
  /// @tparam through      samples that tell where it goes on: 2 of a line, 3 of a parabola
  /// @param within        how near it must lie
  /// @param within_noise  or how near, in the unit of the column, were there no noise on what the others tell
  template <std::size_t through>
  static bool continues(const OrderedSamples& samples, std::size_t i, double within, double within_noise) {
    // Whether a sample lies where those one step on, two steps on, ... predict.
    const auto is_on = [&](std::size_t k, std::ptrdiff_t step) {
      std::array<std::ptrdiff_t, through> steps{};
      std::array<double, through> where{};
      for (std::size_t j = 0; j < through; ++j) {
        steps[j] = step * static_cast<std::ptrdiff_t>(j + 1);
        where[j] = samples.at[k + static_cast<std::size_t>(steps[j])] - samples.at[k];
      }
      const auto weights = weights_at_zero(where);
      const double squares = std::inner_product(weights.begin(), weights.end(), weights.begin(), 1.0);
      return std::abs(samples.off(k, steps)) < std::max(within, within_noise * std::sqrt(squares));
    };
    constexpr std::size_t needed = through + 1;
    return (i >= needed && is_on(i - needed, 1) && is_on(i, -1)) ||
           (i + needed < samples.size() && is_on(i + needed, -1) && is_on(i, 1));
  }

  static constexpr MaskThresholds limit_{};
  static constexpr std::array<Stencil, 6> stencils_{
      {{2, 1, 5.0}, {3, 3, 6.0}, {4, 3, 5.0}, {5, 5, 5.0}, {4, 5, 6.0}, {5, 7, 6.0}}};
  double noise_;
  double least_;  // that a sample lies off its four neighbours
};

/// Finds spikes in one column.
class Spikes {
public:
  /// @param values  of the column, NaN where missing; they outlive this
  /// @param runs    inside which rows follow on each other; they, too
  /// @param scale   noise scale of the column (white_scale())
  /// @param quantum of the column
  /// @param position_step  quantum and noise of the column that this one is the rate of, where there is one
  Spikes(const Eigen::VectorXd& values, const std::vector<RunSpan>& runs, const ColumnTraits& traits,
         double scale, double quantum, double position_step)
      : values_(values),
        runs_(runs),
        traits_(traits),
        quantum_(quantum),
        scale_(scale),
        position_step_(position_step),
        motion_(values, traits.t_s, runs, std::max(quantum, repeated_step(values, few_digits_))),
        median_confirmed_(confirmed(limit_.spike_scales * scale)),
        motion_confirmed_(confirmed(limit_.spike_scales * motion_.noise())) {}

  /// Isolated samples, or two of five, that lie far from all around them.
  RowMask find() const {
    Eigen::VectorXd values = values_;
    RowMask mask(static_cast<std::size_t>(values.size()), 0);
    for (int pass = 0; pass < 4; ++pass) {  // a tenth of bad rows puts three of five together now and then
      RowMask found(mask.size(), 0);
      for (const RunSpan& run : runs_) spikes_of(values, run, found);
      if (!any_of(found)) break;
      take_away(values, found);
      add_to(mask, found);
    }
    return mask;
  }

private:
  static double median_of_five(double a, double b, double c, double d, double e) {
    std::array<double, 5> five{a, b, c, d, e};
    std::sort(five.begin(), five.end());
    return five[2];
  }

  void spikes_of(const Eigen::VectorXd& values, const RunSpan& run, RowMask& mask) const {
    const OrderedSamples samples(values, traits_.t_s, run);
    const std::size_t count = samples.size();
    if (count < 7) return;
    std::vector<double> far(count, 0.0);
    far_from_the_median(values, run, samples, far);
    if (traits_.cannot_jump) far_from_the_beginning(samples, far);
    far_from_the_motion(values, run, samples, far);
    // Next to a spike its neighbours lie far, too: the farthest first, the others are looked at again without it.
    for (std::size_t i = 0; i < count; ++i) {
      if (!(far[i] > 0.0)) continue;
      if (dies_away(samples, i)) {
        far[i] = 0.0;
        continue;
      }
      double farthest = 0.0;
      for (std::size_t k = i < limit_.drawn_along ? 0 : i - limit_.drawn_along;
           k < std::min(count, i + limit_.drawn_along + 1); ++k)
        farthest = std::max(farthest, far[k]);
      if (far[i] >= limit_.as_far * farthest) mask[static_cast<std::size_t>(samples.rows[i])] = 1;
    }
  }

  /// Whether a sample is one of those in which a push dies away: each strays to the same side, by less than the one
  /// before it. A joint that breaks away leaps and slows down within a few rows, and so does the current that sets
  /// a motor going.
  bool dies_away(const OrderedSamples& samples, std::size_t i) const {
    constexpr std::size_t lasts = 3, level_after = 6;
    constexpr double least_share = 0.15, clearly = 4.0;  // of the one before; noise scales and quanta
    const std::vector<double>& at = samples.values;
    const double least = clearly * std::max(scale_, quantum_);
    for (std::size_t first = i < lasts - 1 ? 0 : i - (lasts - 1); first <= i; ++first) {
      if (first + level_after >= at.size()) return false;
      const double level = at[first + level_after], leap = std::abs(at[first] - level);
      // Before the leap it was where it comes to again.
      if (first == 0 ? !traits_.begins_with_a_step : std::abs(at[first - 1] - level) > least_share * leap)
        continue;
      bool dies = true;
      for (std::size_t k = first; k < first + lasts && dies; ++k) {
        const double off = at[k] - level, next = at[k + 1] - level;
        dies = off * next > 0.0 && std::abs(next) > least_share * std::abs(off) &&
               std::abs(next) < (1.0 - least_share) * std::abs(off) &&
               (k + 1 == first + lasts || std::abs(next) > least);
      }
      if (dies) return true;
    }
    return false;
  }

  /// Raises how far samples lie to how far they lie from their neighbours' motion, where their rate, or their
  /// angle, does not bear them out.
  void far_from_the_motion(const Eigen::VectorXd& values, const RunSpan& run, const OrderedSamples& samples,
                           std::vector<double>& far) const {
    const std::vector<double> off = motion_.off(samples);
    for (std::size_t i = 0; i < off.size(); ++i) {
      if (!(off[i] > far[i])) continue;
      const Eigen::Index row = samples.rows[i];
      if (motion_confirmed_[static_cast<std::size_t>(row)] == 0 && !is_motion(values, run, row, off[i]))
        far[i] = off[i];
    }
  }

  /// Raises how far the first sample of a run lies. A body remembers what it starts from: there less is far than
  /// elsewhere.
  void far_from_the_beginning(const OrderedSamples& samples, std::vector<double>& far) const {
    const double off =
        first_reading_off(samples, std::max(scale_, quantum_ / std::sqrt(12.0)), limit_.first_sds);
    if (off > limit_.quanta * quantum_) far.front() = std::max(far.front(), off);
  }

  /// Sets how far samples lie from the median of five around them, where that is farther than a motion goes.
  void far_from_the_median(const Eigen::VectorXd& values, const RunSpan& run, const OrderedSamples& samples,
                           std::vector<double>& far) const {
    const std::size_t count = samples.size();
    const std::vector<double>& at = samples.values;
    const double least = std::max(limit_.spike_scales * scale_, limit_.quanta * quantum_);
    if (!(least > 0.0)) return;
    std::vector<double> off_median(count);
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t from = i < 2 ? 0 : std::min(i - 2, count - 5);
      off_median[i] =
          std::abs(at[i] - median_of_five(at[from], at[from + 1], at[from + 2], at[from + 3], at[from + 4]));
    }
    for (std::size_t i = 0; i < count; ++i) {
      double off = off_median[i];
      if (!(off > least)) continue;
      // A sample that continues either side in a straight line is the corner of a motion, and not a spike.
      if (i >= 2) off = std::min(off, std::abs(at[i] - 2.0 * at[i - 1] + at[i - 2]));
      if (i + 2 < count) off = std::min(off, std::abs(at[i] - 2.0 * at[i + 1] + at[i + 2]));
      // The top of a fast swing lies far from the median, too, and where rows are lost a straight line does not
      // continue.
      if (i >= 2 && i + 2 < count) off = std::min(off, off_good_neighbours(samples, i));
      // Nothing lies beyond an end, where motions begin, and near it too few bends tell how sharply: there a parabola
      // counts, too.
      if (i <= limit_.bends_around && i + 3 < count)
        off = std::min(off, std::abs(at[i] - 3.0 * at[i + 1] + 3.0 * at[i + 2] - at[i + 3]));
      if (i + limit_.bends_around + 1 >= count && i >= 3)
        off = std::min(off, std::abs(at[i] - 3.0 * at[i - 1] + 3.0 * at[i - 2] - at[i - 3]));
      if (!(off > least) || median_confirmed_[static_cast<std::size_t>(samples.rows[i])] != 0 ||
          is_motion(values, run, samples.rows[i], off))
        continue;
      // So many that another spike among them does not move the median.
      std::vector<double> bends;
      for (std::size_t k = i < limit_.bends_around + 1 ? 1 : i - limit_.bends_around;
           k < std::min(count - 1, i + limit_.bends_around + 1); ++k)
        if (k + 1 < i || k > i + 1) bends.push_back(std::abs(at[k - 1] - 2.0 * at[k] + at[k + 1]));
      if (off > limit_.spike_bends * median_of(bends)) far[i] = off;
    }
  }

  /// Which rows a rate and its angle agree about. @param off  how far a sample must stand out that is looked at
  RowMask confirmed(double off) const {
    assert(runs_.empty() || runs_.back().end <= values_.size());
    RowMask mask(static_cast<std::size_t>(values_.size()), 0);
    for (const RunSpan& run : runs_)
      for (Eigen::Index i = run.begin; i < run.end; ++i)
        mask[static_cast<std::size_t>(i)] = is_motion(values_, run, i, off) ? 1 : 0;
    return mask;
  }

  /// Whether an angle that stands out by `off` is where its rate takes it, or a rate what its angle moves by; at
  /// the ends of a run seen from one side.
  bool is_motion(const Eigen::VectorXd& values, const RunSpan& run, Eigen::Index row, double off) const {
    if (traits_.t_s == nullptr || run.size() < 3) return false;
    const Eigen::VectorXd& t_s = *traits_.t_s;
    const Eigen::Index from = std::max(run.begin, row - 1), to = std::min(run.end - 1, row + 1);
    if (traits_.integral != nullptr) {
      const Eigen::VectorXd& position = *traits_.integral;
      const double moved = (position[to] - position[from]) / (t_s[to] - t_s[from]);
      // By Simpson's rule, in which the middle has two thirds: a trapezoid cuts off the top of a short push.
      const bool is_inside = to - from == 2;
      const double share = is_inside ? 2.0 / 3.0 : 0.5;
      const double within = share * (is_inside ? limit_.confirmed : limit_.confirmed_at_end) * off;
      // An angle whose own noise is a rate of that size confirms nothing; where it does not deny it, a run begins
      // at rest.
      const double noise = std::sqrt(2.0) * position_step_ / (t_s[to] - t_s[from]);
      const bool may_rest = !is_inside && std::abs(values[row]) < limit_.spike_scales * scale_;
      if (noise > within / 3.0 && !may_rest) return false;
      const double mean = share * values[row] + (is_inside ? (values[from] + values[to]) / 6.0
                                                           : 0.5 * values[from == row ? to : from]);
      return std::abs(mean - moved) < within + (may_rest ? 3.0 * noise : 0.0);
    }
    if (traits_.at_rest == nullptr) return false;
    const Eigen::VectorXd& rate = *traits_.at_rest;
    for (Eigen::Index k = from; k < to; ++k) {
      const double step = 0.5 * (rate[k] + rate[k + 1]) * (t_s[k + 1] - t_s[k]);
      if (!(std::abs(values[k + 1] - values[k] - step) < limit_.confirmed * off)) return false;
    }
    return true;
  }

  static constexpr MaskThresholds limit_{};
  static constexpr double few_digits_ = 0.01;  // 360/16384 deg with four decimals comes as 0.0219 and 0.0220
  const Eigen::VectorXd& values_;
  const std::vector<RunSpan>& runs_;
  ColumnTraits traits_;
  double quantum_, scale_, position_step_;
  MotionSpikes motion_;
  // Rows that a rate and its angle agree about, while all neighbours are still there: without them motion would
  // look like a spike.
  RowMask median_confirmed_, motion_confirmed_;
};

}  // namespace thermopower::gap::engine
