// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <cassert>

#include <thermopower/gap/data/linear_solve.hpp>
#include <thermopower/gap/data/matrix_product.hpp>

#include <Eigen/Core>

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
    for (Eigen::Index k = 0; k < terms.size(); ++k) {
      for (Eigen::Index i = 0; i < terms.size(); ++i) square_(i, k) += instruments[i] * terms[k];
      product_[k] += instruments[k] * response;
    }
  }

  /// Adds other sums so many times: -1 takes them out.
  void add(const NormalEquations& other, double times) {
    assert(other.product_.size() == product_.size());
    for (Eigen::Index k = 0; k < product_.size(); ++k) {
      for (Eigen::Index i = 0; i < product_.size(); ++i) square_(i, k) += times * other.square_(i, k);
      product_[k] += times * other.product_[k];
    }
  }

  /// The coefficients; of several that do as well the shortest.
  Eigen::VectorXd solve() const { return LeastSquares(square_).solve(product_); }

  /// Those of a regression on all terms but one: 0 for that.
  Eigen::VectorXd solve_without(Eigen::Index term) const {
    NormalEquations others = *this;
    assert(term >= 0 && term < product_.size());
    others.square_.row(term).setZero();
    others.square_.col(term).setZero();
    others.product_[term] = 0.0;
    return others.solve();
  }

  /// Those of a regression on the first terms alone. @param count  of them
  Eigen::VectorXd solve_first(Eigen::Index count) const {
    assert(count > 0 && count <= product_.size());
    return LeastSquares(square_.topLeftCorner(count, count)).solve(product_.head(count));
  }

private:
  Eigen::MatrixXd square_;   // of the terms, by the terms
  Eigen::VectorXd product_;  // of the terms and the response
};

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
