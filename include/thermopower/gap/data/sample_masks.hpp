// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/finding_list.hpp>
#include <thermopower/gap/data/neighbour_motion.hpp>
#include <thermopower/gap/data/robust.hpp>
#include <thermopower/gap/data/thresholds.hpp>
#include <thermopower/gap/rule.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

/// @file sample_masks.hpp
/// Samples of one column that are not to be believed, by the column itself and by the one that belongs to it (a rate and its
/// angle). A mask needs a jump that no motion and no heat makes: a joint at rest, a reading that flickers by a quantum, a peak that
/// decays and a break-away are all believed. Every threshold is a multiple of a median, so that a tenth of the rows may be bad.

namespace thermopower::gap::engine {

/// Properties of a column that its masks depend on.
struct ColumnTraits {
  bool cannot_jump = false;   ///< a temperature: what jumps away and back was never there
  bool zero_is_rest = false;  ///< an exact 0 is what a good sensor reads at rest
  bool is_driven =
      false;  ///< a current, in runs of one power each: it may begin with a peak, but with no spike
  const Eigen::VectorXd* rate = nullptr;   ///< of an angle, where one was recorded
  const Eigen::VectorXd* angle = nullptr;  ///< of a rate, where one was recorded
  const Eigen::VectorXd* t_s = nullptr;    ///< stamps, where there is a rate or an angle
};

/// Makes samples of a column missing. @param mask  which; empty: none
inline void take_away(Eigen::VectorXd& values, const RowMask& mask) {
  for (std::size_t i = 0; i < mask.size(); ++i)
    if (mask[i] != 0) values[static_cast<Eigen::Index>(i)] = missing;
}

/// The largest or the least value of a column.
struct Extreme {
  double value = 0.0;         ///< itself
  double next = 0.0;          ///< the value next to it; itself where there is no other one
  std::ptrdiff_t count = 0;   ///< samples that have it
  std::ptrdiff_t beside = 0;  ///< samples that have the value next to it
};

/// The largest value of a column, or the least. @param samples  at least one
inline Extreme extreme_of(const std::vector<double>& samples, bool top) {
  const auto is_beyond = [top](double one, double other) { return top ? one > other : one < other; };
  Extreme one{samples.front(), samples.front()};
  for (const double sample : samples)
    if (is_beyond(sample, one.value)) one.value = sample;
  one.next = one.value;
  for (const double sample : samples)
    if (sample != one.value && (one.next == one.value || is_beyond(sample, one.next))) one.next = sample;
  one.count = std::count(samples.begin(), samples.end(), one.value);
  one.beside = std::count(samples.begin(), samples.end(), one.next);
  return one;
}

/// Finds bad samples in one column. Masks are made one after the other; a later one does not see what an earlier one took.
class SampleMasks {
public:
  /// @param values  of the column, NaN where missing
  /// @param runs    inside which rows follow on each other; they outlive this object
  SampleMasks(const Eigen::VectorXd& values, const std::vector<RunSpan>& runs,
              const ColumnTraits& traits = {})
      : recorded_(values), values_(values), runs_(runs), traits_(traits), quantum_(quantum_of(values)) {
    std::vector<double> steps = step_sizes(values, runs);
    equal_share_ = equal_share_of(steps);
    scale_ = white_scale(values, runs);
    jump_ = std::max({limit_.jump_scales * scale_, limit_.jump_steps * quantile_of(steps, 0.75),
                      limit_.quanta * quantum_});
    std::vector<double> list = finite_samples(values);
    range_ = quantile_of(list, 0.95) - quantile_of(list, 0.05);
  }

  /// Noise scale of the column.
  double scale() const { return scale_; }
  /// Share of neighbours with the same value.
  double equal_share() const { return equal_share_; }
  /// Takes samples away that are set in a mask.
  void take(const RowMask& mask) { take_away(values_, mask); }

  /// Isolated samples far from all around them.
  RowMask spikes() {
    RowMask mask = none();
    if (!holds(Rule::outlier_rejection)) return mask;
    constexpr int passes = 4;  // next to a farther one a spike does not stand out
    for (int pass = 0; pass < passes; ++pass) {
      RowMask found = none();
      for (const RunSpan& run : runs_) find_spikes(run, found);
      if (std::find(found.begin(), found.end(), 1) == found.end()) break;
      for (std::size_t i = 0; i < mask.size(); ++i) mask[i] |= found[i];
      take(found);
    }
    return mask;
  }

  /// Stretches that jump away and back by the same: a default reading of a temperature, a word that wraps.
  RowMask bursts() {
    RowMask mask = none();
    if (!holds(Rule::outlier_rejection) || !(jump_ > 0.0)) return mask;
    const double least = traits_.cannot_jump ? jump_ : std::max(jump_, limit_.far_outside * range_);
    for (const RunSpan& run : runs_) {
      const std::vector<Eigen::Index> rows = finite_rows(run);
      for (std::size_t i = 1; i < rows.size(); ++i) {
        const double level = values_[rows[i - 1]], jump = values_[rows[i]] - level;
        if (!(std::abs(jump) > least)) continue;
        const auto off = [&](std::size_t k) { return (values_[rows[k]] - level) / jump; };
        std::size_t end = i;
        bool stuck = true;
        const auto longest = [&] {
          return static_cast<std::size_t>(stuck ? limit_.longest_stuck : limit_.longest_burst);
        };
        while (end < rows.size() && std::abs(off(end) - 1.0) < limit_.same_jump && end - i <= longest()) {
          stuck = stuck && values_[rows[end]] == values_[rows[i]];
          ++end;
        }
        if (end == rows.size() || end - i > longest() || !(std::abs(off(end)) < limit_.same_jump)) continue;
        for (std::size_t k = i; k < end; ++k) mask[static_cast<std::size_t>(rows[k])] = 1;
        i = end;
      }
    }
    take(mask);
    return mask;
  }

  /// Stretches of one value after which the column jumps, and stays: it had stopped meanwhile. All but their first row.
  RowMask frozen() {
    RowMask mask = none();
    const double rest_share = traits_.cannot_jump ? equal_at_rest() : 1.0;
    // What may jump, and mostly stands, is set rather than measured.
    if (!traits_.cannot_jump && !(equal_share_ < limit_.mostly_equal)) return mask;
    for (const RunSpan& run : runs_) {
      const std::vector<Eigen::Index> rows = finite_rows(run);
      for (std::size_t begin = 0; begin < rows.size();) {
        std::size_t end = begin + 1;
        while (end < rows.size() && values_[rows[end]] == values_[rows[begin]]) ++end;
        if (is_frozen(rows, begin, end) || stands_longer(end - begin, rest_share))
          for (std::size_t k = begin + 1; k < end; ++k) mask[static_cast<std::size_t>(rows[k])] = 1;
        begin = end;
      }
    }
    take(mask);
    return mask;
  }

  /// Samples at the end of the sensor's range: far more stand there than next to it, though noise or motion would show. A range
  /// ends at the same magnitude on both sides: where one end is proven, the other is, too.
  RowMask clipped() {
    RowMask mask = none();
    const std::vector<double> list = finite_samples(values_);
    constexpr std::size_t enough = 50;
    if (!holds(Rule::clipping) || list.size() < enough) return mask;
    const std::array<Extreme, 2> ends{extreme_of(list, true), extreme_of(list, false)};
    const bool is_mirrored = ends[0].value == -ends[1].value;
    const std::array<bool, 2> proven{is_clipped(ends[0]), is_clipped(ends[1])};
    for (std::size_t k = 0; k < 2; ++k) {
      if (!proven[k] && !(is_mirrored && proven[1 - k])) continue;
      for (Eigen::Index i = 0; i < values_.size(); ++i)
        if (values_[i] == ends[k].value) mask[static_cast<std::size_t>(i)] = 1;
    }
    take(mask);
    return mask;
  }

private:
  RowMask none() const { return RowMask(static_cast<std::size_t>(values_.size()), 0); }

  std::vector<Eigen::Index> finite_rows(const RunSpan& run) const {
    std::vector<Eigen::Index> rows;
    for (Eigen::Index i = run.begin; i < run.end; ++i)
      if (std::isfinite(values_[i])) rows.push_back(i);
    return rows;
  }

  void find_spikes(const RunSpan& run, RowMask& mask) const {
    constexpr std::size_t around = 5, nearby = 3, least_samples = 7;
    const OrderedSamples samples(values_, traits_.t_s, run);
    const std::vector<double>& at = samples.values;
    const std::size_t count = samples.size();
    const double least = std::max(limit_.spike_scales * scale_, limit_.quanta * quantum_);
    if (count < least_samples || !(least > 0.0)) return;
    std::vector<double> far(count, 0.0);
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t from = i < 2 ? 0 : std::min(i - 2, count - 5);
      std::array<double, 5> five{};
      std::copy_n(at.begin() + static_cast<std::ptrdiff_t>(from), 5, five.begin());
      std::nth_element(five.begin(), five.begin() + 2, five.end());
      double off = std::abs(at[i] - five[2]);
      if (!(off > least)) continue;
      // The corner of a motion goes on in a straight line on either side; the top of a swing lies on a cubic; near an end, where
      // motions begin, a parabola counts, too.
      if (i >= 2) off = std::min(off, std::abs(at[i] - 2.0 * at[i - 1] + at[i - 2]));
      if (i + 2 < count) off = std::min(off, std::abs(at[i] - 2.0 * at[i + 1] + at[i + 2]));
      if (i >= 2 && i + 2 < count) off = std::min(off, off_good_neighbours(samples, i));
      if (i <= around && i + 3 < count)
        off = std::min(off, std::abs(at[i] - 3.0 * at[i + 1] + 3.0 * at[i + 2] - at[i + 3]));
      if (i + around + 1 >= count && i >= 3)
        off = std::min(off, std::abs(at[i] - 3.0 * at[i - 1] + 3.0 * at[i - 2] - at[i - 3]));
      if (!(off > least) || is_motion(run, samples.rows[i], off) || is_on_its_way(at, i)) continue;
      std::vector<double> bends;
      for (std::size_t k = i < around + 1 ? 1 : i - around; k < std::min(count - 1, i + around + 1); ++k)
        if (k + 1 < i || k > i + 1) bends.push_back(std::abs(at[k - 1] - 2.0 * at[k] + at[k + 1]));
      if (off > limit_.spike_bends * median_of(bends)) far[i] = off;
    }
    for (std::size_t i = 0; i < count; ++i) {
      if (!(far[i] > 0.0)) continue;
      const auto first = far.begin() + static_cast<std::ptrdiff_t>(i < nearby ? 0 : i - nearby),
                 last = far.begin() + static_cast<std::ptrdiff_t>(std::min(count, i + nearby + 1));
      if (far[i] >= limit_.as_far * *std::max_element(first, last))
        mask[static_cast<std::size_t>(samples.rows[i])] = 1;
    }
  }

  /// Whether a sample lies between its neighbours, or begins, or ends, something that lasts: the two beside it on one side have
  /// left the level of the other side the same way. The peak of a current that starts to flow, and a break-away, are such. What
  /// may jump may do so before its first row, too, and after its last.
  bool is_on_its_way(const std::vector<double>& at, std::size_t i) const {
    if (i + 1 == at.size() || (i == 0 && !traits_.is_driven)) return !traits_.cannot_jump;
    if (i > 0 && (at[i - 1] - at[i]) * (at[i] - at[i + 1]) > 0.0) return true;
    if ((i > 0 && i < 2) || i + 4 >= at.size()) return false;
    const auto lasts = [&](double level, double next, double second) {
      const double peak = std::abs(at[i] - level), sign = at[i] > level ? 1.0 : -1.0;
      const double a = sign * (next - level), b = sign * (second - level);
      return b < limit_.falls_to * a && a > limit_.decays_to * peak &&
             b > std::max(limit_.peak_scales * scale_, limit_.goes_on * peak);
    };
    if (i == 0) return lasts(at[i + 4], at[i + 1], at[i + 2]);
    return lasts(at[i - 1], at[i + 1], at[i + 2]) || lasts(at[i + 1], at[i - 1], at[i - 2]);
  }

  /// Whether an angle that stands out by `off` is where its rate takes it, or a rate what its angle moves by; at the ends of a
  /// run seen from one side.
  bool is_motion(const RunSpan& run, Eigen::Index row, double off) const {
    if (traits_.t_s == nullptr || run.size() < 3) return false;
    const Eigen::VectorXd &t_s = *traits_.t_s, &values = recorded_;
    const Eigen::Index from = std::max(run.begin, row - 1), to = std::min(run.end - 1, row + 1);
    if (traits_.angle != nullptr) {
      const Eigen::VectorXd& angle = *traits_.angle;
      const double moved = (angle[to] - angle[from]) / (t_s[to] - t_s[from]);
      // By Simpson's rule, in which the middle has two thirds: a trapezoid cuts off the top of a short push.
      const bool is_inside = to - from == 2;
      const double share = is_inside ? 2.0 / 3.0 : 0.5, within = share * limit_.confirmed * off;
      if (std::sqrt(2.0) * angle_noise() / (t_s[to] - t_s[from]) > within / 3.0) return false;
      const double beside =
          is_inside ? (values[from] + values[to]) / 6.0 : 0.5 * values[from == row ? to : from];
      return std::abs(share * values[row] + beside - moved) < within;
    }
    if (traits_.rate == nullptr) return false;
    const Eigen::VectorXd& rate = *traits_.rate;
    for (Eigen::Index k = from; k < to; ++k) {
      const double step = 0.5 * (rate[k] + rate[k + 1]) * (t_s[k + 1] - t_s[k]);
      if (!(std::abs(values[k + 1] - values[k] - step) < limit_.confirmed * off)) return false;
    }
    return true;
  }

  double angle_noise() const {
    if (angle_noise_ < 0.0) angle_noise_ = quantum_of(*traits_.angle) + white_scale(*traits_.angle, runs_);
    return angle_noise_;
  }

  /// How often a temperature that rests reads the same twice: never less often while it moves. 1 where its noise is less than a
  /// quantum: then it stands between two steps for as long as it likes.
  double equal_at_rest() const {
    constexpr std::size_t around =
        6;  // samples before and after, over which one that rests moves by a quantum at most
    double still = 0.0, equal = 0.0, moves = 0.0, wide = 0.0;
    for (const RunSpan& run : runs_) {
      const std::vector<Eigen::Index> rows = finite_rows(run);
      for (std::size_t k = around; k + around < rows.size(); ++k) {
        const double step = std::abs(values_[rows[k]] - values_[rows[k - 1]]);
        moves += step > 0.0 ? 1.0 : 0.0;
        wide += step > 1.5 * quantum_ ? 1.0 : 0.0;
        if (std::abs(values_[rows[k + around]] - values_[rows[k - around]]) > 1.5 * quantum_) continue;
        still += 1.0;
        equal += step == 0.0 ? 1.0 : 0.0;
      }
    }
    return wide < limit_.wide_steps * moves ? 1.0 : (equal + 1.0) / (still + 1.0);
  }

  /// Whether so many samples of one value are more than a rest makes.
  static bool stands_longer(std::size_t samples, double rest_share) {
    return static_cast<Eigen::Index>(samples) >= limit_.least_frozen &&
           -std::log(rest_share) * static_cast<double>(samples - 1) > limit_.log_chance;
  }

  bool is_frozen(const std::vector<Eigen::Index>& rows, std::size_t begin, std::size_t end) const {
    const auto length = static_cast<Eigen::Index>(end - begin);
    if (length < limit_.least_frozen || end == rows.size()) return false;
    const double value = values_[rows[begin]], jump = values_[rows[end]] - value;
    constexpr double least_share = 1e-4;
    if (-std::log(std::max(equal_share_, least_share)) * static_cast<double>(length - 1) < limit_.log_chance)
      return false;
    if (!(std::abs(jump) > jump_) || (traits_.zero_is_rest && value == 0.0)) return false;
    // What breaks away goes on as it began; what has stopped goes on from elsewhere.
    constexpr std::size_t after = 3;
    double next = 0.0;
    for (std::size_t k = end + 1; k < std::min(rows.size(), end + 1 + after); ++k) {
      if (std::abs(values_[rows[k]] - value) < 0.5 * std::abs(jump)) return false;
      next = std::max(next, std::abs(values_[rows[k]] - values_[rows[k - 1]]));
    }
    return std::abs(jump) > static_cast<double>(after) * next;
  }

  bool is_clipped(const Extreme& one) const {
    if (one.value == 0.0 || one.count < limit_.least_clipped ||
        static_cast<double>(one.count) < limit_.clip_ratio * static_cast<double>(one.beside))
      return false;
    const Eigen::VectorXd others = (values_.array() == one.value).select(missing, values_);
    if (is_between_steps(others, one)) return true;  // no converter reads that: a limit is set
    // What stands still by itself stands where it likes; a column whose noise shows everywhere else is cut off where it does not.
    // A temperature may have come to rest there, unless noise of many steps shows everywhere else.
    const bool may_rest =
        traits_.cannot_jump && !(white_scale(others, runs_) > limit_.quanta * quantum_of(others));
    const double usually = may_rest ? equal_share_ : equal_share_of(step_sizes(others, runs_));
    const bool is_witnessed = traits_.rate != nullptr || traits_.angle != nullptr;
    if (usually < limit_.hardly_equal && (!is_witnessed || scale_ > limit_.quanta * quantum_)) return true;
    return 2 * moves_at(one.value) >= one.count;
  }

  /// Whether an extreme is none of the values that the other samples, in steps of a quantum, take.
  bool is_between_steps(Eigen::VectorXd others, const Extreme& one) const {
    constexpr double on = 0.05, off = 0.02,
                     times = 3.0;  // of a step; of a step; of how far nearly all others are off
    others =
        (others.array() == -one.value).select(missing, others);  // the other end of the range is off, too
    double quantum = quantum_of(others);
    if (!(quantum > 0.0)) return false;
    // Many steps tell a step to more digits than were logged of it: some first, which the logged digits count safely.
    for (const double most : {50.0 * quantum, 1e300}) {
      double farthest = 0.0;
      for (const double other : others)
        if (std::abs(other - one.next) < most) farthest = std::max(farthest, std::abs(other - one.next));
      const double steps = std::round(farthest / quantum);
      if (steps > 0.0) quantum = farthest / steps;
    }
    const auto stray = [&](double value) {
      const double steps = (value - one.next) / quantum;
      return std::abs(steps - std::round(steps));
    };
    std::vector<double> list = finite_samples(others);
    for (double& value : list) value = stray(value);
    const double usual = quantile_of(list, 0.95);
    return usual < on && stray(one.value) > std::max(off, times * usual);
  }

  /// How many samples of a value the column's companion denies: the rate of an angle turns there, or the angle of a rate goes
  /// on by something else.
  std::ptrdiff_t moves_at(double value) const {
    std::ptrdiff_t count = 0;
    std::vector<double> rates =
        traits_.rate != nullptr ? finite_samples(traits_.rate->cwiseAbs()) : std::vector<double>();
    constexpr double rest = 0.05;  // of what a rate reaches
    const double coarse = traits_.rate != nullptr ? 2.0 * quantum_of(*traits_.rate) : 0.0,
                 moving = std::max(rest * quantile_of(rates, 0.9), coarse);
    for (const RunSpan& run : runs_)
      for (Eigen::Index i = run.begin + 1; i + 1 < run.end; ++i) {
        if (values_[i] != value) continue;
        if (traits_.rate != nullptr) count += std::abs((*traits_.rate)[i]) > moving ? 1 : 0;
        if (traits_.angle == nullptr) continue;
        const double lasts_s = (*traits_.t_s)[i + 1] - (*traits_.t_s)[i - 1],
                     moved = ((*traits_.angle)[i + 1] - (*traits_.angle)[i - 1]) / lasts_s;
        count +=
            std::abs(moved) > std::abs(value) + limit_.quanta * (quantum_ + angle_noise() / lasts_s) ? 1 : 0;
      }
    return count;
  }

  static constexpr const DataThresholds& limit_ = data_limits;
  const Eigen::VectorXd recorded_;  // without it a spike's neighbours would lose what confirms them
  Eigen::VectorXd values_;
  const std::vector<RunSpan>& runs_;
  ColumnTraits traits_;
  double quantum_ = 0.0, scale_ = 0.0, jump_ = 0.0, range_ = 0.0, equal_share_ = 0.0;
  mutable double angle_noise_ = -1.0;
};

/// Rows that repeat all outputs of the row before them, where two outputs at least hardly ever do so, and chance would make a
/// third of them at most: a logger wrote a frame again. A rest, of which an output reads an exact 0, is none.
inline RowMask repeated_frames(const std::vector<const Eigen::VectorXd*>& all, Eigen::Index rows,
                               const std::vector<RunSpan>& runs) {
  constexpr std::size_t enough = 2;
  constexpr double least = 3.0;  // times as many as by chance
  RowMask mask(static_cast<std::size_t>(rows), 0);
  std::vector<const Eigen::VectorXd*> outputs;
  double by_chance = static_cast<double>(rows), count = 0.0;
  for (const Eigen::VectorXd* one : all) {
    // At the end of its range a column stands for another reason.
    const double least_value = one->redux([](double a, double b) { return std::fmin(a, b); }),
                 most_value = one->redux([](double a, double b) { return std::fmax(a, b); });
    const Eigen::VectorXd inside =
        (one->array() == least_value || one->array() == most_value).select(missing, *one);
    const double share = equal_share_of(step_sizes(inside, runs));
    if (!(share < data_limits.hardly_equal)) continue;
    outputs.push_back(one);
    by_chance *= share;
  }
  if (outputs.size() < enough) return mask;
  const auto repeats = [&](Eigen::Index i) {
    bool any = false;
    for (const Eigen::VectorXd* one : outputs) {
      if ((*one)[i] == 0.0 || (std::isfinite((*one)[i]) && (*one)[i] != (*one)[i - 1])) return false;
      any = any || std::isfinite((*one)[i]);
    }
    return any;
  };
  for (const RunSpan& run : runs)
    for (Eigen::Index i = run.begin + 1; i < run.end; ++i) {
      Eigen::Index end = i;
      while (end < run.end && repeats(end)) ++end;
      count += static_cast<double>(end - i);
      if (end - i <= data_limits.longest_repeat) std::fill(mask.begin() + i, mask.begin() + end, 1);
      i = std::max(i, end);
    }
  if (count < least * by_chance) mask.assign(mask.size(), 0);
  return mask;
}

}  // namespace thermopower::gap::engine
