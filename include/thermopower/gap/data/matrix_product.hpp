// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <cassert>

#include <Eigen/Core>

/// @file matrix_product.hpp
/// The products of matrices that a diagnosis needs. Each is made here, for one type of matrix: a compiler makes a
/// product anew for each pair of types that it meets.

namespace thermopower::gap::engine {

/// A matrix, some of its rows or some of its columns, to be read.
using MatrixView = Eigen::Ref<const Eigen::MatrixXd>;

/// A vector, or a part of one, to be read.
using VectorView = Eigen::Ref<const Eigen::VectorXd>;

/// A'B. @param a, b  equally many rows
inline Eigen::MatrixXd transposed_product(const MatrixView& a, const MatrixView& b) {
  assert(a.rows() == b.rows());
  Eigen::MatrixXd product(a.cols(), b.cols());
  for (Eigen::Index k = 0; k < b.cols(); ++k)
    for (Eigen::Index i = 0; i < a.cols(); ++i) product(i, k) = a.col(i).dot(b.col(k));
  return product;
}

/// A'b. @param a, b  equally many rows
inline Eigen::VectorXd transposed_times(const MatrixView& a, const VectorView& b) {
  assert(a.rows() == b.size());
  Eigen::VectorXd product(a.cols());
  for (Eigen::Index i = 0; i < a.cols(); ++i) product[i] = a.col(i).dot(b);
  return product;
}

/// A'A.
inline Eigen::MatrixXd gram(const MatrixView& a) {
  Eigen::MatrixXd product(a.cols(), a.cols());
  for (Eigen::Index k = 0; k < a.cols(); ++k)
    for (Eigen::Index i = 0; i <= k; ++i) product(i, k) = product(k, i) = a.col(i).dot(a.col(k));
  return product;
}

/// x'Ax. @param a  as many rows and columns as x has elements
inline double quadratic_form(const Eigen::MatrixXd& a, const Eigen::VectorXd& x) {
  assert(a.rows() == x.size() && a.cols() == x.size());
  double sum = 0.0;
  for (Eigen::Index k = 0; k < x.size(); ++k) sum += x[k] * a.col(k).dot(x);
  return sum;
}

/// A with each element times the scale of its row and that of its column. @param a  square
inline Eigen::MatrixXd scaled_both_ways(Eigen::MatrixXd a, const Eigen::VectorXd& scale) {
  assert(a.rows() == scale.size() && a.cols() == scale.size());
  for (Eigen::Index k = 0; k < a.cols(); ++k)
    for (Eigen::Index i = 0; i < a.rows(); ++i) a(i, k) *= scale[i] * scale[k];
  return a;
}

}  // namespace thermopower::gap::engine
