// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/linear_solve.hpp>
#include <thermopower/gap/data/matrix_product.hpp>

#include <Eigen/Core>

#include <cassert>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace thermopower::gap::engine {

/// Sums of a linear regression over its rows. Sums of parts of the rows add up, and can be taken out again.
class NormalEquations {
public:
  /// @param terms  of the regression: how many
  explicit NormalEquations(Eigen::Index terms)
      : square_(Eigen::MatrixXd::Zero(terms, terms)), product_(Eigen::VectorXd::Zero(terms)) {}

  /// Of many rows. @param terms  one column each. @param responses  one for each row
  NormalEquations(const MatrixView& terms, const VectorView& responses)
      : square_(gram(terms)), product_(transposed_times(terms, responses)) {}

  /// Adds a row. @param terms  the value of each
  void add(const Eigen::VectorXd& terms, double response) { add(terms, terms, response); }

  /// Adds a row of terms that err. @param instruments  one for each term, that do not err with it
  void add(const Eigen::VectorXd& instruments, const Eigen::VectorXd& terms, double response) {
    assert(terms.size() == product_.size() && instruments.size() == terms.size());
    square_ += instruments * terms.transpose();
    product_ += instruments * response;
  }

  /// Adds other sums so many times: -1 takes them out.
  void add(const NormalEquations& other, double times) {
    assert(other.product_.size() == product_.size());
    square_ += times * other.square_;
    product_ += times * other.product_;
  }

  /// The coefficients; of several that do as well the shortest.
  Eigen::VectorXd solve() const { return LeastSquares(square_).solve(product_); }

  /// Those of a regression on the first terms alone. @param count  of them
  Eigen::VectorXd solve_first(Eigen::Index count) const {
    assert(count > 0 && count <= product_.size());
    return LeastSquares(square_.topLeftCorner(count, count)).solve(product_.head(count));
  }

private:
  Eigen::MatrixXd square_;   // of the terms, by the terms
  Eigen::VectorXd product_;  // of the terms and the response
};

/// A number that recordings tell, and its standard error.
struct Estimate {
  double value = 0.0;  ///< in its unit
  double error = 0.0;  ///< in the same unit
};

/// Thresholds of a regression whose error a jackknife tells.
/// Held by tests/gap/observe/command_test.cpp and tests/gap/observe/lagging_output_test.cpp.
struct JackknifeThresholds {
  std::size_t least_rows = 300;  ///< of a regression: fewer do not tell
  std::size_t blocks = 20;       ///< of the rows
  double sure =
      5.0;  ///< standard errors that an estimate differs from 0 by: one in 25 000, of so many blocks
};

/// Standard error of a statistic by the delete-one-block jackknife (Efron & Tibshirani 1993, chapter 11).
/// @param left_out  the statistic with one block of the data left out after another, in its unit
/// @return in the same unit; 0 of fewer than two values, NaN where one of them is not finite
inline double jackknife_error(const std::vector<double>& left_out) {
  if (left_out.size() < 2) return 0.0;
  const double count = static_cast<double>(left_out.size());
  double mean = 0.0, square = 0.0;
  for (const double one : left_out) mean += one / count;
  for (const double one : left_out) square += (one - mean) * (one - mean);
  return std::sqrt((count - 1.0) / count * square);
}

/// All sums of some blocks, and what is made of them without one block after another: for jackknife_error().
template <class Of>
auto left_out(const std::vector<NormalEquations>& blocks, Of&& of) {
  assert(!blocks.empty());
  NormalEquations all = blocks.front();
  for (std::size_t i = 1; i < blocks.size(); ++i) all.add(blocks[i], 1.0);
  std::vector<decltype(of(all))> without;
  for (const NormalEquations& one : blocks) {
    NormalEquations rest = all;
    rest.add(one, -1.0);
    without.push_back(of(rest));
  }
  return std::make_pair(std::move(all), std::move(without));
}

}  // namespace thermopower::gap::engine
