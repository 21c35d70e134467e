// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <Eigen/Core>

#include <cmath>
#include <string>
#include <vector>

namespace thermopower::robot {

/// @brief A log of a whole robot: one column per joint of the model, one row per sample.
///
/// A quantity that nobody logged is an empty matrix. A joint that the log lacks has NaN in its column.
///
/// How to: @ref diagnose_a_robot.
struct Log {
  std::string file;                      ///< for messages
  Eigen::VectorXd t_s;                   ///< time in s, strictly increasing inside a run
  std::vector<Eigen::Index> begin;       ///< first row of each run
  Eigen::MatrixXd position;              ///< in rad
  Eigen::MatrixXd velocity;              ///< in rad/s
  Eigen::MatrixXd effort;                ///< in N m
  Eigen::MatrixXd target;                ///< in rad
  Eigen::MatrixXd base_pose;             ///< 7 columns, see Motion; empty where the base is not logged
  std::vector<std::string> notes;        ///< what the reader noticed, one sentence each
  std::vector<std::string> not_matched;  ///< columns that belong to no joint

  /// Number of rows.
  Eigen::Index rows() const { return t_s.size(); }

  /// First row after run `run`.
  Eigen::Index end(std::size_t run) const { return run + 1 < begin.size() ? begin[run + 1] : rows(); }

  /// Whether there is at least one number for this joint.
  static bool has(const Eigen::MatrixXd& quantity, Eigen::Index joint) {
    return quantity.rows() > 0 && quantity.col(joint).array().isFinite().any();
  }
};

}  // namespace thermopower::robot
