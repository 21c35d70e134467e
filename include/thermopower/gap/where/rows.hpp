// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/sort_by.hpp>
#include <thermopower/gap/recording.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

/// @file
/// Rows as a localisation looks at them: in bins of a variable, and averaged.

namespace thermopower::gap::engine {

/// Rows in bins of a variable, about as many in each. Rows of equal values are in the same one.
class Bins {
public:
  /// The rows of one bin.
  struct Bin {
    double from = 0.0;     ///< least value of the variable
    double to = 0.0;       ///< largest value of the variable
    double sum_at = 0.0;   ///< sum of the variable
    double count = 0.0;    ///< rows in which something is measured
    double sum = 0.0;      ///< sum of what is measured
    double squares = 0.0;  ///< sum of its squares

    double at() const { return sum_at / count; }  ///< mean of the variable
    double mean() const { return sum / count; }   ///< of what is measured
    /// Standard error of the mean.
    double spread() const { return std::sqrt(std::max(0.0, squares / count - mean() * mean()) / count); }
  };

  /// @param variable  one value per row; rows without one are in no bin
  /// @param most      how many bins, 1 or more
  Bins(const Eigen::VectorXd& variable, int most) : variable_(variable) {
    for (Eigen::Index row = 0; row < variable.size(); ++row)
      if (std::isfinite(variable[row])) rows_.push_back(row);
    sort_by(rows_, [&](Eigen::Index row) { return variable[row]; });
    const std::size_t count = rows_.size(), bins = static_cast<std::size_t>(std::max(1, most));
    for (std::size_t k = 1; k <= bins; ++k) {
      std::size_t end = count * k / bins;
      if (end <= (ends_.empty() ? 0 : ends_.back())) continue;
      while (end < count && variable[rows_[end]] == variable[rows_[end - 1]]) ++end;
      ends_.push_back(end);
    }
  }

  /// The bins of what was measured. @param value  one per row, of which those that are not finite are left out
  /// @param shift  rows by which it is moved against the variable, in a circle: 0 to the number of rows
  std::vector<Bin> of(const Eigen::VectorXd& value, Eigen::Index shift = 0) const {
    assert(value.size() == variable_.size() && shift >= 0 && shift <= value.size());
    std::vector<Bin> bins;
    std::size_t at = 0;
    for (const std::size_t end : ends_) {
      Bin bin{variable_[rows_[at]], variable_[rows_[end - 1]]};
      for (; at < end; ++at) {
        const Eigen::Index row = rows_[at] + shift;
        const double v = value[row < value.size() ? row : row - value.size()];
        if (!std::isfinite(v)) continue;
        bin.sum_at += variable_[rows_[at]];
        bin.count += 1.0;
        bin.sum += v;
        bin.squares += v * v;
      }
      if (bin.count > 0.0) bins.push_back(bin);
    }
    return bins;
  }

  /// Share of the variance of what was measured that the means of its bins explain, 0..1. Parameters as for of().
  double correlation_ratio(const Eigen::VectorXd& value, Eigen::Index shift = 0) const {
    double count = 0.0, sum = 0.0, squares = 0.0, of_means = 0.0;
    for (const Bin& one : of(value, shift)) {
      count += one.count;
      sum += one.sum;
      squares += one.squares;
      of_means += one.sum * one.mean();
    }
    const double variance = count > 0.0 ? squares - sum * sum / count : 0.0;
    return variance > 0.0 ? std::clamp((of_means - sum * sum / count) / variance, 0.0, 1.0) : 0.0;
  }

private:
  const Eigen::VectorXd& variable_;
  std::vector<Eigen::Index> rows_;  // in the order of the variable
  std::vector<std::size_t> ends_;   // of each bin in them
};

/// Averages some rows at a time inside each run, so that a million rows cost what ten thousand do.
class Thinning {
public:
  /// @param most  rows that are left, about; rows where `measured` has none do not count into an average
  Thinning(const std::vector<RunSpan>& runs, const Eigen::VectorXd& measured, Eigen::Index most) {
    Eigen::Index rows = 0;
    for (const RunSpan& run : runs) rows += run.size();
    stride_ = std::max<Eigen::Index>(1, (rows + most - 1) / most);
    for (const RunSpan& run : runs)
      for (Eigen::Index i = run.begin; i < run.end; i += stride_) {
        const std::size_t before = kept_.size();
        for (Eigen::Index k = i; k < std::min(i + stride_, run.end); ++k)
          if (std::isfinite(measured[k])) kept_.push_back(k);
        if (kept_.size() > before) end_.push_back(kept_.size());
      }
  }

  /// How many rows are left.
  Eigen::Index rows() const { return static_cast<Eigen::Index>(end_.size()); }
  /// How many rows an average is of, at most.
  Eigen::Index stride() const { return stride_; }

  /// The averages of a column of the full length: rows() of them.
  Eigen::VectorXd operator()(const Eigen::VectorXd& full) const {
    assert(kept_.empty() || kept_.back() < full.size());
    Eigen::VectorXd out(rows());
    std::size_t k = 0;
    for (Eigen::Index i = 0; i < rows(); ++i) {
      const std::size_t begin = k, end = end_[static_cast<std::size_t>(i)];
      double sum = 0.0;
      for (; k < end; ++k) sum += full[kept_[k]];
      out[i] = sum / static_cast<double>(end - begin);
    }
    return out;
  }

private:
  Eigen::Index stride_ = 1;
  std::vector<Eigen::Index> kept_;  // those of the first average, then of the second
  std::vector<std::size_t> end_;    // of each average in them
};

}  // namespace thermopower::gap::engine
