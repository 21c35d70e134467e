// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/model.hpp>
#include <thermopower/gap/propose/low_pass.hpp>
#include <thermopower/gap/propose/sampled_motion.hpp>
#include <thermopower/gap/propose/thresholds.hpp>
#include <thermopower/plant/radians.hpp>
#include <thermopower/plant/rows.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

/// @file effort_rows.hpp
/// Effort and motion of recordings on even grids, both through the same low-pass.

namespace thermopower::gap::engine {

/// A stretch of motion without a hole, on an even grid.
struct EffortPiece {
  Eigen::Index begin = 0;    ///< first row of the grid
  Eigen::Index end = 0;      ///< row after the last
  std::size_t run = 0;       ///< it is of, counted over all recordings
  double interval_s = 0.0;   ///< between the rows of the grid
  double half_sample = 0.5;  ///< half an interval between samples, in rows of the grid

  /// How many rows it has.
  Eigen::Index rows() const { return end - begin; }
};

/// The recordings of one part, row by row: the motion, and the effort that went with it, both through one low-pass.
class EffortRows {
public:
  Inputs grid;                              ///< stamps, torque from outside and temperature of the motor
  std::vector<EffortPiece> pieces;          ///< in the order of the rows
  Eigen::VectorXd angle_rad;                ///< low-passed
  Eigen::VectorXd rate_rad_per_s;           ///< low-passed
  Eigen::VectorXd acceleration_rad_per_s2;  ///< low-passed
  double rate_noise = 0.0;                  ///< of the low-passed rate, rad/s

  /// @param cutoff  of the low-pass, as a share of the rate of the samples; the grid becomes as coarse as it allows
  /// @param most    rows that are kept of all, about
  EffortRows(const SampledMotion& sampled, double cutoff, Eigen::Index most) {
    const Eigen::Index every = std::max<Eigen::Index>(
        1, static_cast<Eigen::Index>(propose_thresholds.motion_cutoff / cutoff + 1e-9));
    Eigen::Index rows = 0;
    bool torque = false, warm = false;
    for (const SampledMotion::Stretch& one : sampled.stretches) {
      rows += (one.effort.size() + every - 1) / every;
      torque = torque || one.torque_Nm.size() > 0;
      warm = warm || one.motor_C.size() > 0;
    }
    grid.t_s.resize(rows);
    angle_rad.setZero(rows);
    rate_rad_per_s.setZero(rows);
    acceleration_rad_per_s2.setZero(rows);
    effort_.setZero(rows);
    if (torque) grid.torque_Nm.setZero(rows);
    if (warm) grid.covariate_motor_C.setConstant(rows, plant::missing);
    assert(cutoff > 0.0 && most > 0);
    Eigen::Index filled = 0;
    for (const SampledMotion::Stretch& one : sampled.stretches) fill(one, cutoff, every, filled);
    rate_noise = sampled.rate_noise > 0.0 || sampled.stretches.empty()
                     ? sampled.rate_noise * std::sqrt(2.0 * cutoff)
                     : sampled.angle_noise * std::sqrt(2.0 / 3.0) * plant::rad_per_turn *
                           std::pow(cutoff, 1.5) / sampled.stretches.front().interval_s;
    spread_out(pieces, most, [](EffortPiece one, Eigen::Index begin, Eigen::Index end) {
      one.end = one.begin + end;
      one.begin += begin;
      return one;
    });
    for (const EffortPiece& one : pieces) grid.runs.push_back({one.begin, one.end, {}});
  }

  /// Effort that acts at a row, A or V.
  /// @param late_rows  intervals from effort to torque, counted from the instant at which a held effort is set; less than 0 where
  ///                   an effort is measured at its stamp
  double effort(const EffortPiece& piece, Eigen::Index row, double late_rows) const {
    const double at = static_cast<double>(row - piece.begin) - piece.half_sample - late_rows;
    // Catmull's and Rom's cubic between the rows.
    const Eigen::Index n = piece.rows();
    const double inside = std::clamp(at, 0.0, static_cast<double>(n - 1));
    const Eigen::Index i = std::min(static_cast<Eigen::Index>(inside), n - 2);
    const double x = inside - static_cast<double>(i);
    const auto value = [&](Eigen::Index k) {
      return effort_[piece.begin + std::clamp<Eigen::Index>(k, 0, n - 1)];
    };
    const double p0 = value(i - 1), p1 = value(i), p2 = value(i + 1), p3 = value(i + 2);
    return p1 +
           0.5 * x * (p2 - p0 + x * (2.0 * p0 - 5.0 * p1 + 4.0 * p2 - p3 + x * (3.0 * (p1 - p2) + p3 - p0)));
  }

  /// Change of effort() per interval by which it comes later.
  double effort_slope(const EffortPiece& piece, Eigen::Index row, double late_rows) const {
    constexpr double beside = 0.05;  // intervals
    return (effort(piece, row, late_rows + beside) - effort(piece, row, late_rows - beside)) / (2.0 * beside);
  }

private:
  void fill(const SampledMotion::Stretch& one, double cutoff, Eigen::Index every, Eigen::Index& filled) {
    const Eigen::Index count = (one.effort.size() + every - 1) / every;
    EffortPiece piece;
    piece.begin = filled;
    piece.end = filled += count;
    piece.run = one.run;
    piece.interval_s = one.interval_s * static_cast<double>(every);
    piece.half_sample = 0.5 / static_cast<double>(every);
    pieces.push_back(piece);
    assert(piece.end <= grid.t_s.size());
    const auto put = [&](const Eigen::VectorXd& fine, Eigen::VectorXd& to) {
      assert(fine.size() == one.effort.size());
      for (Eigen::Index i = 0; i < count; ++i) to[piece.begin + i] = fine[i * every];
    };
    const auto smooth = [&](Eigen::VectorXd values, Eigen::VectorXd& to) {
      low_pass(values, cutoff);
      put(values, to);
    };
    // A held value acts from its sample on: its middle lies half a sample later, of the fine grid.
    smooth(one.effort, effort_);
    if (one.torque_Nm.size() > 0) smooth(one.torque_Nm, grid.torque_Nm);
    if (one.motor_C.size() > 0) put(one.motor_C, grid.covariate_motor_C);
    const Eigen::VectorXd rate = one.smooth_rate(cutoff);
    put(rate, rate_rad_per_s);
    put(one.slope(rate), acceleration_rad_per_s2);
    if (one.angle.size() > 0) smooth(one.angle, angle_rad);
    else
      for (Eigen::Index i = piece.begin + 1; i < piece.end; ++i)
        angle_rad[i] =
            angle_rad[i - 1] + 0.5 * (rate_rad_per_s[i - 1] + rate_rad_per_s[i]) * piece.interval_s;
    for (Eigen::Index i = 0; i < count; ++i)
      grid.t_s[piece.begin + i] = one.from_s + static_cast<double>(i) * piece.interval_s;
  }

  Eigen::VectorXd effort_;  ///< means over the intervals, low-passed
};

}  // namespace thermopower::gap::engine
