// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/linear_solve.hpp>
#include <thermopower/gap/data/matrix_product.hpp>
#include <thermopower/gap/where/thresholds.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <vector>

/// @file
/// Which block of regressors explains a residual? Bounded least squares, judged on stretches that the fit has
/// not seen.

namespace thermopower::gap::engine {

/// Regressors that share a coefficient range each: a direction in which a submodel may be wrong, with no
/// formula attached.
struct Block {
  Eigen::MatrixXd columns;                                  ///< rows x directions
  double lower = -std::numeric_limits<double>::infinity();  ///< of every coefficient: what acts one way has 0
  double at = 0.0;                                          ///< the value that a scan found best
};

/// A residual, what re-calibration within slack may take from it, and the stretches it is cross-validated on.
struct Problem {
  static constexpr int folds = 8;  ///< number of stretches
  Eigen::VectorXd y;               ///< residual, one per row, in units of one common noise
  Eigen::MatrixXd nuisance;        ///< rows x constants, each as the effect of moving that constant by 100 %
  Eigen::MatrixXd free;            ///< rows x unbounded nuisances (initial states); may have no column
  Eigen::VectorXi fold;            ///< stretch of each row, 0..folds-1; rows of a stretch lie together
};

/// Minimises b'Gb - 2 c'b within bounds by an active set. G must be symmetric and positive definite.
inline Eigen::VectorXd bounded_solve(const Eigen::MatrixXd& gram, const Eigen::VectorXd& moment,
                                     const Eigen::VectorXd& lower, const Eigen::VectorXd& upper) {
  constexpr double hardly = 1e-9;  // a pull off a bound, beside the length of the residual
  const Eigen::Index n = moment.size();
  assert(gram.rows() == n && gram.cols() == n && lower.size() == n && upper.size() == n);
  const Eigen::VectorXd length = gram.diagonal().cwiseMax(1e-300).cwiseSqrt();
  Eigen::VectorXd at_bound = Eigen::VectorXd::Zero(n), x = at_bound;  // -1 at lower, 0 free, +1 at upper
  for (Eigen::Index round = 0; n > 0 && round < 6 * n + 10; ++round) {
    std::vector<Eigen::Index> open;
    for (Eigen::Index i = 0; i < n; ++i)
      if (at_bound[i] == 0.0) open.push_back(i), x[i] = 0.0;
    Eigen::VectorXd pull = moment;
    for (Eigen::Index i = 0; i < n; ++i)
      if (x[i] != 0.0) pull -= x[i] * gram.col(i);
    x(open) = SymmetricSystem(gram(open, open)).solve(pull(open));
    Eigen::Index worst = 0;
    const Eigen::VectorXd beyond = (x - upper).cwiseMax(lower - x).cwiseProduct(length);
    if (beyond.maxCoeff(&worst) > 0.0) {
      at_bound[worst] = x[worst] > upper[worst] ? 1.0 : -1.0;
      x[worst] = std::clamp(x[worst], lower[worst], upper[worst]);
      continue;
    }
    const Eigen::VectorXd inward =
        at_bound.cwiseProduct(transposed_times(gram, x) - moment).cwiseQuotient(length);
    if (!(inward.maxCoeff(&worst) > hardly)) break;
    at_bound[worst] = 0.0;
  }
  return x;
}

/// A problem as seen by a set of blocks.
struct BlockFit {
  std::vector<std::size_t> blocks;  ///< which
  double seen = 0.0;                ///< sum of squares left by the fit on all rows
  double unseen = 0.0;              ///< the same on every stretch, predicted from the others
  std::size_t directions = 0;       ///< columns of the blocks
  Eigen::VectorXd coefficients;     ///< nuisance, free, then the blocks' columns
};

/// A problem and its blocks as one Gram matrix per stretch: any set of blocks is then fitted and
/// cross-validated without touching a row again.
class BlockFitter {
public:
  /// @param blocks  as many rows as the problem each
  BlockFitter(const Problem& problem, const std::vector<Block>& blocks) {
    constexpr double unbounded = std::numeric_limits<double>::infinity();
    const Eigen::Index rows = problem.y.size();
    assert(problem.fold.size() == rows);
    begin_ = {problem.nuisance.cols() + problem.free.cols()};
    for (const Block& block : blocks) begin_.push_back(begin_.back() + block.columns.cols());
    Eigen::MatrixXd x(rows, begin_.back());
    lower_ = upper_ = scale_ = Eigen::VectorXd::Ones(x.cols());
    Eigen::Index at = 0;
    const auto add = [&](const Eigen::MatrixXd& columns, double lower, double upper) {
      assert(columns.rows() == rows);
      x.middleCols(at, columns.cols()) = columns;
      lower_.segment(at, columns.cols()).setConstant(lower);
      upper_.segment(at, columns.cols()).setConstant(upper);
      at += columns.cols();
    };
    add(problem.nuisance, -where_limits.slack, where_limits.slack);
    add(problem.free, -unbounded, unbounded);
    for (const Block& block : blocks) add(block.columns, block.lower, unbounded);
    for (Eigen::Index j = 0; j < x.cols(); ++j) {
      const double norm = x.col(j).norm();
      if (norm > 0.0 && std::isfinite(norm)) x.col(j) *= scale_[j] = 1.0 / norm;
      else x.col(j).setZero();
    }
    lower_ = lower_.cwiseQuotient(scale_).eval();
    upper_ = upper_.cwiseQuotient(scale_).eval();
    all_ = Sums(x.topRows(0), problem.y.head(0));
    of_.assign(Problem::folds, all_);
    for (Eigen::Index begin = 0, end = 0; begin < rows; begin = end) {
      while (end < rows && problem.fold[end] == problem.fold[begin]) ++end;
      const Sums part(x.middleRows(begin, end - begin), problem.y.segment(begin, end - begin));
      of_[static_cast<std::size_t>(problem.fold[begin])].add(part, 1.0);
      all_.add(part, 1.0);
    }
  }

  /// Fits nuisances and these blocks together, and judges the fit on stretches that it has not seen.
  BlockFit fit(const std::vector<std::size_t>& chosen) const {
    BlockFit result = fit_all(chosen);
    const std::vector<Eigen::Index> columns = columns_of(chosen);
    for (const Sums& one : of_) {
      if (!(one.target > 0.0)) continue;
      Sums others = all_;
      others.add(one, -1.0);
      result.unseen += one.left(columns, solution(others, columns));
    }
    return result;
  }

  /// Fits them on all rows alone.
  BlockFit fit_all(const std::vector<std::size_t>& chosen) const {
    const std::vector<Eigen::Index> columns = columns_of(chosen);
    const Eigen::VectorXd solved = solution(all_, columns);
    BlockFit result;
    result.blocks = chosen;
    result.directions = columns.size() - static_cast<std::size_t>(begin_.front());
    result.seen = all_.left(columns, solved);
    result.coefficients = solved.cwiseProduct(scale_(columns));
    return result;
  }

  /// How many blocks there are.
  std::size_t size() const { return begin_.size() - 1; }

private:
  /// Sums over rows, all that a fit to them needs.
  struct Sums {
    Eigen::MatrixXd square;
    Eigen::VectorXd moment;
    double target = 0.0;

    Sums() = default;
    Sums(const MatrixView& x, const VectorView& y)
        : square(gram(x)), moment(transposed_times(x, y)), target(y.squaredNorm()) {}
    void add(const Sums& other, double times) {
      square += times * other.square;
      moment += times * other.moment;
      target += times * other.target;
    }
    double left(const std::vector<Eigen::Index>& columns, const Eigen::VectorXd& solution) const {
      return std::max(0.0, target - 2.0 * solution.dot(moment(columns)) +
                               quadratic_form(square(columns, columns), solution));
    }
  };

  Eigen::VectorXd solution(const Sums& sums, const std::vector<Eigen::Index>& columns) const {
    constexpr double ridge = 1e-8;  // of a column's length: two that are the same share their coefficient
    Eigen::MatrixXd part = sums.square(columns, columns);
    part.diagonal().array() += ridge;
    return bounded_solve(part, sums.moment(columns), lower_(columns), upper_(columns));
  }

  /// The columns of the problem itself, and of some blocks.
  std::vector<Eigen::Index> columns_of(const std::vector<std::size_t>& chosen) const {
    std::vector<Eigen::Index> columns(static_cast<std::size_t>(begin_.front()));
    std::iota(columns.begin(), columns.end(), Eigen::Index{0});
    for (const std::size_t i : chosen)
      for (Eigen::Index j = begin_[i]; j < begin_[i + 1]; ++j) columns.push_back(j);
    return columns;
  }

  std::vector<Eigen::Index> begin_;        // first column of each block, and one past the last one
  Eigen::VectorXd lower_, upper_, scale_;  // of each column: bounds of its coefficient; makes its length 1
  Sums all_;
  std::vector<Sums> of_;  // of each stretch
};

/// Sum of squares that nuisances within their slack and these columns leave on all rows: cheap enough for a scan.
inline double sum_of_squares_left(const Problem& problem, const Eigen::MatrixXd& columns) {
  return BlockFitter(problem, {{columns}}).fit_all({0}).seen;
}

}  // namespace thermopower::gap::engine
