// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <Eigen/Core>

#include <cstddef>

namespace thermopower::gap::engine {

/// How effort and motion are compared, and when a term is proposed. Held by tests/gap/propose/effort_problem_test.cpp.
struct ProposeThresholds {
  double motion_cutoff = 0.15;    ///< of the low-pass on motion and effort, as a share of the grid's rate
  double residual_cutoff = 0.12;  ///< of the low-pass on the residuals, as a share of the grid's rate
  double next_cutoff = 0.65;    ///< times the one before, where the acceleration is noise in too large a part
  double least_cutoff = 0.01;   ///< as a share of the sampling rate
  double hidden_inertia = 0.1;  ///< share by which a lower cutoff must raise the inertia to be taken,
  double certain = 3.0;         ///< and standard errors of it;
  double fallen = 0.4;          ///< or share of the residual's variance that it must take away
  Eigen::Index most_samples = 100000;   ///< more are thinned before any low-pass
  int rows_between = 4;                 ///< rows per residual: what the low-pass leaves holds no more
  int at_the_edge = 6;                  ///< rows at each end of a piece that the low-pass spoils
  double still_share = 0.03;            ///< of the RMS of the rate: below, its sign is not known
  double rest = 3.0;                    ///< times that: slower rows rest, and say nothing of friction
  int shortest_piece = 40;              ///< rows of motion without a hole
  double longest_hole = 10.0;           ///< intervals without a sample that are bridged
  Eigen::Index most_train_rows = 5000;  ///< more rows are thinned to pieces of this many in all
  Eigen::Index most_held_rows = 4000;   ///< the same of held-out rows
  std::size_t scan_rows = 1500;         ///< rows that starts are compared on
  int least_residuals = 24;             ///< of the training data; fewer determine nothing
  int blocks_in_run = 8;                ///< of held-out data, at most
  int residuals_in_block = 8;           ///< at least
  /// Share of the residual's variance by which an effort must fit better as a measurement at its stamp than as a held
  /// value.
  double stamped = 0.1;
  double least_delay_samples = 0.75;  ///< a delay that is less than this may be one of stamps
  double longest_delay_rows = 8.0;    ///< from effort to torque
  double longest_delay_s = 0.02;      ///< the same, where rows are rare: the larger counts
  double flat = 0.1;           ///< of the drive's torque per effort: a drive that gives less has switched off
  double least_effort = 2e-3;  ///< of the effort's RMS: smaller residuals are not compared
  double least_reduction = 0.07;  ///< of the held-out residual, for a proposal
  double least_share = 0.01;      ///< of the effort's RMS by which the residual falls, for a proposal
  double tied = 0.03;  ///< explanations that differ by less than this share are equal: the first counts
  double least_promise = 0.04;    ///< share of the squares that one linear step must take away to be fitted
  double least_deviations = 1.5;  ///< of the gain over blocks, for a proposal
  double per_parameter = 0.02;    ///< by which one more parameter must lower the residual
  double repeats =
      0.8;  ///< share of rows whose effort is that of the row before: above, it comes from outside
  double smooth_effort =
      0.0018;  ///< noise over RMS of an effort that comes from outside; controllers passed on 0.003 and more
  std::size_t most_causes = 3;  ///< of a proposal
};

/// The values in force.
inline constexpr ProposeThresholds propose_thresholds{};

}  // namespace thermopower::gap::engine
