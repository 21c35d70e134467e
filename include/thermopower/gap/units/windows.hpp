// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/recording.hpp>
#include <thermopower/gap/units/thresholds.hpp>

#include <Eigen/Core>
#include <Eigen/LU>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

/// @file windows.hpp
/// Columns regressed on each other without a simulation: both sides of an equation are averaged under bells of some rows each.
/// A derivative is then a sum of differences, which noise and missing rows hardly touch.

namespace thermopower::gap::engine {

/// A coefficient of a regression, and how well the data tell it.
struct ToldCoefficient {
  double value = missing;  ///< response for each of the term
  double alike = 0.0;      ///< correlation of response and term beside all other terms, 0..1
  double windows = 0.0;    ///< that told it

  /// The value where both err: between the regressions of each on the other.
  double between() const { return value / alike; }
  /// Standard errors from 0, as if the windows were independent.
  double significance() const { return alike * std::sqrt(windows / std::max(1e-12, 1.0 - alike * alike)); }
};

/// The sums of a linear regression.
class WindowRegression {
public:
  /// @param terms  how many
  explicit WindowRegression(Eigen::Index terms) : gram_(Eigen::MatrixXd::Zero(terms + 1, terms + 1)) {}

  /// Adds a window. @param row  its terms, then its response
  void add(const Eigen::RowVectorXd& row) {
    assert(row.size() == gram_.rows());
    if (!row.allFinite()) return;
    gram_.noalias() += row.transpose() * row;
    ++windows_;
  }

  /// Windows added.
  std::size_t windows() const { return windows_; }

  /// The coefficients of all terms.
  std::vector<ToldCoefficient> solve() const {
    const Eigen::Index terms = gram_.rows() - 1;
    std::vector<Eigen::Index> all(static_cast<std::size_t>(terms) + 1);
    std::iota(all.begin(), all.end(), Eigen::Index{0});
    const Eigen::MatrixXd precision = precision_of(all);
    std::vector<ToldCoefficient> told;
    for (Eigen::Index k = 0; k < terms; ++k) {
      const double own = precision(k, k), response = precision(terms, terms), both = -precision(k, terms);
      const bool is_there = gram_(k, k) > 0.0 && gram_(terms, terms) > 0.0;
      told.push_back({is_there ? both / response * std::sqrt(gram_(terms, terms) / gram_(k, k)) : missing,
                      is_there ? std::min(1.0, std::abs(both) / std::sqrt(own * response)) : 0.0,
                      static_cast<double>(windows_)});
    }
    return told;
  }

  /// The share of the response that is left where each of the first terms has a coefficient of one sign, or none.
  /// @param directed  how many of the first terms
  /// @param sign      1 or -1; 0: none of them has one
  double left(Eigen::Index directed, double sign) const {
    const Eigen::Index terms = gram_.rows() - 1;
    assert(directed >= 0 && directed <= terms);
    double least = 1.0;
    for (unsigned chosen = 0; chosen < (sign == 0.0 ? 1U : 1U << directed); ++chosen) {
      std::vector<Eigen::Index> in;
      for (Eigen::Index k = 0; k <= terms; ++k)
        if (k >= directed || (chosen >> k & 1U) != 0) in.push_back(k);
      const Eigen::MatrixXd precision = precision_of(in);
      const Eigen::Index last = precision.rows() - 1;
      bool fits = true;
      for (Eigen::Index i = 0; i < last; ++i)
        fits = fits && (in[static_cast<std::size_t>(i)] >= directed || -precision(i, last) * sign >= 0.0);
      if (fits) least = std::min(least, 1.0 / precision(last, last));
    }
    return least;
  }

private:
  /// The inverse of the sums of some terms and the response, each divided by its size.
  Eigen::MatrixXd precision_of(const std::vector<Eigen::Index>& in) const {
    constexpr double rounding = 1e-9;  // an effort that stays the same but for its last digits tells nothing
    const auto size = static_cast<Eigen::Index>(in.size());
    Eigen::MatrixXd some = Eigen::MatrixXd::Identity(size, size);
    for (Eigen::Index i = 0; i < size; ++i)
      for (Eigen::Index k = 0; k < size; ++k) {
        const Eigen::Index a = in[static_cast<std::size_t>(i)], b = in[static_cast<std::size_t>(k)];
        const double scale = std::sqrt(gram_(a, a) * gram_(b, b));
        if (scale > 0.0) some(i, k) = gram_(a, b) / scale + (i == k ? rounding : 0.0);
      }
    return some.inverse();
  }

  Eigen::MatrixXd gram_;
  std::size_t windows_ = 0;
};

/// The columns that are averaged: for each row the mean of terms and response over the interval after it; NaN: not known.
struct WindowColumns {
  Eigen::MatrixXd columns;  ///< a row each; the response is the last column
  bool curved = false;      ///< the bell makes of the first term its derivative in time
  std::vector<char> moves =
      {};  ///< intervals of which alone the second regression consists; empty: there is none
};

/// The sums under bells of one length: of all windows, and of those that move throughout.
struct WindowSums {
  WindowRegression all;     ///< of all windows
  WindowRegression moving;  ///< of those that move throughout

  /// @param length  intervals of a bell
  WindowSums(const Eigen::VectorXd& t_s, const std::vector<RunSpan>& runs, const WindowColumns& of,
             Eigen::Index length)
      : all(of.columns.cols() - 1), moving(of.columns.cols() - 1) {
    constexpr Eigen::Index most = 1500;  // windows: an order of magnitude needs no more
    constexpr double turn = 6.283185307179586;
    const auto bell_at = [&](double i) {
      return 0.5 - 0.5 * std::cos(turn * i / static_cast<double>(length));
    };
    Eigen::RowVectorXd bell(length), fall(length);
    for (Eigen::Index i = 0; i < length; ++i) {
      const auto at = static_cast<double>(i);
      bell[i] = bell_at(at + 0.5), fall[i] = bell_at(at) - bell_at(at + 1.0);
    }
    const Eigen::Index step = std::max((length + 1) / 2, t_s.size() / most + 1);
    for (const RunSpan& run : runs)
      for (Eigen::Index from = run.begin; from + length < run.end; from += step) {
        const Eigen::RowVectorXd steps_s =
            (t_s.segment(from + 1, length) - t_s.segment(from, length)).transpose();
        Eigen::RowVectorXd row = bell.cwiseProduct(steps_s) * of.columns.middleRows(from, length);
        if (of.curved) row[0] = fall.dot(of.columns.col(0).segment(from, length));
        all.add(row);
        const auto first = of.moves.begin() + static_cast<std::ptrdiff_t>(of.moves.empty() ? 0 : from);
        if (!of.moves.empty() && std::all_of(first, first + length, [](char one) { return one != 0; }))
          moving.add(row);
      }
  }
};

/// Hands the sums of all lengths of bells that have enough windows to `use(const WindowSums&)`.
/// @param of  (Eigen::Index length) -> WindowColumns
template <class Of, class Use>
void for_each_length(const Eigen::VectorXd& t_s, const std::vector<RunSpan>& runs, Of&& of, Use&& use) {
  constexpr Eigen::Index longest = 2048;
  for (Eigen::Index length = 2; length <= std::min(longest, t_s.size()); length *= 2) {
    const WindowSums sums(t_s, runs, of(length), length);
    if (sums.all.windows() < UnitThresholds().windows) break;
    use(sums);
  }
}

/// A column with straight lines between its readings; NaN where it was not read for far longer than it usually is not.
inline Eigen::VectorXd bridged(Eigen::VectorXd column, const std::vector<RunSpan>& runs) {
  constexpr Eigen::Index usual = 8;
  if (column.size() == 0) return column;
  const Eigen::Index longest =
      usual * (column.size() / std::max<Eigen::Index>(1, column.array().isFinite().count()));
  for (const RunSpan& run : runs) {
    Eigen::Index last = run.end;
    for (Eigen::Index i = run.begin; i < run.end; ++i) {
      if (!std::isfinite(column[i])) continue;
      for (Eigen::Index k = last + 1; k < i && i - last <= longest; ++k)
        column[k] = column[last] + (column[i] - column[last]) * static_cast<double>(k - last) /
                                       static_cast<double>(i - last);
      last = i;
    }
  }
  return column;
}

/// The mean of a column over the interval after each row.
inline Eigen::VectorXd interval_means(const Eigen::VectorXd& column) {
  Eigen::VectorXd mean = column;
  const Eigen::Index n = column.size() - 1;
  if (n > 0) mean.head(n) = 0.5 * (column.head(n) + column.tail(n));
  return mean;
}

/// The slope of a column over the interval after each row.
inline Eigen::VectorXd interval_slopes(const Eigen::VectorXd& t_s, const Eigen::VectorXd& column) {
  Eigen::VectorXd slope = Eigen::VectorXd::Zero(column.size());
  const Eigen::Index n = column.size() - 1;
  if (n > 0) slope.head(n) = (column.tail(n) - column.head(n)).cwiseQuotient(t_s.tail(n) - t_s.head(n));
  return slope;
}

}  // namespace thermopower::gap::engine
