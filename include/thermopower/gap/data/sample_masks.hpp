// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/finding_list.hpp>
#include <thermopower/gap/data/mask_thresholds.hpp>
#include <thermopower/gap/data/robust.hpp>
#include <thermopower/gap/data/spikes.hpp>
#include <thermopower/gap/rule.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

/// @file sample_masks.hpp
/// Samples of one column that are not to be believed: spikes, stretches that jump away and back, frozen and clipped
/// stretches. Every threshold is a multiple of a median, so that a tenth of the rows may be bad.

namespace thermopower::gap::engine {

/// Exact zeros of the current at a power at which current flows otherwise.
inline RowMask lost_current(const Eigen::VectorXd& current_A, const Eigen::VectorXd& power, double scale_A) {
  constexpr double clearly = 10.0, mostly = 0.5;  // noise scales of a current that flows; share of its rows
  constexpr std::size_t bands = 26;               // of ten counts
  const auto band = [](double counts) {
    return static_cast<std::size_t>(std::clamp(counts / 10.0, 0.0, bands - 1.0));
  };
  std::array<std::vector<double>, bands> read;
  for (Eigen::Index i = 0; i < current_A.size(); ++i)
    if (power[i] > 0.0 && std::isfinite(current_A[i])) read[band(power[i])].push_back(current_A[i]);
  std::array<bool, bands> flows{};
  for (std::size_t k = 0; k < bands; ++k)
    flows[k] = equal_share_of(read[k]) <= mostly &&
               std::abs(quantile_of(read[k], 0.25)) > clearly * std::max(scale_A, 1e-12);
  RowMask mask(static_cast<std::size_t>(current_A.size()), 0);
  for (Eigen::Index i = 0; i < current_A.size(); ++i)
    if (power[i] > 0.0 && current_A[i] == 0.0 && flows[band(power[i])]) mask[static_cast<std::size_t>(i)] = 1;
  return mask;
}

/// Finds bad samples in one column. Masks are made one after the other; a later one does not see what an earlier
/// one took.
class SampleMasks {
public:
  /// @param values  of the column, NaN where missing
  /// @param runs    inside which rows follow on each other
  SampleMasks(const Eigen::VectorXd& values, const std::vector<RunSpan>& runs,
              const ColumnTraits& traits = {})
      : values_(values), runs_(runs), traits_(traits), quantum_(quantum_of(values)) {
    std::vector<double> steps = step_sizes(values, runs);
    equal_share_ = equal_share_of(steps);
    scale_ = white_scale(values, runs);
    usual_step_ = quantile_of(steps, 0.75);
    if (const Eigen::VectorXd* const other = traits.at_rest != nullptr ? traits.at_rest : traits.integral)
      other_equal_share_ = equal_share_of(step_sizes(*other, runs));
    if (traits.at_rest != nullptr) {
      constexpr double rest_share = 0.05,  // of the rate's 90th percentile
          rest_steps = 2.0;                // of a coarse rate, which may be off by one
      std::vector<double> rates = finite_samples(traits.at_rest->cwiseAbs());
      rest_rate_ = std::max(rest_share * quantile_of(rates, 0.9), rest_steps * quantum_of(*traits.at_rest));
    }
    if (traits.integral != nullptr)
      position_step_ = quantum_of(*traits.integral) + white_scale(*traits.integral, runs);
  }

  /// Noise scale of the column.
  double scale() const { return scale_; }
  /// Share of neighbours with the same value.
  double equal_share() const { return equal_share_; }

  /// Takes samples away that are set in a mask.
  void take(const RowMask& mask) { take_away(values_, mask); }

  /// Isolated samples (one, or two of five) far from all around them.
  RowMask spikes() {
    return taken(Rule::outlier_rejection,
                 Spikes(values_, runs_, traits_, scale_, quantum_, position_step_).find());
  }

  /// Stretches that jump away from the level before them and back to it. A temperature that overshoots
  /// climbs a slope and comes down one: it does neither.
  RowMask bursts() {
    RowMask mask = empty();
    const double least = least_jump();
    std::vector<double> list = finite_samples(values_);
    const double range = middle_range_of(list);
    for (const RunSpan& run : runs_) {
      const std::vector<Eigen::Index> rows = OrderedSamples(values_, nullptr, run).rows;
      for (std::size_t i = 1; i < rows.size(); ++i) {
        const double level = values_[rows[i - 1]], jump = values_[rows[i]] - level;
        if (!(std::abs(jump) > least) || !(least > 0.0) || is_on_a_slope(rows, i)) continue;
        std::size_t end = i;
        bool stuck = true, away = true;
        const auto off = [&](std::size_t k) { return (values_[rows[k]] - level) / jump; };
        const auto is_too_long = [&] {
          return end - i > static_cast<std::size_t>(stuck ? limit_.longest_stuck : limit_.longest_burst);
        };
        for (; end < rows.size() && off(end) > limit_.stayed_away && !is_too_long(); ++end) {
          stuck = stuck && values_[rows[end]] == values_[rows[i]];
          away = away && std::abs(values_[rows[end]] - level) > limit_.outside * range;
        }
        if (end == rows.size() || is_too_long()) continue;
        if (!(off(end) < limit_.came_back) || is_on_a_slope(rows, end)) continue;
        if (!traits_.cannot_jump && !away && !(stuck && end - i > 1 && equal_share_ < limit_.hardly_equal))
          continue;
        if (!traits_.cannot_jump && traits_.zero_is_rest && values_[rows[i]] == 0.0) continue;
        for (std::size_t k = i; k < end; ++k) mask[static_cast<std::size_t>(rows[k])] = 1;
        i = end;
      }
    }
    return taken(Rule::bursts, std::move(mask));
  }

  /// Stretches of one value where noise or motion would show: all but their first row.
  RowMask frozen() {
    RowMask mask = empty();
    quiet_scale_ = quiet_scale();
    for (std::size_t r = 0; r < runs_.size(); ++r) {
      std::vector<Eigen::Index> rows = OrderedSamples(values_, nullptr, runs_[r]).rows;
      // A temperature does not jump while the logger pauses, either.
      while (traits_.cannot_jump && r + 1 < runs_.size() && runs_[r + 1].label == runs_[r].label) {
        const std::vector<Eigen::Index> more = OrderedSamples(values_, nullptr, runs_[++r]).rows;
        rows.insert(rows.end(), more.begin(), more.end());
      }
      for (std::size_t begin = 0; begin < rows.size();) {
        std::size_t end = begin + 1;
        while (end < rows.size() && values_[rows[end]] == values_[rows[begin]]) ++end;
        const bool frozen = is_frozen(rows, begin, end);
        for (std::size_t k = begin + 1; k < end && frozen; ++k) mask[static_cast<std::size_t>(rows[k])] = 1;
        begin = end;
      }
    }
    return taken(Rule::frozen, std::move(mask));
  }

  /// Samples at the largest or the least value, where far more stand there than next to it, or that is none of the
  /// steps the other samples come in.
  RowMask clipped() {
    RowMask mask = empty();
    const std::vector<double> list = finite_samples(values_);
    if (list.size() < 50) return mask;
    for (const Extreme& one : {extreme_of(list, true), extreme_of(list, false)}) {
      if (!is_clipped(one)) continue;
      for (Eigen::Index i = 0; i < values_.size(); ++i)
        if (values_[i] == one.value) mask[static_cast<std::size_t>(i)] = 1;
    }
    return taken(Rule::clipping, std::move(mask));
  }

private:
  RowMask taken(Rule rule, RowMask mask) {
    mask = by(rule, std::move(mask));
    take(mask);
    return mask;
  }

  RowMask empty() const { return RowMask(static_cast<std::size_t>(values_.size()), 0); }

  /// Whether the step to a row is much like the one before it.
  bool is_on_a_slope(const std::vector<Eigen::Index>& rows, std::size_t i) const {
    if (i < 2) return false;
    const double step = values_[rows[i]] - values_[rows[i - 1]],
                 before = values_[rows[i - 1]] - values_[rows[i - 2]];
    return before * step > 0.0 && std::abs(before) > limit_.on_a_slope * std::abs(step);
  }

  /// The least change of the column that may be a jump.
  double least_jump() const {
    return std::max({limit_.jump_scales * scale_, limit_.jump_steps * usual_step_, limit_.quanta * quantum_});
  }

  /// Whether the sensor's range ends at an extreme.
  bool is_clipped(const Extreme& one) const {
    if (one.value == 0.0) return false;
    if (one.count > 1 && is_between_steps(one.value, one.next))
      return true;  // no converter reads that: a limit is set
    // A sensor that has more to tell stays at its end; what returns there for one row at a time is the beat of a
    // clock and a steady motion.
    const bool piles_up =
        one.count >= limit_.least_clipped &&
        static_cast<double>(one.count) >= limit_.clip_ratio * static_cast<double>(one.beside);
    if (!piles_up || !stays_at(one)) return false;
    // A slow signal in coarse steps stands still by itself; but not where another column sees it move.
    const bool is_witnessed = traits_.integral != nullptr || traits_.at_rest != nullptr;
    const bool stands_still = stands_still_besides(one.value);
    if (!is_witnessed && stands_still) return false;
    // One sample tells little: just at the end of its range a sensor is still right. Where noise of
    // many steps shows everywhere else, it would show there, though the axis rests out of range.
    const bool noise_would_show = scale_ > limit_.quanta * quantum_ && !stands_still && !rests_at(one.value);
    return 2 * denied(one.value) >= one.count || noise_would_show;
  }

  /// Whether the rate says that the axis comes to rest, and starts again, wherever the column keeps this value: it
  /// is exactly 0 at most of these rows, and small before and after. The rate of a motion that goes on out of range
  /// is large there.
  bool rests_at(double value) const {
    if (traits_.at_rest == nullptr) return false;
    std::ptrdiff_t still = 0;
    for (const RunSpan& run : runs_)
      for (Eigen::Index row = run.begin; row < run.end; ++row) {
        if (values_[row] != value) continue;
        for (Eigen::Index at = std::max(run.begin, row - 1); at < std::min(run.end, row + 2); ++at)
          if (!resting(at)) return false;
        still += (*traits_.at_rest)[row] == 0.0 ? 1 : -1;
      }
    return still > 0;
  }

  /// Whether a good part of the samples at an extreme follow on each other.
  bool stays_at(const Extreme& one) const {
    std::ptrdiff_t pairs = 0;
    for_each_in_order<2>(values_, runs_, [&](const Eigen::Index* rows) {
      pairs += values_[rows[0]] == one.value && values_[rows[1]] == one.value ? 1 : 0;
    });
    return limit_.stays_clipped * static_cast<double>(one.count) <= static_cast<double>(pairs);
  }

  Eigen::VectorXd others_than(double value) const {
    return (values_.array() == value).select(missing, values_);
  }

  /// Whether a value is none of those that the other samples, in steps of a quantum, take: off their grid by more
  /// than they are themselves, whose quantum is known to a digit more or less.
  bool is_between_steps(double value, double neighbour) const {
    constexpr double on = 0.05, off = 0.02, times = 3.0,
                     nearly_all = 0.95;  // of a step; of the others' own; of the samples
    Eigen::VectorXd others = others_than(value);
    others = (others.array() == -value)
                 .select(missing, others);  // the other end of the range is off the grid, too
    double quantum = quantum_of(others);
    if (!(quantum > 0.0)) return false;
    // Many steps tell a step to more digits than were logged of it: some first, which the logged digits count safely.
    for (const double most : {50.0 * quantum, 1e300}) {
      double farthest = 0.0;
      for (const double one : others)
        if (std::abs(one - neighbour) < most) farthest = std::max(farthest, std::abs(one - neighbour));
      const double steps = std::round(farthest / quantum);
      if (steps > 0.0) quantum = farthest / steps;
    }
    const auto off_step = [&](double one) {
      const double steps = (one - neighbour) / quantum;
      return std::abs(steps - std::round(steps));
    };
    std::vector<double> stray;
    for (const double one : others)
      if (std::isfinite(one)) stray.push_back(off_step(one));
    const double usual = quantile_of(stray, nearly_all);
    return usual < on && off_step(value) > std::max(off, times * usual);
  }

  /// Whether neighbours are often the same where they do not have this value. A temperature may have come to rest
  /// there: of it all neighbours count, unless noise of many steps shows everywhere else, which it would at rest,
  /// too.
  bool stands_still_besides(double value) const {
    const Eigen::VectorXd others = others_than(value);
    const bool may_rest =
        traits_.cannot_jump && !(white_scale(others, runs_) > limit_.quanta * quantum_of(others));
    return !((may_rest ? equal_share_ : equal_share_of(step_sizes(others, runs_))) < limit_.hardly_equal);
  }

  /// Noise that shows everywhere, where the column moves least, too. A joint that comes to rest without noise
  /// stands as well as a sensor that stopped.
  double quiet_scale() const {
    constexpr Eigen::Index window = 8;
    constexpr double quietest = 0.1;  // of the windows in which it is not all the same
    std::vector<double> scales;
    for (const RunSpan& run : runs_)
      for (Eigen::Index i = run.begin; i + window <= run.end; i += window / 2) {
        const auto part = values_.segment(i, window).array();
        if (!part.isFinite().all() || part.maxCoeff() == part.minCoeff()) continue;
        const auto bends = part.head(window - 2) - 2.0 * part.segment(1, window - 2) + part.tail(window - 2);
        scales.push_back(std::sqrt(bends.square().mean() / 6.0));  // of white noise: 1 + 4 + 1
      }
    return scales.empty() ? scale_ : std::min(scale_, quantile_of(scales, quietest));
  }

  bool resting(Eigen::Index row) const {
    return traits_.at_rest != nullptr && !(std::abs((*traits_.at_rest)[row]) > rest_rate_);
  }

  /// Whether a column that rarely stands stood, too, or was lost, from a row on: then frames were repeated, and it
  /// tells nothing. An exact 0 is a rest.
  bool repeats_too(const Eigen::VectorXd& other, Eigen::Index from, Eigen::Index to) const {
    double stood_at = missing;
    for (Eigen::Index row = from; row <= to; ++row) {
      if (!std::isfinite(other[row])) continue;
      if (other[row] == 0.0 || (std::isfinite(stood_at) && other[row] != stood_at)) return false;
      stood_at = other[row];
    }
    return other_equal_share_ < limit_.rarely_equal;
  }

  /// Whether the column that this one is the rate of moves on by `rate` between two rows: then the rate is right.
  bool moves_on(Eigen::Index from, Eigen::Index to, double rate) const {
    constexpr double off_share = 0.02, quanta = 4.0;
    if (traits_.integral == nullptr) return false;
    const Eigen::VectorXd& position = *traits_.integral;
    const Eigen::VectorXd& t_s = *traits_.t_s;
    const auto off = [&](Eigen::Index row) {
      return std::abs(position[row] - position[from] - rate * (t_s[row] - t_s[from]));
    };
    // The way as a whole, and half of it: a motion there and back ends where it began.
    const Eigen::Index middle = from + (to - from) / 2;
    const double allowed = off_share * std::abs(rate) * (t_s[to] - t_s[from]) + quanta * position_step_;
    return off(to) <= allowed && (!std::isfinite(position[middle]) || off(middle) <= allowed);
  }

  /// Whether the column that this one is the rate of moves by something else than `rate`, though rounded, between
  /// two rows.
  bool moves_otherwise(Eigen::Index from, Eigen::Index to, double rate) const {
    if (traits_.integral == nullptr) return false;
    constexpr double share = 0.1, quanta = 4.0;
    const Eigen::VectorXd& position = *traits_.integral;
    while (from < to && !std::isfinite(position[from])) ++from;
    while (from < to && !std::isfinite(position[to])) --to;
    const double lasts_s = (*traits_.t_s)[to] - (*traits_.t_s)[from];
    const double off = std::abs(position[to] - position[from] - rate * lasts_s);
    return off > (share * std::abs(rate) + quantum_) * lasts_s + quanta * position_step_;
  }

  /// Ways by which a rate says that an angle went over some rows, of all its motions that last: a rate may have spikes.
  struct Ways {
    double all = 0.0;       ///< their sum
    double farthest = 0.0;  ///< the longest, either way
  };

  Ways ways_between(Eigen::Index from, Eigen::Index to) const {
    constexpr Eigen::Index least = 6;  // rows of a motion
    const Eigen::VectorXd &rate = *traits_.at_rest, &t_s = *traits_.t_s;
    Ways ways;
    double part = 0.0;
    Eigen::Index in_a_row = 0;
    for (Eigen::Index row = from; row < to; ++row) {
      const bool moves = !resting(row) && std::isfinite(rate[row]);
      const double way = moves ? rate[row] * (t_s[row + 1] - t_s[row]) : 0.0;
      in_a_row = moves ? in_a_row + 1 : 0;
      part = moves ? part + way : 0.0;
      if (in_a_row < least) continue;
      ways.all += in_a_row == least ? part : way;
      ways.farthest = std::max(ways.farthest, std::abs(part));
    }
    return ways;
  }

  /// Whether an angle that stood from a row on went somewhere meanwhile, though its rate rests for most of the time.
  bool went_somewhere(Eigen::Index from, Eigen::Index to) const {
    constexpr double clearly = 4.0;
    return ways_between(from, to).farthest > clearly * visible_way();
  }

  /// Whether an angle that stood from a row on reads at another one at once, about what its rate says it moved by
  /// meanwhile.
  bool catches_up(Eigen::Index from, Eigen::Index to) const {
    constexpr double at_least = 0.5, at_most = 2.0;
    const double jump = values_[to] - values_[from], all = ways_between(from, to).all;
    return std::abs(all) > visible_way() && jump * all > 0.0 && std::abs(jump) > at_least * std::abs(all) &&
           std::abs(jump) < at_most * std::abs(all);
  }

  /// A motion of an angle that neither its noise nor its steps hide.
  double visible_way() const { return limit_.jump_scales * std::max(scale_, quantum_); }

  /// Whether a temperature stands for longer than it does where it rests, judging by how often it then reads the
  /// same twice, and how rarely it steps as far as it does after that. A slow one in coarse steps does stand, but
  /// its noise shows.
  bool rests_otherwise(const std::vector<Eigen::Index>& rows, std::size_t begin, std::size_t end) const {
    constexpr std::size_t around =
        6;  // samples before and after, over which one that rests moves by a quantum at most
    double still = 0.0, equal = 0.0, as_far = 0.0, steps = 0.0, moves = 0.0, wide = 0.0;
    const double step = end < rows.size() ? std::abs(values_[rows[end]] - values_[rows[begin]]) : 0.0;
    constexpr std::size_t looked_at =
        5000;  // samples before and after: of a million there are stretches in thousands
    const std::size_t first = std::max<std::size_t>(1, begin - std::min(begin, looked_at)),
                      last = std::min(rows.size(), end + looked_at);
    for (std::size_t k = first; k < last; ++k) {
      if (k >= begin && k <= end) continue;
      const double own = std::abs(values_[rows[k]] - values_[rows[k - 1]]);
      steps += 1.0;
      moves += own > 0.0 ? 1.0 : 0.0;
      wide += own > 1.5 * quantum_ ? 1.0 : 0.0;
      as_far += own >= step ? 1.0 : 0.0;
      if (k < around || k + around >= rows.size() || (k + around >= begin && k < end + around)) continue;
      if (std::abs(values_[rows[k + around]] - values_[rows[k - around]]) > 1.5 * quantum_) continue;
      still += 1.0;
      equal += own == 0.0 ? 1.0 : 0.0;
    }
    // A column that only ever goes from one step to the next and back has less noise than a step: between two
    // thresholds it stands.
    const bool is_quiet = wide < limit_.wide_steps * moves;
    const double share = is_quiet ? 1.0 : (equal + 1.0) / (still + 1.0);
    const double far = step > limit_.quanta * quantum_ ? std::log((steps + 1.0) / (as_far + 1.0)) : 0.0;
    return -std::log(share) * static_cast<double>(end - begin - 1) + far > limit_.log_chance;
  }

  /// How many samples of this value no other column bears out: nothing rests there, nor does what this one is the rate
  /// of move on by it, stretch by stretch. (Between two rows a coarse position hardly moves.)
  std::ptrdiff_t denied(double value) const {
    constexpr Eigen::Index around = 3;
    std::ptrdiff_t count = 0;
    for (const RunSpan& run : runs_)
      for_each_stretch(
          run.begin, run.end, [&](Eigen::Index row) { return values_[row] == value; },
          [&](Eigen::Index begin, Eigen::Index end) {
            std::ptrdiff_t moving = 0;
            for (Eigen::Index row = begin; row < end; ++row) moving += resting(row) ? 0 : 1;
            if (!moves_on(std::max(run.begin, begin - around), std::min(run.end - 1, end - 1 + around),
                          value))
              count += moving;
          });
    return count;
  }

  bool is_frozen(const std::vector<Eigen::Index>& rows, std::size_t begin, std::size_t end) const {
    const auto length = static_cast<Eigen::Index>(end - begin);
    if (length < limit_.least_frozen) return false;
    const double value = values_[rows[begin]];
    const double share = std::max(equal_share_, 1e-4);
    const bool improbable = equal_share_ < limit_.rarely_equal &&
                            -std::log(share) * static_cast<double>(length - 1) > limit_.log_chance;
    // An exact 0 is a rest, but of a rate whose angle goes on, and which jumps where it is read again.
    if (traits_.zero_is_rest && value == 0.0)
      return improbable && moves_otherwise(rows[begin], rows[end - 1], value) && end < rows.size() &&
             std::abs(values_[rows[end]]) > limit_.jump_scales * scale_;
    if (traits_.at_rest != nullptr) {
      if (end < rows.size() && catches_up(rows[begin], rows[end])) return true;
      std::size_t moving = 0;
      for (std::size_t k = begin; k < end; ++k) moving += resting(rows[k]) ? 0 : 1;
      if (2 * moving < end - begin && !repeats_too(*traits_.at_rest, rows[begin], rows[end - 1]))
        return went_somewhere(rows[begin], end < rows.size() ? rows[end] : rows[end - 1]);
    }
    if (traits_.integral != nullptr && moves_on(rows[begin], rows[end - 1], value) &&
        !repeats_too(*traits_.integral, rows[begin], rows[end - 1]))
      return false;
    if (improbable && (quantum_ < quiet_scale_ || moves_otherwise(rows[begin], rows[end - 1], value)))
      return true;
    if (traits_.cannot_jump && rests_otherwise(rows, begin, end)) return true;
    // Of a coarse thermometer only a reading that has to catch up tells that it stood. A column
    // that steps, and may step, is held: a current that somebody sets.
    return !is_set() && jumps_after(rows, end);
  }

  /// Whether a column that stood jumps where it goes on, and stays away.
  bool jumps_after(const std::vector<Eigen::Index>& rows, std::size_t end) const {
    if (end == rows.size()) return false;
    const double value = values_[rows[end - 1]], jump = std::abs(values_[rows[end]] - value);
    // A joint that breaks away goes on as it began; a sensor that had stopped goes on from elsewhere.
    constexpr std::size_t after = 3;
    double next = 0.0;
    for (std::size_t k = end + 1; k < std::min(rows.size(), end + 1 + after); ++k)
      next = std::max(next, std::abs(values_[rows[k]] - values_[rows[k - 1]]));
    if (!traits_.cannot_jump && !(jump > static_cast<double>(after) * next)) return false;
    return jump > least_jump() &&
           (end + 1 == rows.size() || std::abs(values_[rows[end + 1]] - value) > limit_.stayed_away * jump);
  }

  /// Whether a column that may jump is constant but for steps: a value that is set, not measured.
  bool is_set() const {
    const bool may_jump = !traits_.cannot_jump && traits_.at_rest == nullptr && traits_.integral == nullptr;
    return may_jump && equal_share_ > limit_.nearly_always_equal;
  }

  static constexpr MaskThresholds limit_{};
  Eigen::VectorXd values_;
  const std::vector<RunSpan>& runs_;
  ColumnTraits traits_;
  double quantum_, scale_, usual_step_, equal_share_;
  double rest_rate_ = 0.0;          // of traits_.at_rest: slower is a rest
  double position_step_ = 0.0;      // quantum and noise of traits_.integral
  double other_equal_share_ = 1.0;  // of either of them: share of neighbours with the same value
  double quiet_scale_ = 0.0;        // while it is asked what is frozen
};

}  // namespace thermopower::gap::engine
