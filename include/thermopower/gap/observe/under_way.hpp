// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/inputs.hpp>
#include <thermopower/gap/data/robust.hpp>
#include <thermopower/gap/recording.hpp>
#include <thermopower/gap/rule.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <vector>

namespace thermopower::gap::engine {

/// Thresholds of what begins under way. Held by tests/gap/joint_effects_test.cpp.
struct UnderWayThresholds {
  Eigen::Index rows = 5;      ///< at the beginning of a run that are looked at
  Eigen::Index least = 40;    ///< rows of a run: in fewer nobody can do without its beginning
  Eigen::Index followed = 8;  ///< over which the motion follows a command that stays
  double steady = 0.2;        ///< of the command: what it may change by over these
  double seen = 6.0;          ///< times the noise that the rate must have changed by
  double there = 0.1;         ///< of what is large in the run: less is noise, or a beginning from nothing
};

/// Whether something is there at the first rows of a run already, which is beyond its noise: not one of them is small.
/// @param values  a rate or a command by row, NaN where missing
/// @param rows    of the beginning
inline bool is_there_at_once(const Eigen::VectorXd& values, const RunSpan& run, Eigen::Index rows) {
  constexpr UnderWayThresholds limit;
  std::vector<double> all = finite_samples(values.segment(run.begin, run.size()).cwiseAbs());
  std::vector<double> first = finite_samples(values.segment(run.begin, rows).cwiseAbs());
  if (all.empty() || first.empty()) return false;
  const double large = quantile_of(all, 0.95);
  return large > 0.0 && quantile_of(first, 0.0) > limit.there * large;
}

/// Whether the command at the beginning of a run was in force before it: the motion follows it from the very first row on. A run
/// that begins with its command follows it later, by the drive's delay, or cannot tell a delay of none.
/// @param rate       deg/s by row, NaN where missing
/// @param command    of the drive by row
/// @param of_slopes  the rate is the slope of an angle from each row to the next
inline bool was_driven_before(const Eigen::VectorXd& rate, const Eigen::VectorXd& command,
                              const Eigen::VectorXd& t_s, const RunSpan& run, bool of_slopes = false) {
  constexpr UnderWayThresholds limit;
  if (!is_there_at_once(command, run, 1)) return false;
  const double first = command[run.begin];
  // Seconds that the first command would have had to be in force for, to push as much as those until a row did.
  Eigen::VectorXd pushed_s = Eigen::VectorXd::Zero(limit.followed);
  double at_row_s = 0.0;
  for (Eigen::Index i = 0; i < limit.followed; ++i) {
    const Eigen::Index row = run.begin + i;
    if (!std::isfinite(rate[row]) || !(std::abs(command[row] - first) < limit.steady * std::abs(first)))
      return false;
    const double push_s = (t_s[row + 1] - t_s[row]) * command[row] / first;
    pushed_s[i] = at_row_s + (of_slopes ? 0.5 * push_s : 0.0);
    at_row_s += push_s;
  }
  // The first row stands still in either case: it would draw the line to itself.
  const Eigen::Index fitted = limit.followed - 1;
  const Eigen::VectorXd at_s = pushed_s.tail(fitted), dps = rate.segment(run.begin + 1, fitted);
  const Eigen::VectorXd away_s = at_s.array() - at_s.mean();
  const double slope = away_s.dot(dps) / away_s.squaredNorm(), begins_s = at_s.mean() - dps.mean() / slope;
  const double rise = std::abs(slope) * (pushed_s[fitted] - pushed_s[0]);
  return rise > limit.seen * white_scale(rate, {run}) &&
         begins_s < 0.5 * (t_s[run.begin + 1] - t_s[run.begin]);
}

/// Marks the runs of an axis that begin under way (RunSpan::goes_on): the log was cut out of a longer one, and the axis moves
/// already. What drove it before, and how far a spring is bent, nobody knows then. And those that begin at rest under a command
/// that was there before (RunSpan::was_driven).
inline void mark_under_way(Recording& recording) {
  const Eigen::VectorXd* rate = recording.find("rate_dps");
  Eigen::VectorXd slope;
  recording.runs = recording.spans();
  if (rate == nullptr) {
    const Eigen::VectorXd* angle = recording.find("angle_deg");
    if (angle == nullptr) return;
    const Eigen::VectorXd turns = unwrapped(*angle, recording.runs);
    slope = Eigen::VectorXd::Constant(turns.size(), missing);
    for (const RunSpan& run : recording.runs)
      for (Eigen::Index row = run.begin; row + 1 < run.end; ++row)
        slope[row] = (turns[row + 1] - turns[row]) / (recording.t_s[row + 1] - recording.t_s[row]);
    rate = &slope;
  }
  constexpr UnderWayThresholds limit;
  for (RunSpan& run : recording.runs) {
    if (run.size() < limit.least || run.goes_on) continue;
    run.goes_on = is_there_at_once(*rate, run, limit.rows) && holds(Rule::under_way);
    for (const char* column : {"drive_A", "voltage_V"})
      if (const Eigen::VectorXd* command = recording.find(column))
        run.was_driven =
            was_driven_before(*rate, *command, recording.t_s, run, rate == &slope) && holds(Rule::under_way);
  }
}

}  // namespace thermopower::gap::engine
