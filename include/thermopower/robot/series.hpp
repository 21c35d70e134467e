// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/robot/body.hpp>
#include <thermopower/robot/log.hpp>
#include <thermopower/robot/smoothing.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace thermopower::robot {

/// Rows without a hole between them.
///
/// How to: @ref diagnose_a_robot.
struct Stretch {
  Eigen::Index begin = 0;  ///< first row
  Eigen::Index end = 0;    ///< one past the last row
  /// Number of rows.
  Eigen::Index rows() const { return end - begin; }
};

/// @brief How a log is made even and smooth.
struct SmoothingOptions {
  double cutoff = 0.12;           ///< highest cut-off of the low-pass filter, as a share of the sampling rate
  double lowest_cutoff_Hz = 4.0;  ///< lowest cut-off; robots are excited below it
  double noise_share = 0.02;  ///< share of noise in the power of the acceleration that the filter may leave
  double longest_hole_rows = 10;   ///< a longer pause in the log splits it
  Eigen::Index fewest_rows = 60;   ///< a shorter stretch is left out
  Eigen::Index most_rows = 40000;  ///< of a long log, only so many rows are taken: evenly spread stretches
};

/// @brief A log on an even clock, smoothed: one column per joint, one row per step, stretch behind stretch.
///
/// How to: @ref diagnose_a_robot.
struct Series {
  double step_s = 0.0;             ///< between two rows of a stretch
  double cutoff_Hz = 0.0;          ///< of the low-pass filter that all smoothed quantities went through
  std::vector<Stretch> stretches;  ///< the rows
  Eigen::VectorXd t_s;             ///< time of each row
  Eigen::MatrixXd measured;        ///< position in rad, as measured
  Motion motion;                   ///< smoothed
  Eigen::MatrixXd target;          ///< in rad, as commanded; NaN where there is none
  Eigen::MatrixXd smooth_target;   ///< in rad, through the same filter
  Eigen::MatrixXd effort;      ///< measured effort in N m, through the same filter; empty where there is none
  Eigen::VectorXd rate_noise;  ///< standard deviation of each joint's smoothed velocity in rad/s
  Eigen::VectorXd acceleration_noise;  ///< of each joint's smoothed acceleration in rad/s2
  Eigen::VectorXd effort_noise;        ///< of each joint's smoothed effort in N m; empty where there is none
  std::vector<char> edge;              ///< rows that the filter continues past an end of their stretch

  /// Number of rows.
  Eigen::Index rows() const { return t_s.size(); }
};

namespace detail {

/// Value at each time of an even clock; `held` keeps the last sample, else a straight line joins two samples.
inline Eigen::VectorXd at_times(const Eigen::VectorXd& t, const Eigen::VectorXd& values, Eigen::Index begin,
                                Eigen::Index end, const Eigen::VectorXd& grid, bool held) {
  std::vector<Eigen::Index> good;
  good.reserve(static_cast<std::size_t>(end - begin));
  for (Eigen::Index i = begin; i < end; ++i)
    if (std::isfinite(values[i])) good.push_back(i);
  Eigen::VectorXd out = Eigen::VectorXd::Constant(grid.size(), std::numeric_limits<double>::quiet_NaN());
  if (good.empty()) return out;
  std::size_t next = 0;
  for (Eigen::Index row = 0; row < grid.size(); ++row) {
    while (next < good.size() && t[good[next]] <= grid[row] + 1e-9) ++next;
    if (next == 0) {
      out[row] = values[good[0]];
    } else if (held || next == good.size()) {
      out[row] = values[good[next - 1]];
    } else {
      const Eigen::Index a = good[next - 1], b = good[next];
      out[row] = values[a] + (values[b] - values[a]) * (grid[row] - t[a]) / (t[b] - t[a]);
    }
  }
  return out;
}

/// Median time between two rows of a run.
inline double median_step(const Log& log) {
  std::vector<double> steps;
  for (std::size_t run = 0; run < log.begin.size(); ++run)
    for (Eigen::Index i = log.begin[run] + 1; i < log.end(run); ++i)
      steps.push_back(log.t_s[i] - log.t_s[i - 1]);
  if (steps.empty()) return 0.0;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

/// Rate of turning in rad/s in the body's frame: twice the vector part of conj(q) dq/dt, q a unit quaternion w x y z.
inline Eigen::RowVector3d turning_rate(const Eigen::RowVector4d& q, const Eigen::RowVector4d& rate) {
  return 2.0 * Eigen::RowVector3d(q[0] * rate[1] - q[1] * rate[0] - q[2] * rate[3] + q[3] * rate[2],
                                  q[0] * rate[2] + q[1] * rate[3] - q[2] * rate[0] - q[3] * rate[1],
                                  q[0] * rate[3] - q[1] * rate[2] + q[2] * rate[1] - q[3] * rate[0]);
}

/// Standard deviation of white noise in a series, from what a filter of this cut-off takes away.
inline double white_noise(const Eigen::VectorXd& raw, const Eigen::VectorXd& smooth, double cutoff) {
  const double n = static_cast<double>(raw.size());
  return n < 2 ? 0.0 : std::sqrt((raw - smooth).squaredNorm() / n / std::max(0.1, 1.0 - 2.0 * cutoff));
}

}  // namespace detail

/// @brief Puts a log on an even clock and smooths it. Every quantity goes through the same filter.
///
/// The cut-off falls until noise makes only a small share of the acceleration, so that a fast log of a coarse encoder serves, too.
/// @return a series without rows where the log is too short
inline Series make_series(const Log& log, const SmoothingOptions& options = {}) {
  Series out;
  out.step_s = detail::median_step(log);
  if (!(out.step_s > 0.0)) return out;
  const Eigen::Index joints = log.position.cols();
  // Even stretches without long holes.
  std::vector<Eigen::VectorXd> grids;
  std::vector<Stretch> source;
  for (std::size_t run = 0; run < log.begin.size(); ++run) {
    Eigen::Index first = log.begin[run];
    const auto close = [&](Eigen::Index last) {
      const auto count =
          static_cast<Eigen::Index>(std::floor((log.t_s[last - 1] - log.t_s[first]) / out.step_s + 1e-6)) + 1;
      if (count >= options.fewest_rows) {
        Eigen::VectorXd grid(count);
        for (Eigen::Index i = 0; i < count; ++i)
          grid[i] = log.t_s[first] + out.step_s * static_cast<double>(i);
        grids.push_back(grid);
        source.push_back({first, last});
      }
      first = last;
    };
    for (Eigen::Index i = first + 1; i < log.end(run); ++i)
      if (log.t_s[i] - log.t_s[i - 1] > options.longest_hole_rows * out.step_s) close(i);
    close(log.end(run));
  }
  Eigen::Index rows = 0;
  for (const auto& grid : grids) rows += grid.size();
  if (rows == 0) return out;
  out.t_s.resize(rows);
  out.measured.resize(rows, joints);
  out.target = Eigen::MatrixXd::Constant(rows, joints, std::numeric_limits<double>::quiet_NaN());
  const bool has_velocity = log.velocity.rows() > 0, has_effort = log.effort.rows() > 0;
  Eigen::MatrixXd velocity, effort;
  if (has_velocity) velocity.resize(rows, joints);
  if (has_effort) effort.resize(rows, joints);
  if (log.base_pose.rows() > 0) out.motion.base_pose.resize(rows, 7);
  Eigen::Index at = 0;
  for (std::size_t i = 0; i < grids.size(); ++i) {
    const auto& grid = grids[i];
    const Stretch stretch{at, at + grid.size()};
    out.stretches.push_back(stretch);
    out.t_s.segment(at, grid.size()) = grid;
    const auto take = [&](const Eigen::MatrixXd& from, Eigen::MatrixXd& to, Eigen::Index column, bool held) {
      to.col(column).segment(at, grid.size()) =
          detail::at_times(log.t_s, from.col(column), source[i].begin, source[i].end, grid, held);
    };
    for (Eigen::Index j = 0; j < joints; ++j) {
      take(log.position, out.measured, j, false);
      if (log.target.rows() > 0) take(log.target, out.target, j, true);
      if (has_velocity) take(log.velocity, velocity, j, false);
      if (has_effort) take(log.effort, effort, j, false);
    }
    for (Eigen::Index k = 0; k < out.motion.base_pose.cols(); ++k)
      take(log.base_pose, out.motion.base_pose, k, false);
    at += grid.size();
  }
  // The filter.
  const auto filtered = [&](const Eigen::MatrixXd& raw, const ZeroPhaseFilter& filter) {
    Eigen::MatrixXd smooth(raw.rows(), raw.cols());
    for (Eigen::Index j = 0; j < raw.cols(); ++j)
      for (const Stretch& one : out.stretches)
        smooth.col(j).segment(one.begin, one.rows()) = filter(raw.col(j).segment(one.begin, one.rows()));
    return smooth;
  };
  const auto slope = [&](const Eigen::MatrixXd& of) {
    Eigen::MatrixXd rate(of.rows(), of.cols());
    for (Eigen::Index j = 0; j < of.cols(); ++j)
      for (const Stretch& one : out.stretches)
        rate.col(j).segment(one.begin, one.rows()) =
            derivative(of.col(j).segment(one.begin, one.rows()), out.step_s);
    return rate;
  };
  constexpr double pi = 3.14159265358979323846;
  double cutoff = options.cutoff;
  for (;;) {
    const ZeroPhaseFilter filter(cutoff);
    out.motion.position = filtered(out.measured, filter);
    out.motion.velocity = slope(out.motion.position);
    out.motion.acceleration = slope(out.motion.velocity);
    out.rate_noise = out.acceleration_noise = Eigen::VectorXd::Zero(joints);
    bool is_clean = true;
    for (Eigen::Index j = 0; j < joints; ++j) {
      if (!out.measured.col(j).allFinite()) continue;
      const double noise = detail::white_noise(out.measured.col(j), out.motion.position.col(j), cutoff);
      const double band = 2.0 * pi * cutoff;
      out.rate_noise[j] = noise / out.step_s * std::sqrt(std::pow(band, 3) / (3.0 * pi));
      const double wobble = std::pow(noise / (out.step_s * out.step_s), 2) * std::pow(band, 5) / (5.0 * pi);
      out.acceleration_noise[j] = std::sqrt(wobble);
      const double power = out.motion.acceleration.col(j).squaredNorm() / static_cast<double>(rows);
      const double motion = out.motion.velocity.col(j).squaredNorm() / static_cast<double>(rows);
      // A joint that hardly moves says nothing of the filter.
      if (motion > 25.0 * out.rate_noise[j] * out.rate_noise[j] && wobble > options.noise_share * power)
        is_clean = false;
    }
    const double lower = 0.8 * cutoff;
    if (is_clean || lower / out.step_s < options.lowest_cutoff_Hz) break;
    cutoff = lower;
  }
  out.cutoff_Hz = cutoff / out.step_s;
  const ZeroPhaseFilter filter(cutoff);
  if (has_velocity) {
    for (Eigen::Index j = 0; j < joints; ++j) {
      if (!velocity.col(j).allFinite()) continue;
      Eigen::MatrixXd one = filtered(velocity.col(j), filter);
      out.motion.velocity.col(j) = one;
      out.motion.acceleration.col(j) = slope(one);
    }
  }
  if (has_effort) {
    out.effort = filtered(effort, filter);
    out.effort_noise = Eigen::VectorXd::Zero(joints);
    for (Eigen::Index j = 0; j < joints; ++j)
      if (effort.col(j).allFinite())
        out.effort_noise[j] =
            detail::white_noise(effort.col(j), out.effort.col(j), cutoff) * std::sqrt(2.0 * cutoff);
  }
  if (out.motion.base_pose.rows() > 0) {
    Eigen::MatrixXd& pose = out.motion.base_pose;
    // q and -q are the same turn; the filter needs one that is continuous.
    for (const Stretch& one : out.stretches)
      for (Eigen::Index i = one.begin + 1; i < one.end; ++i)
        if (pose.row(i).tail(4).dot(pose.row(i - 1).tail(4)) < 0.0) pose.row(i).tail(4) *= -1.0;
    pose = filtered(pose, filter);
    for (Eigen::Index i = 0; i < rows; ++i) pose.row(i).tail(4).normalize();
    const Eigen::MatrixXd pose_rate = slope(pose);
    out.motion.base_velocity.resize(rows, 6);
    out.motion.base_velocity.leftCols(3) = pose_rate.leftCols(3);
    for (Eigen::Index i = 0; i < rows; ++i)
      out.motion.base_velocity.row(i).tail(3) =
          detail::turning_rate(pose.row(i).tail(4), pose_rate.row(i).tail(4));
    out.motion.base_acceleration = slope(out.motion.base_velocity);
  }
  out.smooth_target = filtered(out.target, filter);
  out.edge.assign(static_cast<std::size_t>(rows), 0);
  for (const Stretch& one : out.stretches) {
    const Eigen::Index margin = std::min(filter.margin(), one.rows() / 4);
    for (Eigen::Index i = 0; i < margin; ++i)
      out.edge[static_cast<std::size_t>(one.begin + i)] =
          out.edge[static_cast<std::size_t>(one.end - 1 - i)] = 1;
  }
  return out;
}

}  // namespace thermopower::robot
