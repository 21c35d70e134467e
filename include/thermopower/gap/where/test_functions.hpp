// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/balance.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

/// @file
/// Integrals of recorded signals against smooth test functions of compact support, the weak form. No noisy signal is
/// differentiated: the derivative goes to the test function.

namespace thermopower::gap::engine {

/// One integral for each test function: a weighted sum of rows that follow on each other.
class RowIntegrals {
public:
  /// Adds one. @param begin  its first row
  void add(Eigen::Index begin, Eigen::VectorXd weights) { list_.push_back({begin, std::move(weights)}); }

  /// The integrals of values, one per row.
  Eigen::VectorXd of(const Eigen::VectorXd& values) const {
    Eigen::VectorXd out(static_cast<Eigen::Index>(list_.size()));
    for (Eigen::Index i = 0; i < out.size(); ++i) {
      const auto& [begin, weights] = list_[static_cast<std::size_t>(i)];
      assert(begin + weights.size() <= values.size());
      out[i] = values.segment(begin, weights.size()).dot(weights);
    }
    return out;
  }

  /// Standard deviation of the middle one per unit of white noise on the samples; 1 where there is none.
  double gain() const { return list_.empty() ? 1.0 : list_[list_.size() / 2].second.norm(); }

private:
  std::vector<std::pair<Eigen::Index, Eigen::VectorXd>> list_;  // first row and weights
};

/// Test functions \f$ (1 - s^2)^4 \f$ of unit area and one width, half of which overlaps the next one's, and integrals
/// against them.
class TestFunctions {
public:
  /// @param rows      the rows to integrate over
  /// @param needed    none is placed where one of these is missing
  /// @param half_rows half of their width, in rows, >= 1
  /// @param most      that are kept, evenly spread
  TestFunctions(std::shared_ptr<const plant::BalanceRows> rows, const Eigen::VectorXd& needed, int half_rows,
                Eigen::Index most)
      : rows_(std::move(rows)), half_(half_rows * rows_->interval_s) {
    constexpr double longest = 2.5;  // halves between its ends: beyond lies a hole in the stamps
    const Eigen::VectorXd& t_s = rows_->t_s;
    Eigen::Index count = 0, number = 0;
    for (const plant::RunSpan& run : rows_->runs) count += run.size() / std::max(1, half_rows);
    const Eigen::Index keep = std::max<Eigen::Index>(1, (count + most - 1) / most);
    for (const plant::RunSpan& run : rows_->runs)
      for (Eigen::Index i = run.begin + half_rows + 1; i + half_rows + 1 < run.end; i += half_rows) {
        if (number++ % keep != 0 || t_s[i + half_rows] - t_s[i - half_rows] > longest * half_ ||
            !needed.segment(i - half_rows, 2 * half_rows + 1).allFinite())
          continue;
        list_.push_back({i - half_rows, i + half_rows + 1, t_s[i], &run});
        add_weights(list_.back());
      }
  }

  /// How many there are.
  Eigen::Index size() const { return static_cast<Eigen::Index>(list_.size()); }
  /// First row of one of them; they are in the order of these.
  Eigen::Index begin(Eigen::Index i) const { return list_[static_cast<std::size_t>(i)].begin; }

  /// Times values that are straight between their samples, each interval at its mean.
  const RowIntegrals& integral() const { return value_; }
  /// Times the derivative of sampled values.
  const RowIntegrals& derivative() const { return slope_; }
  /// Times values that are held over the interval that starts at their row, `delay_s` later.
  RowIntegrals held(double delay_s = 0.0) const {
    const Eigen::VectorXd& t_s = rows_->t_s;
    RowIntegrals out;
    for (const One& one : list_) {
      const Eigen::Index last = one.end - 1;
      const double end = last + 1 < one.run->end ? t_s[last + 1] : t_s[last] + rows_->interval_s;
      std::vector<double> up_to{
          area(one, end + delay_s)};  // the area before the end of each interval, backwards
      Eigen::Index row = last + 1;
      while (row > one.run->begin && (row > last ? end : t_s[row]) + delay_s > one.middle - half_)
        up_to.push_back(area(one, t_s[--row] + delay_s));
      Eigen::VectorXd weights(last + 1 - row);
      for (Eigen::Index k = 0; k < weights.size(); ++k) {
        const auto after = static_cast<std::size_t>(weights.size() - 1 - k);
        weights[k] = up_to[after] - up_to[after + 1];
      }
      out.add(row, std::move(weights));
    }
    return out;
  }

private:
  struct One {
    Eigen::Index begin, end;    // rows inside its support
    double middle;              // s
    const plant::RunSpan* run;  // that it lies in
  };

  void add_weights(const One& one) {
    const Eigen::VectorXd& t_s = rows_->t_s;
    Eigen::VectorXd value(one.end - one.begin), slope(value.size());
    // Differences of its means over the intervals integrate it times the derivative of a signal without error, if that is
    // straight between its samples. A rate is straight while the torque is held.
    const auto mean_before = [&](Eigen::Index k) {
      return k == one.begin || k == one.end
                 ? 0.0
                 : (area(one, t_s[k]) - area(one, t_s[k - 1])) / (t_s[k] - t_s[k - 1]);
    };
    for (Eigen::Index k = one.begin; k < one.end; ++k) {
      const double from = t_s[std::max(k - 1, one.begin)], to = t_s[std::min(k + 1, one.end - 1)];
      value[k - one.begin] = 0.5 * (area(one, to) - area(one, from));
      slope[k - one.begin] = mean_before(k) - mean_before(k + 1);
    }
    value_.add(one.begin, std::move(value));
    slope_.add(one.begin, std::move(slope));
  }

  /// Integral of a test function up to a time, 0..1.
  double area(const One& one, double t) const {
    const double s = std::clamp((t - one.middle) / half_, -1.0, 1.0), q = s * s;
    return 0.5 + 315.0 / 256.0 * s * (1.0 + q * (-4.0 / 3.0 + q * (6.0 / 5.0 + q * (-4.0 / 7.0 + q / 9.0))));
  }

  std::shared_ptr<const plant::BalanceRows> rows_;
  double half_;  // of their width, s
  std::vector<One> list_;
  RowIntegrals value_, slope_;
};

}  // namespace thermopower::gap::engine
