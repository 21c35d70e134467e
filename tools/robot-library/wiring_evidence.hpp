// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/robot/wiring.hpp>

#include <Eigen/Core>

#include <vector>

namespace thermopower::robot {

/// @brief The columns of a log as the wiring check sees them: on an even clock, all through the same filter, one column per joint.
///
/// Each step of the filter is linear, so that exchanged, turned and scaled columns need no second pass.
struct WiringRows {
  Eigen::MatrixXd position, slope, acceleration;  ///< rad, rad/s, rad/s2; the latter two are derivatives
  Eigen::MatrixXd velocity, effort, target;       ///< as logged; empty where the log has none
  Motion base;                                    ///< motion of the base alone
  double step_s = 0.0;                            ///< between rows
  std::vector<std::size_t> begins;                ///< first row of each stretch
  std::vector<char> moves;                        ///< whether a joint's position says anything
  Eigen::VectorXd independent;  ///< number of independent samples of each joint: turns of its motion
};

/// Reads a log; of a long one, at most so many rows.
WiringRows wiring_rows(const Log& log, Eigen::Index most_rows);

/// The same with its columns put right.
WiringRows put_right(const WiringRows& rows, const Wiring& wiring);

/// Least squares with bounds.
struct BoundedFit {
  Eigen::VectorXd value;  ///< of each column; 0 where the bound left it out
  double square = 0.0;    ///< sum of squares that is left
};

/// @brief Least squares from sums of products; a column that must not be negative and would be is left out.
/// @param gram    products of the columns
/// @param moment  products of the columns with the signal
/// @param square  of the signal
/// @param free    number of columns at the beginning that may be negative
BoundedFit fit_bounded(const Eigen::MatrixXd& gram, const Eigen::VectorXd& moment, double square, int free);

/// A signal as a sum of columns and a constant.
struct Misfit {
  double left = 1.0;            ///< root mean square that is left, as a share of the signal's spread
  double constant = 0.0;        ///< that was fitted besides
  Eigen::VectorXd coefficient;  ///< of the columns
};

/// @brief fit_bounded() for rows.
Misfit fit_columns(const Eigen::VectorXd& signal, const Eigen::MatrixXd& columns, int free);

/// Root mean square about the mean.
double spread(const Eigen::VectorXd& values);

}  // namespace thermopower::robot
