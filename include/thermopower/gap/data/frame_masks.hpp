// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/sample_masks.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

/// @file frame_masks.hpp
/// Frames, the rows of all columns together, that are not to be believed: those that repeat the one before them, and
/// those in which the sensors said nothing.

namespace thermopower::gap::engine {

/// Thresholds of the masks of frames.
/// Held by tests/gap/data/check_test.cpp.
struct FrameThresholds {
  Eigen::Index least_defaults =
      3;                    ///< masked samples of one value that make it what a sensor reads by default
  Eigen::Index around = 6;  ///< rows before and after that a repeated one is seen among
  Eigen::Index longest_repeat = 12;  ///< frames in a row that repeat another
  double by_chance = 0.1;            ///< share of the repeated frames that chance may make
  double never_by_chance = 0.01;     ///< repeats of a length that chance may make in a recording
  std::size_t slower_speeds =
      2;  ///< thirds of a doubling by which rows may be slower that tell how often chance repeats
  double least_moving = 100;  ///< such rows; else all tell
  double small_step =
      8.0;  ///< finest steps that are as likely as none, either way, where no one step is often
  double caught_up = 0.6;  ///< of what was missed while a frame was repeated: the step after it
};

/// Whether a column shows that a frame is repeated: it hardly ever reads the same twice in a row, over all rows or
/// over those in which it moves by a quantum a row. A slow column in coarse steps repeats by itself.
inline bool shows_frames(const Eigen::VectorXd& values, const std::vector<RunSpan>& runs) {
  constexpr FrameThresholds frames;
  constexpr double hardly_equal = MaskThresholds().hardly_equal;
  if (equal_share_of(step_sizes(values, runs)) < hardly_equal) return true;
  const double quantum = quantum_of(values);
  double moving = 0.0, equal = 0.0;
  for (const RunSpan& run : runs)
    for (Eigen::Index i = run.begin + 1; i < run.end; ++i) {
      const Eigen::Index from = std::max(run.begin, i - frames.around),
                         to = std::min(run.end - 1, i + frames.around);
      if (!(std::abs(values[to] - values[from]) > quantum * static_cast<double>(to - from))) continue;
      moving += 1.0;
      equal += values[i] == values[i - 1] ? 1.0 : 0.0;
    }
  return moving >= frames.least_moving && equal < hardly_equal * moving;
}

/// The smallest step between neighbours that occurs twice: what one digit of a fine column is worth. 0 where there
/// is none.
inline double finest_step(const Eigen::VectorXd& values, const std::vector<RunSpan>& runs) {
  constexpr double same = 1e-3, nothing = 1e-9;
  std::vector<double> steps = step_sizes(values, runs);
  const double largest = steps.empty() ? 0.0 : *std::max_element(steps.begin(), steps.end());
  steps.erase(std::remove_if(steps.begin(), steps.end(), [&](double x) { return !(x > nothing * largest); }),
              steps.end());
  std::sort(steps.begin(), steps.end());
  const auto twice = std::adjacent_find(steps.begin(), steps.end(),
                                        [](double less, double more) { return more <= less * (1.0 + same); });
  return twice == steps.end() ? 0.0 : *twice;
}

/// Rests of an output that reads an exact 0 there: whether the others stand for as long meanwhile. Of a fine angle
/// the noise shows at rest, too.
class Rests {
public:
  /// @param same  of each row: 2 where all outputs are the same as in the row before
  Rests(const std::vector<const Eigen::VectorXd*>& outputs, const std::vector<char>& same,
        const std::vector<RunSpan>& runs)
      : outputs_(outputs) {
    for (const Eigen::VectorXd* one : outputs) {
      double rows = 0.0, single = 0.0, more = 0.0;
      for (const RunSpan& run : runs)
        for (Eigen::Index i = run.begin + 1; i < run.end; ++i) {
          if ((*one)[i] != 0.0 || (*one)[i - 1] != 0.0) continue;
          rows += 1.0;
          const auto row = static_cast<std::size_t>(i);
          if (same[row] != 2) continue;
          const bool is_single = same[row - 1] != 2 && (i + 1 == run.end || same[row + 1] != 2);
          (is_single ? single : more) += 1.0;
        }
      rows_.push_back(rows);
      stand_.push_back(more > FrameThresholds().by_chance * rows ? 1.0 : (single + 1.0) / (rows + 1.0));
    }
  }

  /// Whether a frame that stands for some rows may be a rest.
  bool may_be(Eigen::Index row, Eigen::Index lasts) const {
    for (std::size_t c = 0; c < outputs_.size(); ++c)
      if ((*outputs_[c])[row] == 0.0 &&
          !(rows_[c] * std::pow(stand_[c], static_cast<double>(lasts)) < FrameThresholds().never_by_chance))
        return true;
    return false;
  }

private:
  const std::vector<const Eigen::VectorXd*>& outputs_;
  std::vector<double> rows_;   ///< of rests of each output
  std::vector<double> stand_;  ///< share of these in which all stand by chance
};

/// Rows that repeat all outputs of the row before them (at most a few in a row), where the outputs change at every
/// other row around them, or catch up at once with what they missed.
inline RowMask repeated_frames(const std::vector<const Eigen::VectorXd*>& outputs,
                               const std::vector<RunSpan>& runs) {
  constexpr MaskThresholds limit;
  constexpr FrameThresholds frames;
  constexpr Eigen::Index around = frames.around;
  RowMask mask;
  if (outputs.empty()) return mask;
  const Eigen::Index rows = outputs.front()->size();
  mask.assign(static_cast<std::size_t>(rows), 0);
  // 0: all outputs differ from the row before; 1: some are the same; 2: all are.
  std::vector<char> same(static_cast<std::size_t>(rows), 0);
  for (const RunSpan& run : runs)
    for (Eigen::Index i = run.begin + 1; i < run.end; ++i) {
      std::size_t equal = 0, known = 0;
      for (const Eigen::VectorXd* one : outputs) {
        known += std::isfinite((*one)[i]) ? 1 : 0;
        equal += (*one)[i] == (*one)[i - 1] ? 1 : 0;
      }
      same[static_cast<std::size_t>(i)] = equal == 0 ? 0 : known > 0 && equal == outputs.size() ? 2 : 1;
    }
  // Noise of hundreds of digits repeats a value now and then, too, though no one step is often: as often as it
  // takes any other small step.
  std::vector<double> quanta, scales, small_steps;
  for (const Eigen::VectorXd* one : outputs) {
    quanta.push_back(quantum_of(*one));
    small_steps.push_back(quanta.back() > 0.0 ? 0.0 : frames.small_step * finest_step(*one, runs));
    scales.push_back(std::max(quanta.back(), white_scale(*one, runs)));
  }
  // How fast the fastest output moves around each row, in quanta or noise scales a row, by thirds of a doubling.
  constexpr std::size_t speeds = 64;
  const auto speed_class = [](double speed) {
    constexpr double slowest = 1.0 / 1024.0, per_doubling = 3.0;
    if (!(speed > slowest)) return std::size_t{0};
    return std::min(speeds - 1, 1 + static_cast<std::size_t>(per_doubling * std::log2(speed / slowest)));
  };
  std::vector<unsigned char> speed(static_cast<std::size_t>(rows), 0);
  for (const RunSpan& run : runs)
    for (Eigen::Index i = run.begin; i < run.end; ++i) {
      const Eigen::Index from = std::max(run.begin, i - around), to = std::min(run.end - 1, i + around);
      double fastest = 0.0;
      for (std::size_t c = 0; c < outputs.size() && to > from; ++c) {
        const double way = std::abs((*outputs[c])[to] - (*outputs[c])[from]);
        if (scales[c] > 0.0 && std::isfinite(way))
          fastest = std::max(fastest, way / (scales[c] * static_cast<double>(to - from)));
      }
      speed[static_cast<std::size_t>(i)] = static_cast<unsigned char>(speed_class(fastest));
    }
  // How often all would be equal by chance. Over a whole log a column steps by none half as often as by one quantum
  // either way; a log that rests for the most part would say so of a motion in which nothing ever stands. Among
  // rows that move as fast, each of several columns says how often it stands while another one does not.
  struct Odds {
    double chance = 1.0, rows = 0.0, repeats = 0.0;
    bool repeats_are_rare() const { return chance * rows < FrameThresholds().by_chance * repeats; }
  };
  Odds overall;
  overall.rows = static_cast<double>(rows);
  std::array<Odds, speeds> as_fast_as;
  for (std::size_t i = 0; i < same.size(); ++i) {
    as_fast_as[speed[i]].rows += 1.0;
    as_fast_as[speed[i]].repeats += same[i] == 2 ? 1.0 : 0.0;
    overall.repeats += same[i] == 2 ? 1.0 : 0.0;
  }
  for (std::size_t c = 0; c < outputs.size(); ++c) {
    double all = 0.0, single = 0.0;
    std::array<double, speeds> steps{}, none{}, small{};
    for (const RunSpan& run : runs)
      for (Eigen::Index i = run.begin + 1; i < run.end; ++i) {
        const double step = std::abs((*outputs[c])[i] - (*outputs[c])[i - 1]);
        if (!std::isfinite(step)) continue;
        const auto row = static_cast<std::size_t>(i);
        all += 1.0;
        const bool is_small = step > 0.0 && step <= small_steps[c];
        if (quanta[c] > 0.0) single += step > 0.5 * quanta[c] && step < 1.5 * quanta[c] ? 1.0 : 0.0;
        else single += is_small ? 1.0 / frames.small_step : 0.0;
        if (same[row] == 2) continue;
        steps[speed[row]] += 1.0;
        none[speed[row]] += step > 0.0 ? 0.0 : 1.0;
        small[speed[row]] += is_small ? 0.5 / frames.small_step : 0.0;
      }
    overall.chance *= 0.5 * single / std::max(1.0, all);
    double faster_steps = 0.0, faster_none = 0.0, faster_small = 0.0;
    for (std::size_t k = speeds; k-- > 0;) {
      faster_steps += steps[k];
      faster_none += none[k];
      faster_small += small[k];
      as_fast_as[k].chance *= (std::max(faster_none, faster_small) + 1.0) / (faster_steps + 1.0);
    }
  }
  for (std::size_t k = speeds - 1; k-- > 0;) {
    as_fast_as[k].rows += as_fast_as[k + 1].rows;
    as_fast_as[k].repeats += as_fast_as[k + 1].repeats;
  }
  const Rests rests(outputs, same, runs);
  const auto around_of = [&](const RunSpan& run, Eigen::Index begin, Eigen::Index end) {
    return std::pair{std::max(run.begin + 1, begin - around), std::min(run.end, end + around)};
  };
  // Nothing around is the same, but for other repeats.
  const auto is_alone = [&](const RunSpan& run, Eigen::Index begin, Eigen::Index end) {
    const auto [from, to] = around_of(run, begin, end);
    for (Eigen::Index k = from; k < to; ++k) {
      if (k >= begin && k < end) continue;
      const char one = same[static_cast<std::size_t>(k)];
      if (one != 0 && !(outputs.size() > 1 && one == 2 && (k < begin - 1 || k > end))) return false;
    }
    return to - from - (end - begin) >= 2 * around;
  };
  // A column that stood catches up: a step as large as all that were missed, which were as large as those before
  // and after, half and half. A motion that comes to rest meanwhile has larger ones before.
  const auto catches_up = [&](const RunSpan& run, Eigen::Index begin, Eigen::Index end) {
    if (end >= run.end) return false;
    constexpr Eigen::Index beside = around / 2;
    const auto [from, to] = around_of(run, begin, end);
    for (std::size_t c = 0; c < outputs.size(); ++c) {
      const Eigen::VectorXd& one = *outputs[c];
      const auto usual_step = [&](Eigen::Index first, Eigen::Index last) {
        std::vector<double> steps;
        for (Eigen::Index k = first; k < last; ++k)
          if (std::isfinite(one[k] - one[k - 1])) steps.push_back(std::abs(one[k] - one[k - 1]));
        return steps.empty() ? missing : median_of(steps);
      };
      const double before = usual_step(std::max(from, begin - beside), begin),
                   after = usual_step(end + 1, std::min(to, end + 1 + beside));
      const double usual = !std::isfinite(before)  ? after
                           : !std::isfinite(after) ? before
                                                   : 0.5 * (before + after);
      const double missed = static_cast<double>(end - begin + 1) * usual;
      const double step = std::abs(one[end] - one[end - 1]);
      if (step > frames.caught_up * missed && step > limit.quanta * quanta[c]) return true;
    }
    return false;
  };
  const auto is_repeat = [&](Eigen::Index row) { return same[static_cast<std::size_t>(row)] == 2; };
  for (const RunSpan& run : runs)
    for_each_stretch(run.begin + 1, run.end, is_repeat, [&](Eigen::Index begin, Eigen::Index end) {
      const std::size_t moves =
          std::max(speed[static_cast<std::size_t>(begin)], speed[static_cast<std::size_t>(end - 1)]);
      const Odds& alike = as_fast_as[moves - std::min(moves, frames.slower_speeds)];
      const Odds& odds = outputs.size() < 2 || alike.rows < frames.least_moving ? overall : alike;
      const double by_chance = odds.rows * std::pow(odds.chance, static_cast<double>(end - begin));
      // A column that sticks, and then breaks away, repeats no frame.
      if (!rests.may_be(begin, end - begin) && end - begin <= frames.longest_repeat &&
          ((odds.repeats_are_rare() && is_alone(run, begin, end)) ||
           (by_chance < frames.never_by_chance && catches_up(run, begin, end))))
        std::fill(mask.begin() + begin, mask.begin() + end, 1);
    });
  return by(Rule::repeated_frames, std::move(mask));
}

/// The reading of a column whose sensor says nothing: the value that most of its masked samples share; NaN where
/// there is none.
/// @param recorded  the column as it was
/// @param believed  the same, NaN where masked
inline double default_reading(const Eigen::VectorXd& recorded, const Eigen::VectorXd& believed) {
  constexpr FrameThresholds frames;
  std::map<double, Eigen::Index> counts;
  Eigen::Index masked = 0;
  for (Eigen::Index i = 0; i < recorded.size(); ++i)
    if (std::isfinite(recorded[i]) && !std::isfinite(believed[i])) ++masked, ++counts[recorded[i]];
  for (const auto& [value, count] : counts)
    if (count >= frames.least_defaults && 2 * count > masked) return value;
  return missing;
}

/// Rows in which every column reads its default and one of them, at least, lies far from the rows around: what
/// stands out in one column is lost in all.
/// @param recorded  columns as they were
/// @param defaults  what each of them reads when its sensor says nothing
inline RowMask lost_frames(const std::vector<const Eigen::VectorXd*>& recorded,
                           const std::vector<double>& defaults, const std::vector<RunSpan>& runs) {
  constexpr MaskThresholds limit;
  RowMask mask;
  if (recorded.size() < 2) return mask;
  const Eigen::Index rows = recorded.front()->size();
  mask.assign(static_cast<std::size_t>(rows), 0);
  std::vector<double> least;
  for (const Eigen::VectorXd* one : recorded)
    least.push_back(std::max(limit.spike_scales * white_scale(*one, runs), limit.quanta * quantum_of(*one)));
  const auto is_default = [&](Eigen::Index row) {
    for (std::size_t c = 0; c < recorded.size(); ++c)
      if ((*recorded[c])[row] != defaults[c]) return false;
    return true;
  };
  for (const RunSpan& run : runs)
    for_each_stretch(run.begin, run.end, is_default, [&](Eigen::Index begin, Eigen::Index end) {
      const bool is_inside = begin > run.begin && end < run.end && end - begin <= limit.longest_burst;
      for (std::size_t c = 0; is_inside && c < recorded.size(); ++c) {
        const double before = (*recorded[c])[begin - 1], after = (*recorded[c])[end];
        // Farther from both ends than they from each other: no motion passes there in between.
        const double off = std::min(std::abs(defaults[c] - before), std::abs(defaults[c] - after));
        if (off > least[c] && off > std::abs(after - before))
          std::fill(mask.begin() + begin, mask.begin() + end, 1);
      }
    });
  return by(Rule::lost_frames, std::move(mask));
}

}  // namespace thermopower::gap::engine
