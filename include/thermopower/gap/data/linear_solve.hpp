// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/QR>

/// @file linear_solve.hpp
/// The systems of linear equations that a diagnosis solves. Each kind is solved for one type of matrix: a compiler makes a
/// decomposition anew for each type that it meets, and takes a second or two over it.

namespace thermopower::gap::engine {

/// A x = b with one symmetric and positive semidefinite A and any b.
class SymmetricSystem {
public:
  /// @param a  n by n; of more than rounding in each direction that is asked for
  explicit SymmetricSystem(const Eigen::MatrixXd& a) : factors_(a) {}

  /// The x of n right-hand sides.
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const { return factors_.solve(b); }

private:
  Eigen::LDLT<Eigen::MatrixXd> factors_;
};

/// Turns a symmetric positive definite matrix of a few rows into its inverse (Gauss and Jordan's elimination in place).
inline void invert_symmetric(Eigen::MatrixXd& a) {
  const Eigen::Index n = a.rows();
  for (Eigen::Index k = 0; k < n; ++k) {
    const double pivot = a(k, k);
    a(k, k) = 1.0;
    for (Eigen::Index j = 0; j < n; ++j) a(k, j) /= pivot;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (i == k) continue;
      const double factor = a(i, k);
      a(i, k) = 0.0;
      for (Eigen::Index j = 0; j < n; ++j) a(i, j) -= factor * a(k, j);
    }
  }
}

/// The x that makes |A x - b| least, of several the shortest, with one A of any rank and any b.
class LeastSquares {
public:
  /// @param a  m by n
  explicit LeastSquares(const Eigen::MatrixXd& a) : factors_(a) {}

  /// The n unknowns of m right-hand sides.
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const { return factors_.solve(b); }

private:
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> factors_;
};

}  // namespace thermopower::gap::engine
