// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/finding_list.hpp>
#include <thermopower/gap/observe/prepared_recording.hpp>
#include <thermopower/plant/bench_at_rows.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

/// @file clock_shift.hpp
/// Inputs and outputs that two loggers stamped with different clocks.

namespace thermopower::gap::engine {

/// Thresholds of the check of clocks.
/// Held by tests/gap/data/units_test.cpp.
struct ClockShiftThresholds {
  Eigen::Index furthest_current = 12;  ///< rows that a current is looked for
  double least_rows = 30.0;            ///< that compare two columns
  double current_left = 0.6;           ///< of the current's variance that the right shift leaves
};

/// A current follows its voltage within a row: where another shift fits far better, the loggers' clocks differ.
inline void check_current_clock(const Model& model, const PreparedRecording& prepared,
                                const Catalogue& catalogue, FindingList& list) {
  constexpr ClockShiftThresholds limit;
  const Recording& recording = prepared.recording();
  if (!model.has_current() || !prepared.inputs().bench() || !recording.has("power_param") ||
      !recording.has("current_A"))
    return;
  const Inputs& inputs = prepared.inputs();
  const Eigen::VectorXd law_A =
      plant::BenchAtRows(model, catalogue, inputs, {}).evaluate(plant::heat_told(inputs)).law_A;
  const Eigen::VectorXd& measured = recording.column("current_A");
  const auto left_at = [&](Eigen::Index shift) {
    double xx = 0.0, xy = 0.0, yy = 0.0, rows = 0.0;
    for (const RunSpan& run : inputs.runs)
      for (Eigen::Index i = run.begin + limit.furthest_current; i + limit.furthest_current < run.end; ++i) {
        const double x = law_A[i - shift], y = measured[i];
        if (!std::isfinite(x) || !std::isfinite(y)) continue;
        xx += x * x, xy += x * y, yy += y * y, rows += 1.0;
      }
    return rows > limit.least_rows && xx > 0.0 ? (yy - xy * xy / xx) / rows : -1.0;
  };
  const double now = left_at(0);
  double best = now;
  Eigen::Index at = 0;
  for (Eigen::Index shift = -limit.furthest_current; shift <= limit.furthest_current; ++shift) {
    const double left = left_at(shift);
    if (left >= 0.0 && left < best) best = left, at = shift;
  }
  if (at == 0 || !(best < limit.current_left * now)) return;
  list.add(FindingKind::clock_shift, Severity::warning, "current_A",
           std::string(at > 0 ? "follows" : "precedes") + " power_param by " +
               short_number(static_cast<double>(std::abs(at)) * prepared.interval_s()) + " s (" +
               std::to_string(std::abs(at)) + (std::abs(at) == 1 ? " row)" : " rows)"),
           "log both with one clock");
}

}  // namespace thermopower::gap::engine
