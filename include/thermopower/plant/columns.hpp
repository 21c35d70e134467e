// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <Eigen/Core>

#include <initializer_list>

namespace thermopower::plant {

/// A matrix of columns. @param columns  at least one, equally long
inline Eigen::MatrixXd columns_of(std::initializer_list<Eigen::VectorXd> columns) {
  Eigen::MatrixXd all(columns.begin()->size(), static_cast<Eigen::Index>(columns.size()));
  Eigen::Index at = 0;
  for (const Eigen::VectorXd& one : columns) all.col(at++) = one;
  return all;
}

/// The columns of a matrix, then those of another. @param first, second  equally many rows
inline Eigen::MatrixXd beside(const Eigen::MatrixXd& first, const Eigen::MatrixXd& second) {
  Eigen::MatrixXd all(first.rows(), first.cols() + second.cols());
  all.leftCols(first.cols()) = first;
  all.rightCols(second.cols()) = second;
  return all;
}

}  // namespace thermopower::plant
