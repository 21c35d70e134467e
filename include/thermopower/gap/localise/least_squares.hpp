// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/linear_solve.hpp>
#include <thermopower/gap/data/matrix_product.hpp>
#include <thermopower/gap/localise/thresholds.hpp>
#include <thermopower/plant/columns.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>
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
  double upper = std::numeric_limits<double>::infinity();   ///< of every coefficient
  int penalty = 0;  ///< directions that a scan tried to find these, counted as parameters
  double at = 0.0;  ///< the value that a scan found best
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
  const Eigen::Index n = moment.size();
  assert(gram.rows() == n && gram.cols() == n && lower.size() == n && upper.size() == n);
  std::vector<int> state(static_cast<std::size_t>(n), 0);  // -1 at lower, 0 free, +1 at upper
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
  for (int round = 0; round < 6 * static_cast<int>(n) + 10; ++round) {
    std::vector<Eigen::Index> open;
    for (Eigen::Index i = 0; i < n; ++i) {
      const int s = state[static_cast<std::size_t>(i)];
      if (s == 0) open.push_back(i);
      if (s < 0) x[i] = lower[i];
      if (s > 0) x[i] = upper[i];
    }
    const Eigen::Index m = static_cast<Eigen::Index>(open.size());
    Eigen::MatrixXd g(m, m);
    Eigen::VectorXd c(m);
    for (Eigen::Index i = 0; i < m; ++i) {
      const Eigen::Index at = open[static_cast<std::size_t>(i)];
      c[i] = moment[at];
      for (Eigen::Index j = 0; j < n; ++j) {
        if (state[static_cast<std::size_t>(j)] != 0) c[i] -= gram(at, j) * x[j];
      }
      for (Eigen::Index j = 0; j < m; ++j) g(i, j) = gram(at, open[static_cast<std::size_t>(j)]);
    }
    const Eigen::VectorXd solved = m > 0 ? SymmetricSystem(g).solve(c) : Eigen::VectorXd();
    Eigen::Index worst = -1;
    double excess = 0.0;
    for (Eigen::Index i = 0; i < m; ++i) {
      const Eigen::Index at = open[static_cast<std::size_t>(i)];
      const double scale = std::sqrt(std::max(gram(at, at), 1e-300));
      const double over = std::max(solved[i] - upper[at], lower[at] - solved[i]) * scale;
      if (over > excess) {
        excess = over;
        worst = i;
      }
    }
    if (worst >= 0) {
      const Eigen::Index at = open[static_cast<std::size_t>(worst)];
      state[static_cast<std::size_t>(at)] = solved[worst] > upper[at] ? 1 : -1;
      continue;
    }
    for (Eigen::Index i = 0; i < m; ++i) x[open[static_cast<std::size_t>(i)]] = solved[i];
    Eigen::Index release = -1;
    double pull = 1e-9;
    for (Eigen::Index i = 0; i < n; ++i) {
      const int s = state[static_cast<std::size_t>(i)];
      if (s == 0) continue;
      const double gradient = (moment[i] - gram.row(i).dot(x)) / std::sqrt(std::max(gram(i, i), 1e-300));
      if (s * gradient < -pull) {
        pull = -s * gradient;
        release = i;
      }
    }
    if (release < 0) break;
    state[static_cast<std::size_t>(release)] = 0;
  }
  return x;
}

/// Sum of squares that nuisances within their slack and these columns leave on all rows: cheap enough for a
/// scan.
inline double sum_of_squares_left(const Problem& problem, const Eigen::MatrixXd& columns) {
  const Eigen::MatrixXd x = plant::beside(plant::beside(problem.nuisance, problem.free), columns);
  assert(x.rows() == problem.y.size());
  const Eigen::Index bounded = problem.nuisance.cols(), width = x.cols();
  const Eigen::MatrixXd square = gram(x);
  Eigen::VectorXd scale(width);
  for (Eigen::Index k = 0; k < width; ++k)
    scale[k] = square(k, k) > 0.0 ? 1.0 / std::sqrt(square(k, k)) : 0.0;
  Eigen::MatrixXd scaled = scaled_both_ways(square, scale);
  for (Eigen::Index k = 0; k < width; ++k) scaled(k, k) += 1e-8;
  const Eigen::VectorXd moment = scale.cwiseProduct(transposed_times(x, problem.y));
  Eigen::VectorXd upper = Eigen::VectorXd::Constant(width, std::numeric_limits<double>::infinity());
  for (Eigen::Index k = 0; k < bounded; ++k) upper[k] = scale[k] > 0.0 ? problem.slack / scale[k] : 0.0;
  const Eigen::VectorXd solution = bounded_solve(scaled, moment, -upper, upper);
  return std::max(0.0,
                  problem.y.squaredNorm() - 2.0 * moment.dot(solution) + quadratic_form(scaled, solution));
}

/// A problem as seen by a set of blocks.
struct BlockFit {
  std::vector<std::size_t> blocks;  ///< which
  std::vector<double> unseen;       ///< sum of squares on each stretch, predicted from the others
  double unseen_total = 0.0;        ///< their sum
  double seen_total = 0.0;          ///< sum of squares left by the fit on all rows
  int directions = 0;               ///< columns of the blocks, with penalties
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
      assert(block.columns.rows() == rows && block.lower <= block.upper);
    }
    Eigen::MatrixXd x(rows, width);
    x.leftCols(problem.nuisance.cols()) = problem.nuisance;
    x.middleCols(problem.nuisance.cols(), problem.free.cols()) = problem.free;
    for (std::size_t i = 0; i < blocks.size(); ++i)
      x.middleCols(begin_[i], blocks[i].columns.cols()) = blocks[i].columns;
    scale_.resize(width);
    for (Eigen::Index j = 0; j < width; ++j) {
      const double norm = x.col(j).norm();
      scale_[j] = norm > 0.0 && std::isfinite(norm) ? 1.0 / norm : 0.0;
      if (scale_[j] > 0.0) {
        x.col(j) *= scale_[j];
      } else {
        x.col(j).setZero();
      }
    }
    const std::size_t folds = static_cast<std::size_t>(problem.folds);
    gram_.assign(folds, Eigen::MatrixXd::Zero(width, width));
    moment_.assign(folds, Eigen::VectorXd::Zero(width));
    square_.assign(folds, 0.0);
    all_ = Eigen::MatrixXd::Zero(width, width);
    all_moment_ = Eigen::VectorXd::Zero(width);
    for (Eigen::Index begin = 0; begin < rows;) {  // rows of a stretch lie together
      Eigen::Index end = begin;
      while (end < rows && problem.fold[end] == problem.fold[begin]) ++end;
      const std::size_t f = static_cast<std::size_t>(problem.fold[begin]);
      const MatrixView part = x.middleRows(begin, end - begin);
      const VectorView target = problem.y.segment(begin, end - begin);
      gram_[f] += gram(part);
      moment_[f] += transposed_times(part, target);
      square_[f] += target.squaredNorm();
      begin = end;
    }
    for (std::size_t f = 0; f < folds; ++f) {
      all_ += gram_[f];
      all_moment_ += moment_[f];
    }
  }

  /// Fits nuisances and these blocks together and judges the fit on stretches it has not seen.
  BlockFit fit(const std::vector<std::size_t>& chosen) const {
    BlockFit result;
    result.blocks = chosen;
    std::vector<Eigen::Index> index;
    for (Eigen::Index j = 0; j < own_; ++j) index.push_back(j);
    for (const std::size_t i : chosen) {
      result.directions += static_cast<int>(blocks_[i].columns.cols()) + blocks_[i].penalty;
      for (Eigen::Index k = 0; k < blocks_[i].columns.cols(); ++k) index.push_back(begin_[i] + k);
    }
    const Eigen::Index width = static_cast<Eigen::Index>(index.size());
    const double unbounded = std::numeric_limits<double>::infinity();
    Eigen::VectorXd lower = Eigen::VectorXd::Constant(width, -unbounded),
                    upper = Eigen::VectorXd::Constant(width, unbounded);
    lower.head(problem_.nuisance.cols()).setConstant(-problem_.slack);
    upper.head(problem_.nuisance.cols()).setConstant(problem_.slack);
    Eigen::Index at = own_;
    for (const std::size_t i : chosen) {
      lower.segment(at, blocks_[i].columns.cols()).setConstant(blocks_[i].lower);
      upper.segment(at, blocks_[i].columns.cols()).setConstant(blocks_[i].upper);
      at += blocks_[i].columns.cols();
    }
    Eigen::VectorXd scale(width);
    for (Eigen::Index j = 0; j < width; ++j) {
      scale[j] = scale_[index[static_cast<std::size_t>(j)]];
      if (scale[j] > 0.0) {
        lower[j] /= scale[j];
        upper[j] /= scale[j];
      }
    }
    const auto part = [&](const Eigen::MatrixXd& full) {
      Eigen::MatrixXd out(width, width);
      for (Eigen::Index r = 0; r < width; ++r) {
        for (Eigen::Index c = 0; c < width; ++c)
          out(r, c) = full(index[static_cast<std::size_t>(r)], index[static_cast<std::size_t>(c)]);
      }
      return out;
    };
    const auto piece = [&](const Eigen::VectorXd& full) {
      Eigen::VectorXd out(width);
      for (Eigen::Index r = 0; r < width; ++r) out[r] = full[index[static_cast<std::size_t>(r)]];
      return out;
    };
    const auto with_ridge = [](Eigen::MatrixXd square) {
      for (Eigen::Index k = 0; k < square.rows(); ++k) square(k, k) += 1e-8;
      return square;
    };
    const Eigen::MatrixXd all = part(all_);
    const Eigen::VectorXd all_moment = piece(all_moment_);
    double squares = 0.0;
    for (const double square : square_) squares += square;
    const Eigen::VectorXd solution = bounded_solve(with_ridge(all), all_moment, lower, upper);
    result.seen_total =
        std::max(0.0, squares - 2.0 * solution.dot(all_moment) + quadratic_form(all, solution));
    result.coefficients = solution.cwiseProduct(scale);
    result.unseen.assign(square_.size(), 0.0);
    for (std::size_t f = 0; f < square_.size(); ++f) {
      if (square_[f] == 0.0) continue;
      const Eigen::MatrixXd own = part(gram_[f]);
      const Eigen::VectorXd own_moment = piece(moment_[f]);
      const Eigen::VectorXd other =
          bounded_solve(with_ridge(all - own), all_moment - own_moment, lower, upper);
      result.unseen[f] = std::max(0.0, square_[f] - 2.0 * other.dot(own_moment) + quadratic_form(own, other));
      result.unseen_total += result.unseen[f];
    }
    return result;
  }

  /// The residuals of the fit, row by row.
  Eigen::VectorXd residual(const BlockFit& fit) const {
    assert(fit.coefficients.size() >= own_);
    Eigen::VectorXd out = problem_.y;
    Eigen::Index at = problem_.nuisance.cols();
    out -= problem_.nuisance * fit.coefficients.head(at);
    out -= problem_.free * fit.coefficients.segment(at, problem_.free.cols());
    at += problem_.free.cols();
    for (const std::size_t i : fit.blocks) {
      out -= blocks_[i].columns * fit.coefficients.segment(at, blocks_[i].columns.cols());
      at += blocks_[i].columns.cols();
    }
    return out;
  }

  /// How many blocks there are.
  std::size_t size() const { return blocks_.size(); }

private:
  const Problem& problem_;
  const std::vector<Block>& blocks_;
  Eigen::Index own_ = 0;
  std::vector<Eigen::Index> begin_;
  Eigen::VectorXd scale_, all_moment_;
  Eigen::MatrixXd all_;
  std::vector<Eigen::MatrixXd> gram_;
  std::vector<Eigen::VectorXd> moment_;
  std::vector<double> square_;
};

/// The outcome of a choice: nothing, one block, or two that act at once.
struct Choice {
  BlockFit none;  ///< re-calibration within slack alone
  BlockFit best;  ///< what was chosen; equal to `none` where nothing is needed
};

/// Of all single blocks and all pairs, the fewest directions that leave no clearly more on unseen stretches
/// than the best.
///
/// @param floor sum of squares that noise alone would leave: a fit that reaches it needs no more
inline Choice choose_blocks(const BlockFitter& fitter, double floor, const LocalisationThresholds& limit) {
  Choice choice;
  choice.none = fitter.fit({});
  choice.best = choice.none;
  // Stretches that bind a constant make prediction of the unseen worse than what was seen: either may say
  // that nothing is missing.
  if (choice.none.seen_total <= limit.nothing_seen * floor &&
      choice.none.unseen_total <= limit.nothing_unseen * floor)
    return choice;
  std::vector<BlockFit> singles;
  std::size_t least = 0;
  for (std::size_t i = 0; i < fitter.size(); ++i) {
    singles.push_back(fitter.fit({i}));
    if (singles[i].unseen_total < singles[least].unseen_total) least = i;
  }
  if (singles.empty()) return choice;
  const auto simplest = [&](const std::vector<BlockFit>& fits, std::size_t best) {
    std::size_t pick = best;
    for (std::size_t i = 0; i < fits.size(); ++i) {
      if (fits[i].directions >= fits[pick].directions) continue;
      const double more = fits[i].unseen_total - fits[best].unseen_total;
      const bool as_good = more <= limit.as_good * fits[best].unseen_total + limit.as_good_floor * floor;
      const bool all_but_a_trace = more <= limit.trace * (choice.none.unseen_total - floor) &&
                                   fits[i].unseen_total < limit.trace_left * floor;
      if (as_good || all_but_a_trace) pick = i;
    }
    return pick;
  };
  const BlockFit single = singles[simplest(singles, least)];
  if (single.unseen_total > limit.no_help * choice.none.unseen_total) return choice;
  choice.best = single;
  if (singles[least].unseen_total <= limit.needs_a_second * floor) return choice;
  std::vector<BlockFit> doubles;
  std::size_t best = 0;
  for (std::size_t i = 0; i < fitter.size(); ++i) {
    for (std::size_t k = i + 1; k < fitter.size(); ++k) {
      doubles.push_back(fitter.fit({i, k}));
      if (doubles.back().unseen_total < doubles[best].unseen_total) best = doubles.size() - 1;
    }
  }
  // A second block must matter: next to the first, and next to all there was to explain.
  const double gained = doubles.empty() ? 0.0 : singles[least].unseen_total - doubles[best].unseen_total;
  if (gained < limit.second_gain * singles[least].unseen_total ||
      gained < limit.second_share * (choice.none.unseen_total - floor))
    return choice;
  choice.best = doubles[simplest(doubles, best)];
  // The one of the two that explains more alone comes first.
  auto& order = choice.best.blocks;
  if (singles[order[1]].unseen_total < singles[order[0]].unseen_total) std::swap(order[0], order[1]);
  choice.best = fitter.fit(order);
  return choice;
}

}  // namespace thermopower::gap::engine
