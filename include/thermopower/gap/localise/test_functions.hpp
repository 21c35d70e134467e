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

/// Test functions \f$ (1 - s^2)^4 \f$ of unit area and one width, half of which overlaps the next one's, and integrals
/// against them.
class TestFunctions {
public:
  /// One of them.
  struct One {
    Eigen::Index begin;   ///< first row inside its support
    Eigen::Index end;     ///< one past the last
    double middle;        ///< s
    double half;          ///< half of its width, s
    std::size_t weights;  ///< where its weights begin
  };

  /// @param rows      the rows to integrate over
  /// @param needed    none is placed where one of these is missing
  /// @param half_rows half of their width, in rows, >= 1
  /// @param most      that are kept, evenly spread
  TestFunctions(std::shared_ptr<const plant::BalanceRows> rows, const Eigen::VectorXd& needed, int half_rows,
                Eigen::Index most)
      : rows_(std::move(rows)), a_(*rows_) {
    const double half = half_rows * a_.interval_s;
    Eigen::Index count = 0;
    for (const plant::RunSpan& run : a_.runs) count += run.size() / std::max(1, half_rows);
    const Eigen::Index keep = std::max<Eigen::Index>(1, (count + most - 1) / most);
    Eigen::Index number = 0;
    for (const plant::RunSpan& run : a_.runs) {
      for (Eigen::Index i = run.begin + half_rows + 1; i + half_rows + 1 < run.end; i += half_rows) {
        if (number++ % keep != 0) continue;
        if (a_.t_s[i + half_rows] - a_.t_s[i - half_rows] > 2.5 * half) continue;  // a hole in the stamps
        One one{i - half_rows, i + half_rows + 1, a_.t_s[i], half, value_.size()};
        bool whole = true;
        for (Eigen::Index k = one.begin; k < one.end; ++k) whole = whole && std::isfinite(needed[k]);
        if (!whole) continue;
        list_.push_back(one);
        for (Eigen::Index k = one.begin; k < one.end; ++k) {
          const double from = k == one.begin ? a_.t_s[k] : a_.t_s[k - 1],
                       to = k + 1 == one.end ? a_.t_s[k] : a_.t_s[k + 1];
          value_.push_back(0.5 * (area(one, to) - area(one, from)));
          slope_.push_back(mean_before(one, k) - mean_before(one, k + 1));
        }
      }
    }
  }

  /// How many there are.
  Eigen::Index size() const { return static_cast<Eigen::Index>(list_.size()); }
  /// Each of them, in the order of the rows they begin at.
  const std::vector<One>& list() const { return list_; }

  /// Integral of the test function times values that are straight between their samples, each interval at its mean.
  Eigen::VectorXd integral(const Eigen::VectorXd& values) const { return sum(value_, values); }

  /// Integral of the test function times the derivative of sampled values.
  Eigen::VectorXd derivative(const Eigen::VectorXd& values) const { return sum(slope_, values); }

  /// The weights of held values in the integrals of all the test functions.
  struct HeldWeights {
    std::vector<double> weights;     ///< of a function's rows, the last of them first; then of the next one's
    std::vector<Eigen::Index> last;  ///< row of each function
    std::vector<std::size_t> end;    ///< of each function's weights
  };

  /// The weights of values that are held over the interval that starts at their row, `delay_s` later.
  HeldWeights held_weights(double delay_s) const {
    HeldWeights held;
    for (const One& one : list_) {
      const plant::RunSpan& run = run_of(one.begin);
      const Eigen::Index last = one.end - 1;
      double to = (last + 1 < run.end ? a_.t_s[last + 1] : a_.t_s[last] + a_.interval_s) + delay_s;
      double up_to = area(one, to);
      for (Eigen::Index k = last; k >= run.begin && to > one.middle - one.half; --k) {
        const double from = a_.t_s[k] + delay_s, up_to_from = area(one, from);
        held.weights.push_back(up_to - up_to_from);
        to = from;  // the interval before ends where this one begins
        up_to = up_to_from;
      }
      held.last.push_back(last);
      held.end.push_back(held.weights.size());
    }
    return held;
  }

  /// Integral of the test function times held values.
  static Eigen::VectorXd integral(const HeldWeights& held, const Eigen::VectorXd& values) {
    Eigen::VectorXd out = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(held.last.size()));
    std::size_t at = 0;
    for (std::size_t r = 0; r < held.last.size(); ++r) {
      Eigen::Index row = held.last[r];
      double sum = 0.0;
      for (; at < held.end[r]; ++at) sum += values[row--] * held.weights[at];
      out[static_cast<Eigen::Index>(r)] = sum;
    }
    return out;
  }

  /// The same of values that are held `delay_s` after their row.
  Eigen::VectorXd held_integral(const Eigen::VectorXd& values, double delay_s = 0.0) const {
    return integral(held_weights(delay_s), values);
  }

  /// Standard deviation of derivative() per unit of white noise on the samples; 1 where there is none.
  double derivative_gain() const { return gain(slope_); }

  /// Standard deviation of integral() per unit of white noise on the samples; 1 where there is none.
  double integral_gain() const { return gain(value_); }

private:
  double gain(const std::vector<double>& weights) const {
    assert(weights.size() == value_.size());
    if (list_.empty()) return 1.0;
    const One& one = list_[list_.size() / 2];
    double sum = 0.0;
    for (Eigen::Index k = 0; k < one.end - one.begin; ++k)
      sum += std::pow(weights[one.weights + static_cast<std::size_t>(k)], 2.0);
    return std::sqrt(sum);
  }
  // Mean of the test function over the interval that ends at a row. Differences of such means integrate the test function
  // times the derivative of a signal without error, if it is straight between its samples. A rate is straight while the
  // torque is held.
  double mean_before(const One& one, Eigen::Index k) const {
    if (k == one.begin || k == one.end) return 0.0;
    return (area(one, a_.t_s[k]) - area(one, a_.t_s[k - 1])) / (a_.t_s[k] - a_.t_s[k - 1]);
  }
  double area(const One& one, double t) const {  // integral of the test function up to t
    const double s = std::min(1.0, std::max(-1.0, (t - one.middle) / one.half)), q = s * s;
    return 0.5 + 315.0 / 256.0 * s * (1.0 + q * (-4.0 / 3.0 + q * (6.0 / 5.0 + q * (-4.0 / 7.0 + q / 9.0))));
  }
  const plant::RunSpan& run_of(Eigen::Index row) const {
    for (const plant::RunSpan& run : a_.runs) {
      if (row >= run.begin && row < run.end) return run;
    }
    return a_.runs.front();
  }
  Eigen::VectorXd sum(const std::vector<double>& weights, const Eigen::VectorXd& values) const {
    assert(list_.empty() || values.size() >= list_.back().end);
    Eigen::VectorXd out(size());
    for (Eigen::Index r = 0; r < size(); ++r) {
      const One& one = list_[static_cast<std::size_t>(r)];
      out[r] = values.segment(one.begin, one.end - one.begin)
                   .dot(Eigen::Map<const Eigen::VectorXd>(weights.data() + one.weights, one.end - one.begin));
    }
    return out;
  }

  std::shared_ptr<const plant::BalanceRows> rows_;
  const plant::BalanceRows& a_;
  std::vector<One> list_;
  std::vector<double> value_, slope_;  ///< weights of values and of derivatives, one after the other
};

}  // namespace thermopower::gap::engine
