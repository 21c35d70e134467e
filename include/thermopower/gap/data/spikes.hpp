// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/finding_list.hpp>
#include <thermopower/gap/data/first_reading.hpp>
#include <thermopower/gap/data/mask_thresholds.hpp>
#include <thermopower/gap/data/motion_spikes.hpp>
#include <thermopower/gap/data/robust.hpp>

#include <algorithm>
#include <cassert>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

/// @file spikes.hpp
/// Samples of one column that lie far from all around them: from the median of five, or from what the neighbours on either side
/// make of the motion.

namespace thermopower::gap::engine {

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
        position_step_(position_step) {
    constexpr double few_digits = 0.01;  // 360/16384 deg with four decimals comes as 0.0219 and 0.0220
    const double coarsest = std::max(quantum, repeated_step(values, few_digits));
    motion_ = MotionSpikes(values, traits.t_s, runs, coarsest);
    median_confirmed_ = confirmed(values, limit_.spike_scales * scale_);
    motion_confirmed_ = confirmed(values, limit_.spike_scales * motion_.noise());
  }

  /// Isolated samples, or two of five, that lie far from all around them.
  RowMask find() const {
    Eigen::VectorXd values = values_;
    RowMask mask(static_cast<std::size_t>(values.size()), 0);
    for (int pass = 0; pass < 4; ++pass) {  // a tenth of bad rows puts three of five together now and then
      RowMask found(mask.size(), 0);
      for (const RunSpan& run : runs_) spikes_of(values, run, found);
      if (std::find(found.begin(), found.end(), 1) == found.end()) break;
      for (std::size_t i = 0; i < mask.size(); ++i) {
        if (found[i] == 0) continue;
        mask[i] = 1;
        values[static_cast<Eigen::Index>(i)] = missing;
      }
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

  /// Whether a sample is one of those in which a push dies away: each strays to the same side, by less than the one before it. A
  /// joint that breaks away leaps and slows down within a few rows, and so does the current that sets a motor going.
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

  /// Raises how far samples lie to how far they lie from their neighbours' motion, where their rate, or their angle, does not bear
  /// them out.
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

  /// Raises how far the first sample of a run lies. A body remembers what it starts from: there less is far than elsewhere.
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
      // What continues either side in a straight line is the corner of a motion and no spike.
      if (i >= 2) off = std::min(off, std::abs(at[i] - 2.0 * at[i - 1] + at[i - 2]));
      if (i + 2 < count) off = std::min(off, std::abs(at[i] - 2.0 * at[i + 1] + at[i + 2]));
      // The top of a fast swing lies far from the median, too, and where rows are lost a straight line does not continue.
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
  RowMask confirmed(const Eigen::VectorXd& values, double off) const {
    assert(runs_.empty() || runs_.back().end <= values.size());
    RowMask mask(static_cast<std::size_t>(values.size()), 0);
    for (const RunSpan& run : runs_)
      for (Eigen::Index i = run.begin; i < run.end; ++i)
        mask[static_cast<std::size_t>(i)] = is_motion(values, run, i, off) ? 1 : 0;
    return mask;
  }

  /// Whether an angle that stands out by `off` is where its rate takes it, or a rate what its angle moves by; at the ends of a
  /// run seen from one side.
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
      // An angle whose own noise is a rate of that size confirms nothing; where it does not deny it, a run begins at rest.
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
  const Eigen::VectorXd& values_;
  const std::vector<RunSpan>& runs_;
  ColumnTraits traits_;
  double quantum_, scale_, position_step_;
  MotionSpikes motion_;
  // Rows that a rate and its angle agree about, while all neighbours are still there: without them motion would look like a spike.
  RowMask median_confirmed_, motion_confirmed_;
};

}  // namespace thermopower::gap::engine
