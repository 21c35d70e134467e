// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/fit_problem.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace thermopower::gap {

namespace detail {

/// Mean of the values of rows [begin, end), or their root mean square; NaN where a third of them is missing.
inline double mean_of(const Eigen::VectorXd& values, Eigen::Index begin, Eigen::Index end, bool squared) {
  if (end == begin + 1) return values[begin];
  double sum = 0.0;
  int count = 0;
  for (Eigen::Index row = begin; row < end; ++row)
    if (std::isfinite(values[row])) sum += squared ? values[row] * values[row] : values[row], ++count;
  if (3 * count < 2 * static_cast<int>(end - begin)) return missing;
  return squared ? std::sqrt(sum / count) : sum / count;
}

}  // namespace detail

/// A bench recording with neighbouring rows of equal power averaged, about `rows` of them left.
///
/// Temperatures and currents are smooth while the power is constant, so a mean over a block says as much as its
/// samples. Each block becomes two rows: its start, which switches the inputs, and its centre, which carries the
/// averaged outputs with their number in `repeats`.
inline Inputs thinned_bench(const Inputs& full, Eigen::Index rows) {
  const Eigen::Index longest = (2 * full.rows() + rows - 1) / rows;
  if (longest < 5) return full;
  struct Block {
    Eigen::Index begin, end;
  };
  std::vector<Block> blocks;
  std::vector<std::size_t> first_of_run;
  const Eigen::VectorXd& power = full.power_param;
  for (const RunSpan& run : full.runs) {
    first_of_run.push_back(blocks.size());
    for (Eigen::Index row = run.begin; row < run.end;) {
      Eigen::Index end = row + 1;
      const double power_now = power.size() > 0 ? power[row] : 0.0;
      // The first rows of a run stay as they are: the start is measured there.
      while (row > run.begin + 2 && end < run.end && end - row < longest && (power.size() == 0 || power[end] == power_now))
        ++end;
      blocks.push_back({row, end});
      row = end;
    }
  }
  first_of_run.push_back(blocks.size());
  Inputs thin = full;
  const Eigen::Index count = 2 * static_cast<Eigen::Index>(blocks.size());
  thin.t_s.resize(count);
  thin.repeats.setOnes(count);
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const Block& block = blocks[i];
    const Eigen::Index at = 2 * static_cast<Eigen::Index>(i);
    thin.t_s[at] = full.t_s[block.begin];
    thin.t_s[at + 1] = full.t_s.segment(block.begin, block.end - block.begin).mean();
    thin.repeats[at + 1] = static_cast<double>(block.end - block.begin);
  }
  std::vector<Eigen::Index> kept;  // lone rows have no separate centre
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const Eigen::Index at = 2 * static_cast<Eigen::Index>(i);
    kept.push_back(at);
    if (blocks[i].end - blocks[i].begin > 1) kept.push_back(at + 1);
  }
  const Eigen::Index left = static_cast<Eigen::Index>(kept.size());
  Eigen::VectorXd t_s(left), repeats(left);
  std::vector<Eigen::Index> row_of_block(blocks.size() + 1, left);
  for (Eigen::Index i = 0; i < left; ++i) {
    const Eigen::Index at = kept[static_cast<std::size_t>(i)];
    t_s[i] = thin.t_s[at];
    repeats[i] = thin.repeats[at];
    if (at % 2 == 0) row_of_block[static_cast<std::size_t>(at / 2)] = i;
  }
  thin.t_s = t_s;
  thin.repeats = repeats;
  const auto average = [&](const Eigen::VectorXd& from, Eigen::VectorXd& to, bool output, bool squared = false) {
    if (from.size() == 0) return;
    Eigen::VectorXd values(left);
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      const double mean = detail::mean_of(from, blocks[i].begin, blocks[i].end, squared);
      const Eigen::Index row = row_of_block[i];
      const bool lone = blocks[i].end - blocks[i].begin == 1;
      values[row] = output && !lone ? missing : mean;
      if (!lone) values[row + 1] = mean;
    }
    to = values;
  };
  average(full.power_param, thin.power_param, false);
  // Heat goes with the square of these.
  average(full.drive_A, thin.drive_A, false, true);
  average(full.supply_V, thin.supply_V, false);
  average(full.ambient_C, thin.ambient_C, false);
  average(full.airspeed_mps, thin.airspeed_mps, false);
  average(full.neighbour_C, thin.neighbour_C, false);
  average(full.covariate_rate_dps, thin.covariate_rate_dps, false);
  average(full.covariate_motor_C, thin.covariate_motor_C, false);
  average(full.held_current_A, thin.held_current_A, false, true);
  average(full.held_motor_C, thin.held_motor_C, false);
  for (std::size_t signal = 0; signal < full.measured.size(); ++signal)
    average(full.measured[signal], thin.measured[signal], true);
  for (std::size_t i = 0; i < thin.runs.size(); ++i) {
    thin.runs[i].begin = row_of_block[first_of_run[i]];
    thin.runs[i].end = row_of_block[first_of_run[i + 1]];
  }
  return thin;
}

/// Keeps some of the segments of a moving axis, in contiguous stretches spread over the recording, with about
/// `rows` rows in total. Segments on the bench are all kept.
inline std::vector<Segment> thinned_axis(const std::vector<Segment>& segments, Eigen::Index rows) {
  Eigen::Index total = 0, windows = 0;
  for (const Segment& segment : segments)
    if (segment.axis) total += segment.end - segment.begin, ++windows;
  if (total <= rows || windows < 4) return segments;
  const Eigen::Index wanted = std::max<Eigen::Index>(4, windows * rows / total);
  const Eigen::Index stretches = std::min<Eigen::Index>(4, wanted / 2);
  std::vector<Segment> kept;
  Eigen::Index index = 0, previous = -2;
  for (const Segment& segment : segments) {
    if (!segment.axis) {
      kept.push_back(segment);
      continue;
    }
    // Window `index` lies in the first part of its stretch.
    const Eigen::Index stretch = index * stretches / windows;
    const Eigen::Index first = (stretch * windows + stretches - 1) / stretches;
    if (index - first < (wanted + stretches - 1) / stretches) {
      kept.push_back(segment);
      kept.back().carries_on = segment.carries_on && previous == index - 1;
      previous = index;
    }
    ++index;
  }
  return kept;
}

}  // namespace thermopower::gap
