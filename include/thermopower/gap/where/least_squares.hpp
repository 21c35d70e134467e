// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/linear_solve.hpp>
#include <thermopower/gap/data/matrix_product.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
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
  Eigen::VectorXd y;         ///< residual, one per row, in units of one common noise
  Eigen::MatrixXd nuisance;  ///< rows x constants, each as the effect of moving that constant by 100 %
  double slack = 0.04;       ///< bound of every nuisance coefficient
  Eigen::MatrixXd free;      ///< rows x unbounded nuisances (initial states); may have no column
  Eigen::VectorXi fold;      ///< stretch of each row, 0..folds-1
  int folds = 8;             ///< number of stretches
};

/// Minimises b'Gb - 2 c'b within bounds by an active set. G must be symmetric and positive definite.
inline Eigen::VectorXd bounded_solve(const Eigen::MatrixXd& gram, const Eigen::VectorXd& moment,
                                     const Eigen::VectorXd& lower, const Eigen::VectorXd& upper) {
  constexpr double hardly = 1e-9;  // a pull off a bound, beside the length of the residual
  const Eigen::Index n = moment.size();
  assert(gram.rows() == n && gram.cols() == n && lower.size() == n && upper.size() == n);
  const Eigen::VectorXd length = gram.diagonal().cwiseMax(1e-300).cwiseSqrt();
  std::vector<int> at_bound(static_cast<std::size_t>(n), 0);  // -1 at lower, 0 free, +1 at upper
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
  for (Eigen::Index round = 0; round < 6 * n + 10; ++round) {
    std::vector<Eigen::Index> open;
    for (Eigen::Index i = 0; i < n; ++i)
      if (at_bound[static_cast<std::size_t>(i)] == 0) open.push_back(i), x[i] = 0.0;
    Eigen::VectorXd pull = moment;
    for (Eigen::Index i = 0; i < n; ++i)
      if (x[i] != 0.0) pull -= x[i] * gram.col(i);
    const Eigen::VectorXd solved = SymmetricSystem(gram(open, open)).solve(pull(open));
    Eigen::Index worst = -1;
    double excess = 0.0;
    for (std::size_t k = 0; k < open.size(); ++k) {
      const Eigen::Index i = open[k];
      const double value = solved[static_cast<Eigen::Index>(k)],
                   over = std::max(value - upper[i], lower[i] - value) * length[i];
      x[i] = value;
      if (over > excess) excess = over, worst = i;
    }
    if (worst >= 0) {
      at_bound[static_cast<std::size_t>(worst)] = x[worst] > upper[worst] ? 1 : -1;
      x[worst] = std::clamp(x[worst], lower[worst], upper[worst]);
      continue;
    }
    double most = hardly;
    for (Eigen::Index i = 0; i < n; ++i) {
      const int bound = at_bound[static_cast<std::size_t>(i)];
      const double inward = -bound * (moment[i] - gram.col(i).dot(x)) / length[i];
      if (inward > most) most = inward, worst = i;
    }
    if (worst < 0) break;
    at_bound[static_cast<std::size_t>(worst)] = 0;
  }
  return x;
}

/// A problem as seen by a set of blocks.
struct BlockFit {
  std::vector<std::size_t> blocks;  ///< which
  double seen = 0.0;                ///< sum of squares left by the fit on all rows
  double unseen = 0.0;              ///< the same on every stretch, predicted from the others
  int directions = 0;               ///< columns of the blocks
  Eigen::VectorXd coefficients;     ///< nuisance, free, then the blocks' columns
};

/// A problem and its blocks as one Gram matrix per stretch: any set of blocks is then fitted and
/// cross-validated without touching a row again.
class BlockFitter {
public:
  /// Keeps references to both arguments: they must outlive this object.
  BlockFitter(const Problem& problem, const std::vector<Block>& blocks) : problem_(problem), blocks_(blocks) {
    const Eigen::Index rows = problem.y.size();
    assert(problem.nuisance.rows() == rows && problem.free.rows() == rows && problem.fold.size() == rows);
    own_ = problem.nuisance.cols() + problem.free.cols();
    Eigen::Index width = own_;
    for (const Block& block : blocks) {
      begin_.push_back(width);
      width += block.columns.cols();
      assert(block.columns.rows() == rows);
    }
    Eigen::MatrixXd x(rows, width);
    x.leftCols(problem.nuisance.cols()) = problem.nuisance;
    x.middleCols(problem.nuisance.cols(), problem.free.cols()) = problem.free;
    for (std::size_t i = 0; i < blocks.size(); ++i)
      x.middleCols(begin_[i], blocks[i].columns.cols()) = blocks[i].columns;
    scale_ = Eigen::VectorXd::Ones(width);
    for (Eigen::Index j = 0; j < width; ++j) {
      const double norm = x.col(j).norm();
      if (norm > 0.0 && std::isfinite(norm)) x.col(j) *= scale_[j] = 1.0 / norm;
      else x.col(j).setZero();
    }
    all_ = Sums(x.topRows(0), problem.y.head(0));
    of_.assign(static_cast<std::size_t>(problem.folds), all_);
    for (Eigen::Index begin = 0, end = 0; begin < rows; begin = end) {  // rows of a stretch lie together
      while (end < rows && problem.fold[end] == problem.fold[begin]) ++end;
      const Sums part(x.middleRows(begin, end - begin), problem.y.segment(begin, end - begin));
      of_[static_cast<std::size_t>(problem.fold[begin])].add(part, 1.0);
      all_.add(part, 1.0);
    }
  }

  /// Fits nuisances and these blocks together, and judges the fit on stretches that it has not seen.
  BlockFit fit(const std::vector<std::size_t>& chosen) const {
    BlockFit result = fit_all(chosen);
    const Columns columns = columns_of(chosen);
    for (const Sums& one : of_) {
      if (!(one.target > 0.0)) continue;
      Sums others = all_;
      others.add(one, -1.0);
      result.unseen += one.left(columns.index, others.solve(columns));
    }
    return result;
  }

  /// Fits them on all rows alone.
  BlockFit fit_all(const std::vector<std::size_t>& chosen) const {
    const Columns columns = columns_of(chosen);
    const Eigen::VectorXd solution = all_.solve(columns);
    BlockFit result;
    result.blocks = chosen;
    for (const std::size_t i : chosen) result.directions += static_cast<int>(blocks_[i].columns.cols());
    result.seen = all_.left(columns.index, solution);
    result.coefficients = solution.cwiseProduct(scale_(columns.index));
    return result;
  }

  /// How many blocks there are.
  std::size_t size() const { return blocks_.size(); }

private:
  /// Some of the columns, and the bounds of their coefficients.
  struct Columns {
    std::vector<Eigen::Index> index;
    Eigen::VectorXd lower, upper;
  };

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
    Eigen::VectorXd solve(const Columns& columns) const {
      constexpr double ridge = 1e-8;  // of a column's length: two that are the same share their coefficient
      Eigen::MatrixXd part = square(columns.index, columns.index);
      part.diagonal().array() += ridge;
      return bounded_solve(part, moment(columns.index), columns.lower, columns.upper);
    }
    double left(const std::vector<Eigen::Index>& index, const Eigen::VectorXd& solution) const {
      return std::max(
          0.0, target - 2.0 * solution.dot(moment(index)) + quadratic_form(square(index, index), solution));
    }
  };

  Columns columns_of(const std::vector<std::size_t>& chosen) const {
    Columns columns;
    std::vector<double> lower, upper;
    const auto add = [&](Eigen::Index from, Eigen::Index count, double low, double high) {
      for (Eigen::Index j = from; j < from + count; ++j) {
        columns.index.push_back(j);
        lower.push_back(low / scale_[j]);
        upper.push_back(high / scale_[j]);
      }
    };
    constexpr double unbounded = std::numeric_limits<double>::infinity();
    add(0, problem_.nuisance.cols(), -problem_.slack, problem_.slack);
    add(problem_.nuisance.cols(), problem_.free.cols(), -unbounded, unbounded);
    for (const std::size_t i : chosen) add(begin_[i], blocks_[i].columns.cols(), blocks_[i].lower, unbounded);
    const auto count = static_cast<Eigen::Index>(lower.size());
    columns.lower = Eigen::Map<const Eigen::VectorXd>(lower.data(), count);
    columns.upper = Eigen::Map<const Eigen::VectorXd>(upper.data(), count);
    return columns;
  }

  const Problem& problem_;
  const std::vector<Block>& blocks_;
  Eigen::Index own_ = 0;             // columns of the problem itself
  std::vector<Eigen::Index> begin_;  // first column of each block
  Eigen::VectorXd scale_;            // of each column: makes its length 1
  Sums all_;
  std::vector<Sums> of_;  // of each stretch
};

/// Sum of squares that nuisances within their slack and these columns leave on all rows: cheap enough for a scan.
inline double sum_of_squares_left(const Problem& problem, const Eigen::MatrixXd& columns) {
  const std::vector<Block> block{{columns}};
  return BlockFitter(problem, block).fit_all({0}).seen;
}

}  // namespace thermopower::gap::engine
