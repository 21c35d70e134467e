// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

/// @file linear_solve.hpp
/// The systems of linear equations that a diagnosis solves. They have some tens of unknowns: plain loops are as
/// fast as a library's decompositions, which cost each program that is compiled with this one several seconds.

namespace thermopower::gap::engine {

/// A x = b with one symmetric and positive definite A and any b, by A = L D L' (Golub & Van Loan 2013, 4.1). An
/// unknown that A leaves no pivot for is 0.
class SymmetricSystem {
public:
  /// @param a  n by n, of which the lower triangle is read
  explicit SymmetricSystem(Eigen::MatrixXd a) : factors_(std::move(a)) {
    const Eigen::Index n = factors_.rows();
    assert(factors_.cols() == n);
    for (Eigen::Index k = 0; k < n; ++k)
      for (Eigen::Index j = k + 1; j < n; ++j) {
        const double multiple = divided(factors_(j, k), k);
        for (Eigen::Index i = j; i < n; ++i) factors_(i, j) -= multiple * factors_(i, k);
      }
    for (Eigen::Index k = 0; k < n; ++k)
      for (Eigen::Index i = k + 1; i < n; ++i) factors_(i, k) = divided(factors_(i, k), k);
  }

  /// The n unknowns of n right-hand sides.
  Eigen::VectorXd solve(Eigen::VectorXd b) const {
    assert(b.size() == factors_.rows());
    const Eigen::Index n = factors_.rows();
    for (Eigen::Index k = 0; k < n; ++k)
      for (Eigen::Index i = k + 1; i < n; ++i) b[i] -= factors_(i, k) * b[k];
    for (Eigen::Index k = n; k-- > 0;) {
      b[k] = divided(b[k], k);
      for (Eigen::Index i = k + 1; i < n; ++i) b[k] -= factors_(i, k) * b[i];
    }
    return b;
  }

private:
  double divided(double value, Eigen::Index k) const {
    const double pivot = factors_(k, k);
    return std::abs(pivot) > std::numeric_limits<double>::min() ? value / pivot : 0.0;
  }

  Eigen::MatrixXd factors_;  // D on the diagonal, L below it
};

/// Turns a symmetric positive definite matrix of a few rows into its inverse (Gauss and Jordan's elimination in place).
inline void invert_symmetric(Eigen::MatrixXd& a) {
  const Eigen::Index n = a.rows();
  assert(a.cols() == n);
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

/// The x that makes |A x - b| least, of several the shortest, with one A of any rank and any b: by Householder
/// reflections with column pivoting (Golub & Van Loan 2013, 5.4 and 5.5).
class LeastSquares {
public:
  /// @param a  m by n
  explicit LeastSquares(Eigen::MatrixXd a) : r_(std::move(a)), order_(static_cast<std::size_t>(r_.cols())) {
    std::iota(order_.begin(), order_.end(), Eigen::Index{0});
    const Eigen::Index most = std::min(r_.rows(), r_.cols());
    const double rounding = static_cast<double>(most) * std::numeric_limits<double>::epsilon();
    double longest = 0.0;
    for (Eigen::Index k = 0; k < most; ++k) {
      bring_longest_to(k);
      const double length = length_below(k, k);
      longest = std::max(longest, length);
      if (!(length > rounding * longest)) break;
      add_mirror(k, length);
      for (Eigen::Index j = k; j < r_.cols(); ++j) mirrors_.back().reflect(&r_(0, j));
    }
    find_null_space();
  }

  /// The n unknowns of m right-hand sides.
  Eigen::VectorXd solve(Eigen::VectorXd b) const {
    assert(b.size() == r_.rows());
    for (const Mirror& one : mirrors_) one.reflect(b.data());
    Eigen::VectorXd x = in_order_given(b.data());
    for (const Eigen::VectorXd& direction : null_space_) x -= direction.dot(x) * direction;
    return x;
  }

private:
  /// A plane through the origin, given by its normal of length 1, of which the first elements are 0.
  struct Mirror {
    Eigen::Index first;
    Eigen::VectorXd normal;  ///< from its element `first` on

    void reflect(double* x) const {
      double along = 0.0;
      for (Eigen::Index i = 0; i < normal.size(); ++i) along += normal[i] * x[first + i];
      for (Eigen::Index i = 0; i < normal.size(); ++i) x[first + i] -= 2.0 * along * normal[i];
    }
  };

  Eigen::Index rank() const { return static_cast<Eigen::Index>(mirrors_.size()); }

  double length_below(Eigen::Index row, Eigen::Index column) const {
    double square = 0.0;
    for (Eigen::Index i = row; i < r_.rows(); ++i) square += r_(i, column) * r_(i, column);
    return std::sqrt(square);
  }

  void bring_longest_to(Eigen::Index k) {
    Eigen::Index longest = k;
    for (Eigen::Index j = k + 1; j < r_.cols(); ++j)
      if (length_below(k, j) > length_below(k, longest)) longest = j;
    for (Eigen::Index i = 0; i < r_.rows(); ++i) std::swap(r_(i, k), r_(i, longest));
    std::swap(order_[static_cast<std::size_t>(k)], order_[static_cast<std::size_t>(longest)]);
  }

  /// The mirror that turns column k, from its diagonal on, into that direction.
  void add_mirror(Eigen::Index k, double length) {
    Mirror mirror{k, Eigen::VectorXd(r_.rows() - k)};
    for (Eigen::Index i = k; i < r_.rows(); ++i) mirror.normal[i - k] = r_(i, k);
    mirror.normal[0] += mirror.normal[0] < 0.0 ? -length : length;
    mirror.normal /= mirror.normal.norm();
    mirrors_.push_back(std::move(mirror));
  }

  /// The unknowns that the triangle has for a right-hand side; those beyond the rank are 0.
  Eigen::VectorXd in_order_given(const double* b) const {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(r_.cols());
    for (Eigen::Index k = rank(); k-- > 0;) {
      double left = b[k];
      for (Eigen::Index j = k + 1; j < rank(); ++j) left -= r_(k, j) * x[at(j)];
      x[at(k)] = left / r_(k, k);
    }
    return x;
  }

  /// Directions, at right angles, in which A does not tell one x from another.
  void find_null_space() {
    for (Eigen::Index j = rank(); j < r_.cols(); ++j) {
      Eigen::VectorXd direction = in_order_given(&r_(0, j));
      direction[at(j)] = -1.0;
      for (const Eigen::VectorXd& other : null_space_) direction -= other.dot(direction) * other;
      null_space_.push_back(direction / direction.norm());
    }
  }

  Eigen::Index at(Eigen::Index k) const { return order_[static_cast<std::size_t>(k)]; }

  Eigen::MatrixXd r_;                        // on and above the diagonal
  std::vector<Eigen::Index> order_;          // the column of A that each column is
  std::vector<Mirror> mirrors_;              // one for each independent column
  std::vector<Eigen::VectorXd> null_space_;  // of length 1 each
};

}  // namespace thermopower::gap::engine
