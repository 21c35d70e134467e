// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/sample_masks.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <vector>

/// @file frame_masks.hpp
/// Frames, the rows of all columns together, that are not to be believed: those that repeat the one before them, and
/// those in which the sensors said nothing.

namespace thermopower::gap::engine {

/// Thresholds of the masks of frames.
struct FrameThresholds {
  Eigen::Index least_defaults =
      3;  ///< masked samples of one value that make it what a sensor reads by default
  Eigen::Index longest_repeat = 12;  ///< frames in a row that repeat another
  double by_chance = 0.1;            ///< share of the repeated frames that chance may make
  double never_by_chance = 0.01;     ///< repeats of a length that chance may make in a recording
  double caught_up = 0.6;            ///< of what was missed while a frame was repeated: the step after it
};

/// Rows that repeat all outputs of the row before them (at most a few in a row), where the outputs change at every
/// other row around them, or catch up at once with what they missed.
inline RowMask repeated_frames(const std::vector<const Eigen::VectorXd*>& outputs,
                               const std::vector<RunSpan>& runs) {
  constexpr MaskThresholds limit;
  constexpr FrameThresholds frames;
  constexpr Eigen::Index around = 6;
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
  // How often all would be equal by chance: a column steps by none half as often as by one quantum either way.
  double chance = 1.0, repeats = 0.0;
  std::vector<double> quanta;
  for (const Eigen::VectorXd* one : outputs) {
    const double quantum = quantum_of(*one);
    quanta.push_back(quantum);
    const std::vector<double> steps = step_sizes(*one, runs);
    const auto single = std::count_if(steps.begin(), steps.end(), [&](double step) {
      return step > 0.5 * quantum && step < 1.5 * quantum;
    });
    chance *= 0.5 * static_cast<double>(single) / std::max(1.0, static_cast<double>(steps.size()));
  }
  for (const char one : same) repeats += one == 2 ? 1.0 : 0.0;
  const bool is_rare = chance * static_cast<double>(rows) < frames.by_chance * repeats;
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
  // What stood catches up: a step as large as all that were missed.
  const auto catches_up = [&](const RunSpan& run, Eigen::Index begin, Eigen::Index end) {
    if (end >= run.end) return false;
    const auto [from, to] = around_of(run, begin, end);
    for (std::size_t c = 0; c < outputs.size(); ++c) {
      const Eigen::VectorXd& one = *outputs[c];
      std::vector<double> steps;
      for (Eigen::Index k = from; k < to; ++k)
        if ((k < begin || k > end) && std::isfinite(one[k] - one[k - 1]))
          steps.push_back(std::abs(one[k] - one[k - 1]));
      const double missed = static_cast<double>(end - begin + 1) * median_of(steps);
      const double step = std::abs(one[end] - one[end - 1]);
      if (!steps.empty() && step > frames.caught_up * missed && step > limit.quanta * quanta[c]) return true;
    }
    return false;
  };
  for (const RunSpan& run : runs)
    for (Eigen::Index i = run.begin + 1; i < run.end;) {
      if (same[static_cast<std::size_t>(i)] != 2) {
        ++i;
        continue;
      }
      Eigen::Index end = i;
      while (end < run.end && same[static_cast<std::size_t>(end)] == 2) ++end;
      const double by_chance = static_cast<double>(rows) * std::pow(chance, static_cast<double>(end - i));
      if (end - i <= frames.longest_repeat &&
          ((is_rare && is_alone(run, i, end)) ||
           (by_chance < frames.never_by_chance && catches_up(run, i, end))))
        for (Eigen::Index k = i; k < end; ++k) mask[static_cast<std::size_t>(k)] = 1;
      i = end;
    }
  return mask;
}

/// What a column reads when its sensor says nothing: the value that most of its masked samples share; NaN where there is
/// none.
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

/// Rows in which every column reads its default and one of them, at least, lies far from the rows around: what stands out in one
/// column is lost in all.
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
    for (Eigen::Index i = run.begin; i < run.end; ++i) {
      if (!is_default(i)) continue;
      Eigen::Index end = i;
      while (end < run.end && is_default(end)) ++end;
      const bool is_inside = i > run.begin && end < run.end && end - i <= limit.longest_burst;
      for (std::size_t c = 0; is_inside && c < recorded.size(); ++c) {
        const double before = (*recorded[c])[i - 1], after = (*recorded[c])[end];
        // Farther from both ends than they from each other: no motion passes there in between.
        const double off = std::min(std::abs(defaults[c] - before), std::abs(defaults[c] - after));
        if (!(off > least[c] && off > std::abs(after - before))) continue;
        for (Eigen::Index k = i; k < end; ++k) mask[static_cast<std::size_t>(k)] = 1;
      }
      i = end;
    }
  return mask;
}

}  // namespace thermopower::gap::engine
