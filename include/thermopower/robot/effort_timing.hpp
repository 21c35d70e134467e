// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/robot/joint.hpp>
#include <thermopower/robot/series.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <vector>

namespace thermopower::robot {

/// @brief At which instant the effort of a log acts: nuisance parameters that all joints of a bus share.
///
/// A position controller holds its target to the next row, so its effort jumps in each row. A log holds the effort just after the
/// jump, or just before it. The motion follows from the mean of the two. Without this correction half a jump looks like damping
/// of kp h / 2 and armature of kd h / 2, where h is the time between rows.
///
/// How to: @ref diagnose_a_robot.
struct EffortTiming {
  double late_s = 0.0;  ///< the motion at t follows from the effort at t - late_s, in s; may be negative
  /// Share of half a jump that the logged effort has too much: 1 just after the jump, -1 just before it, 0 neither.
  double after_jump = 0.0;
  int target_rows = 0;            ///< rows by which the logged effort follows the logged target
  std::vector<double> gain = {};  ///< N m of measured effort per rad of target, one per joint; 0: not known
  /// Share of a jump that the logged effort has too much because the rate is least just at the jump, one per joint; see
  /// ripple_share(). Of an effort that has a jump.
  std::vector<double> ripple = {};
};

/// @brief Share of a jump by which an effort at the jump exceeds its mean, because its damping acts on a rate that swings with the jumps.
///
/// Between two jumps of height J the target's part of the effort falls behind its mean course evenly, from J / 2 above to J / 2 below.
/// With I w' = -kd w + that, the rate at the jump is below its mean by J / kd times this share, where x = kd h / I.
/// @param x  damping gain times the time between rows over the joint's inertia, >= 0
inline double ripple_share(double x) {
  constexpr double small = 1e-2;  // the series is then exact to 1e-8
  return x < small ? x / 12.0 : 1.0 / (1.0 - std::exp(-x)) - 0.5 - 1.0 / x;
}

/// Value of each row at a time that is `rows` earlier: straight lines between rows, the end's value past an end.
inline Eigen::VectorXd earlier(const Series& series, const Eigen::VectorXd& values, double rows) {
  if (rows == 0.0) return values;
  Eigen::VectorXd out(values.size());
  for (const Stretch& one : series.stretches)
    for (Eigen::Index i = one.begin; i < one.end; ++i) {
      const double at = std::clamp(static_cast<double>(i) - rows, static_cast<double>(one.begin),
                                   static_cast<double>(one.end - 1));
      const auto below = std::min(static_cast<Eigen::Index>(std::floor(at)), one.end - 2);
      const double share = at - static_cast<double>(below);
      out[i] = values[below] + share * (values[below + 1] - values[below]);
    }
  return out;
}

/// Whether the effort of a joint was measured; else it follows from its target.
inline bool is_effort_measured(const Series& series, Eigen::Index index) {
  return series.effort.rows() > 0 && series.effort.col(index).allFinite();
}

/// @brief The effort in N m that moves a joint in each row, through the filter of the series: measured, else what its position
/// controller commands.
/// @param series  the log
/// @param index   of the joint
/// @param joint   its constants; kp and kd count where the log has no effort
/// @param timing  when the effort acts
inline Eigen::VectorXd effort_of(const Series& series, Eigen::Index index, const Joint& joint,
                                 const EffortTiming& timing) {
  const double late = timing.late_s / series.step_s;
  if (is_effort_measured(series, index)) {
    Eigen::VectorXd effort = series.effort.col(index);
    const double gain = timing.gain.empty() ? 0.0 : timing.gain[static_cast<std::size_t>(index)];
    if (timing.after_jump != 0.0 && gain != 0.0) {
      const Eigen::VectorXd target = series.smooth_target.col(index);
      const int rows = timing.target_rows - (timing.after_jump < 0.0 ? 1 : 0);
      const double ripple = timing.ripple.empty() ? 0.0 : timing.ripple[static_cast<std::size_t>(index)];
      effort -= (0.5 * timing.after_jump + ripple) * gain *
                (earlier(series, target, rows) - earlier(series, target, rows + 1));
    }
    return earlier(series, effort, late);
  }
  // A target is held to the next row: on average it is half a row late.
  const Eigen::VectorXd target = earlier(series, series.smooth_target.col(index), late + 0.5);
  return joint.kp * (target - series.motion.position.col(index)) -
         (std::isfinite(joint.kd) ? joint.kd : 0.0) * series.motion.velocity.col(index);
}

}  // namespace thermopower::robot
