// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/normal_equations.hpp>
#include <thermopower/gap/recording.hpp>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/QR>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

/// @file bell_regression.hpp
/// Coefficients of a differential equation from what was recorded, without simulating it: both of its sides are summed up
/// under bells of some rows each. A derivative is then the sum of differences, which noise and missing rows hardly touch.

namespace thermopower::gap::engine {

/// A coefficient of a regression, and how well the data tell it.
struct ToldCoefficient {
  double value = missing;  ///< in the unit of the response by that of the term
  double partial = 0.0;    ///< correlation of term and response beside all other terms, 0..1
  double windows = 0.0;    ///< that told it

  /// Its value by its standard error, as if the windows were independent.
  double significance() const {
    return partial * std::sqrt(windows / std::max(1e-12, 1.0 - partial * partial));
  }
};

/// A linear regression that keeps its rows.
class KeptRegression {
public:
  /// Adds a row; one that holds what is no number is left out.
  void add(const Eigen::VectorXd& terms, double response) {
    if (!terms.allFinite() || !std::isfinite(response)) return;
    assert(terms_.empty() || terms.size() == terms_.front().size());
    terms_.push_back(terms);
    responses_.push_back(response);
  }

  /// Rows added.
  std::size_t rows() const { return terms_.size(); }

  /// All coefficients; empty where the rows are too few for as many.
  std::vector<ToldCoefficient> solve() const {
    constexpr std::size_t rows_a_term = 4;
    if (terms_.empty() || terms_.size() < rows_a_term * static_cast<std::size_t>(terms_.front().size()))
      return {};
    const Eigen::Index count = terms_.front().size(), rows = static_cast<Eigen::Index>(terms_.size());
    Eigen::MatrixXd scaled(rows, count);
    for (Eigen::Index i = 0; i < rows; ++i) scaled.row(i) = terms_[static_cast<std::size_t>(i)];
    Eigen::VectorXd scale = (scaled.colwise().squaredNorm() / static_cast<double>(rows)).cwiseSqrt();
    for (Eigen::Index k = 0; k < count; ++k) {
      if (!(scale[k] > 0.0)) scale[k] = 1.0;
      scaled.col(k) /= scale[k];
    }
    const Eigen::Map<const Eigen::VectorXd> responses(responses_.data(), rows);
    const double rounding = is_rounding * responses.squaredNorm();
    const auto squares = [&](const Eigen::VectorXd& by) {
      return std::max(rounding, (responses - scaled * by).squaredNorm());
    };
    const NormalEquations equations(scaled, responses);
    const Eigen::VectorXd all = equations.solve();
    const double left = squares(all);
    std::vector<ToldCoefficient> list;
    for (Eigen::Index k = 0; k < count; ++k) {
      const double without = squares(equations.solve_without(k));
      const double share = without > 0.0 ? std::clamp(1.0 - left / without, 0.0, 1.0) : 0.0;
      list.push_back({all[k] / scale[k], std::sqrt(share), static_cast<double>(rows)});
    }
    return list;
  }

  /// The least sum of squares where the first terms have coefficients of one sign or none.
  /// @param directed  how many of the first terms have that sign; at most 3
  /// @param sign      1 or -1; 0: their coefficients are 0
  double least_square(Eigen::Index directed, double sign) const {
    assert(!terms_.empty() && directed >= 0 && directed <= terms_.front().size());
    const Eigen::Index count = terms_.front().size(), rows = static_cast<Eigen::Index>(terms_.size());
    Eigen::MatrixXd all(rows, count + 1);
    for (Eigen::Index i = 0; i < rows; ++i)
      all.row(i) << terms_[static_cast<std::size_t>(i)].transpose(), responses_[static_cast<std::size_t>(i)];
    for (Eigen::Index k = 0; k <= count; ++k)
      if (const double size = all.col(k).norm(); size > 0.0) all.col(k) /= size;
    const Eigen::MatrixXd products = all.transpose() * all;
    double least = std::numeric_limits<double>::infinity();
    for (unsigned chosen = 0; chosen < (1U << directed); ++chosen) {
      if (sign == 0.0 && chosen != 0) break;
      std::vector<Eigen::Index> in;
      for (Eigen::Index k = 0; k < count; ++k)
        if ((k >= directed || (chosen >> k & 1U) != 0) && products(k, k) > 0.0) in.push_back(k);
      const auto size = static_cast<Eigen::Index>(in.size());
      Eigen::MatrixXd gram(size, size);
      Eigen::VectorXd with(size);
      for (Eigen::Index i = 0; i < size; ++i) {
        with[i] = products(in[static_cast<std::size_t>(i)], count);
        for (Eigen::Index k = 0; k < size; ++k)
          gram(i, k) = products(in[static_cast<std::size_t>(i)], in[static_cast<std::size_t>(k)]);
        gram(i, i) += 1e-12;
      }
      const Eigen::VectorXd found = gram.ldlt().solve(with);
      bool fits = true;
      for (Eigen::Index i = 0; i < size; ++i)
        fits = fits && (in[static_cast<std::size_t>(i)] >= directed || found[i] * sign >= 0.0);
      if (fits) least = std::min(least, std::max(products(count, count) - with.dot(found), is_rounding));
    }
    return least;
  }

  /// How many rows move the response: of as many equal ones its square beside the terms after the first would consist. One step
  /// of a command is one, however long the recording.
  /// @param first  terms that are left out
  double events(Eigen::Index first) const {
    assert(!terms_.empty() && first >= 0 && first <= terms_.front().size());
    const Eigen::Index rows = static_cast<Eigen::Index>(terms_.size()), count = terms_.front().size() - first;
    Eigen::MatrixXd others(rows, count);
    for (Eigen::Index i = 0; i < rows; ++i) others.row(i) = terms_[static_cast<std::size_t>(i)].tail(count);
    const Eigen::Map<const Eigen::VectorXd> responses(responses_.data(), rows);
    const Eigen::ArrayXd squares =
        (responses - others * others.colPivHouseholderQr().solve(responses)).array().square();
    const double fourth = squares.square().sum();
    return fourth > 0.0 ? squares.sum() * squares.sum() / fourth : 0.0;
  }

private:
  /// Of the responses' sum of squares: an effort that stays the same but for its last digits tells nothing.
  static constexpr double is_rounding = 1e-9;

  std::vector<Eigen::VectorXd> terms_;
  std::vector<double> responses_;
};

/// The rows of a recording in which a signal was read, run by run, and the bells over them.
class ReadRows {
public:
  /// @param values  of the signal; NaN: not read
  ReadRows(const Eigen::VectorXd& t_s, const std::vector<RunSpan>& runs, const Eigen::VectorXd& values)
      : t_s_(t_s) {
    for (const RunSpan& run : runs) {
      std::vector<Eigen::Index> rows;
      for (Eigen::Index i = run.begin; i < run.end; ++i)
        if (std::isfinite(values[i])) rows.push_back(i);
      count_ += rows.size();
      if (rows.size() > 1) runs_.push_back(std::move(rows));
    }
  }

  /// Rows in which it was read.
  std::size_t count() const { return count_; }

  /// One interval between two readings under a bell.
  struct Part {
    Eigen::Index row;    ///< at which it begins
    Eigen::Index next;   ///< at which it ends
    double step_s;       ///< between the two
    double weight;       ///< of the bell in its middle, 0..1
    double slope_per_s;  ///< of the bell there
  };

  /// Hands the parts of each bell to `use(const std::vector<Part>&)`. @param intervals  of a bell
  template <class Use>
  void for_each_bell(std::size_t intervals, Use&& use) const {
    constexpr std::size_t most = 1500;
    constexpr double turn = 6.283185307179586;
    const std::size_t step = std::max((intervals + 1) / 2, count_ / most + 1);
    std::vector<Part> parts(intervals);
    for (const std::vector<Eigen::Index>& rows : runs_)
      for (std::size_t from = 0; from + intervals < rows.size(); from += step) {
        const double start_s = t_s_[rows[from]], length_s = t_s_[rows[from + intervals]] - start_s;
        assert(length_s > 0.0);
        for (std::size_t i = 0; i < intervals; ++i) {
          const Eigen::Index row = rows[from + i], next = rows[from + i + 1];
          const double at = (0.5 * (t_s_[row] + t_s_[next]) - start_s) / length_s;
          parts[i] = {row, next, t_s_[next] - t_s_[row], 0.5 - 0.5 * std::cos(turn * at),
                      0.5 * turn * std::sin(turn * at) / length_s};
        }
        use(parts);
      }
  }

private:
  const Eigen::VectorXd& t_s_;
  std::vector<std::vector<Eigen::Index>> runs_;
  std::size_t count_ = 0;
};

/// A column without holes: the last value before each; NaN before the first. Of an empty one nothing.
inline Eigen::VectorXd last_known(Eigen::VectorXd values, const std::vector<RunSpan>& runs) {
  if (values.size() == 0) return values;
  for (const RunSpan& run : runs)
    for (Eigen::Index i = run.begin + 1; i < run.end; ++i)
      if (!std::isfinite(values[i])) values[i] = values[i - 1];
  return values;
}

}  // namespace thermopower::gap::engine
