// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/actuator/duty.hpp>
#include <thermopower/gap/data/robust.hpp>
#include <thermopower/gap/data/sample_masks.hpp>
#include <thermopower/gap/data/segments.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

/// @file current_masks.hpp
/// Samples of a current that are not to be believed at the power that drives it.

namespace thermopower::gap::engine {

/// Rows of a constant power that a spike can be told in.
inline constexpr Eigen::Index shortest_steady = 7;

/// The runs cut wherever the power steps.
inline std::vector<RunSpan> steady_runs(const Eigen::VectorXd& power, const std::vector<RunSpan>& runs) {
  RowMask starts(static_cast<std::size_t>(power.size()), 0);
  for (Eigen::Index i = 1; i < power.size(); ++i)
    starts[static_cast<std::size_t>(i)] = std::isfinite(power[i]) && power[i] != power[i - 1] ? 1 : 0;
  return cut_at(runs, starts, true);
}

/// Runs with the pauses of a logger inside them.
inline std::vector<RunSpan> joined_at_pauses(const std::vector<RunSpan>& runs) {
  std::vector<RunSpan> joined;
  for (const RunSpan& run : runs)
    if (!joined.empty() && run.goes_on && joined.back().end == run.begin && joined.back().label == run.label)
      joined.back().end = run.end;
    else joined.push_back(run);
  return joined;
}

/// The current without what the voltage at the motor does to it at once: the steps of the power are gone. What flows at
/// a voltage is told by the rows before and after whose voltage is nearest, whatever the law between the two, and be there a
/// pause between them; missing where no rows are near.
/// @param supply  V by row; none: whatever it is, it stays the same
inline Eigen::VectorXd detrended_current(const Eigen::VectorXd& current_A, const Eigen::VectorXd& power,
                                         const Eigen::VectorXd* supply, const std::vector<RunSpan>& runs) {
  constexpr Eigen::Index around = 40;    // rows before and after
  constexpr std::ptrdiff_t nearest = 7;  // rows: three bad ones do no harm
  // Of the largest voltage: beyond the one a row tells nothing of another's (a ramp from rest may cover a fifth of it within
  // seven rows), below the other a ratio is mostly noise.
  constexpr double near_share = 0.2, least_share = 0.1;
  Eigen::VectorXd volts(current_A.size());
  for (Eigen::Index i = 0; i < volts.size(); ++i) {
    const double on = std::isfinite(power[i]) ? std::clamp(power[i], 0.0, 255.0) : 0.0;
    const double open_V = supply != nullptr && std::isfinite((*supply)[i]) ? (*supply)[i] : 1.0;
    volts[i] = on > 0.0 ? v_rms_from_duty<double>(open_V, duty_from_power(on)) : 0.0;
  }
  const double near = near_share * volts.maxCoeff(), least = least_share * volts.maxCoeff();
  Eigen::VectorXd result = current_A;
  std::vector<std::pair<double, Eigen::Index>> rows;  // by distance in volts
  std::vector<double> list;
  for (const RunSpan& run : joined_at_pauses(runs))
    for (Eigen::Index i = run.begin; i < run.end; ++i) {
      rows.clear();
      list.clear();
      for (Eigen::Index k = std::max(run.begin, i - around); k < std::min(run.end, i + around + 1); ++k) {
        if (k == i || !std::isfinite(current_A[k])) continue;
        if (volts[k] > least) list.push_back(current_A[k] / volts[k]);
        if (std::abs(volts[k] - volts[i]) <= near) rows.push_back({std::abs(volts[k] - volts[i]), k});
      }
      if (static_cast<std::ptrdiff_t>(rows.size()) < nearest) {
        result[i] = missing;
        continue;
      }
      const double conductance = median_of(list);
      std::nth_element(rows.begin(), rows.begin() + nearest - 1, rows.end());
      list.clear();
      for (auto row = rows.begin(); row != rows.begin() + nearest; ++row)
        list.push_back(current_A[row->second] + conductance * (volts[i] - volts[row->second]));
      result[i] -= median_of(list);
    }
  return result;
}

/// Exact zeros of the current at a power at which current flows otherwise.
inline RowMask lost_current(const Eigen::VectorXd& current_A, const Eigen::VectorXd& power, double scale_A) {
  constexpr double clearly = 10.0, mostly = 0.5;  // noise scales of a current that flows; share of its rows
  constexpr int bands = 26;                       // of ten counts
  std::vector<std::vector<double>> flowing(bands);
  const auto band = [](double counts) {
    return static_cast<std::size_t>(std::clamp(counts / 10.0, 0.0, 25.0));
  };
  RowMask mask(static_cast<std::size_t>(current_A.size()), 0);
  for (Eigen::Index i = 0; i < current_A.size(); ++i)
    if (power[i] > 0.0 && std::isfinite(current_A[i])) flowing[band(power[i])].push_back(current_A[i]);
  std::vector<double> typical(bands, 0.0);
  for (std::size_t k = 0; k < flowing.size(); ++k) {
    const auto zeros = std::count(flowing[k].begin(), flowing[k].end(), 0.0);
    if (static_cast<double>(zeros) > mostly * static_cast<double>(flowing[k].size())) continue;
    typical[k] = std::abs(quantile_of(flowing[k], 0.25));
  }
  for (Eigen::Index i = 0; i < current_A.size(); ++i)
    if (power[i] > 0.0 && current_A[i] == 0.0 && typical[band(power[i])] > clearly * std::max(scale_A, 1e-12))
      mask[static_cast<std::size_t>(i)] = 1;
  return mask;
}

/// Samples of a current that still read what they did before the power stepped, and jump later, where it follows such a step in
/// the same row otherwise. A drive with a dead time stands at all of them.
inline RowMask held_over_steps(const Eigen::VectorXd& current_A, const Eigen::VectorXd& power,
                               const std::vector<RunSpan>& runs, double scale_A) {
  constexpr double clearly = 10.0,
                   mostly = 0.8;  // noise scales of a jump; share of the steps that show at once
  constexpr int least_steps = 10;
  RowMask mask(static_cast<std::size_t>(current_A.size()), 0);
  std::vector<std::pair<Eigen::Index, Eigen::Index>> held;
  int at_once = 0;
  const auto jumps = [&](Eigen::Index from, Eigen::Index to) {
    return std::abs(current_A[to] - current_A[from]) > clearly * std::max(scale_A, 1e-12);
  };
  for (const RunSpan& run : joined_at_pauses(runs))
    for (Eigen::Index i = run.begin + 1; i < run.end; ++i) {
      if (!std::isfinite(power[i] - power[i - 1]) || power[i] == power[i - 1]) continue;
      if (jumps(i - 1, i)) ++at_once;
      if (current_A[i] != current_A[i - 1]) continue;
      Eigen::Index end = i;
      while (end < run.end && power[end] == power[i] && current_A[end] == current_A[i]) ++end;
      if (end < run.end && power[end] == power[i] && jumps(i, end)) held.push_back({i, end});
    }
  const double steps = at_once + static_cast<double>(held.size());
  if (at_once < least_steps || static_cast<double>(at_once) < mostly * steps) return mask;
  for (const auto& [from, to] : held)
    for (Eigen::Index i = from; i < to; ++i) mask[static_cast<std::size_t>(i)] = 1;
  return mask;
}

}  // namespace thermopower::gap::engine
