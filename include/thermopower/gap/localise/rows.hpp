// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/recording.hpp>
#include <thermopower/plant/piecewise_linear.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>
#include <vector>

/// @file
/// Rows as a localisation looks at them: ordered into bins, as a spectrum, averaged.

namespace thermopower::gap::engine {

/// Rows sorted into bins of a variable, about as many in each.
class BinnedRows {
public:
  /// @param variable  one value per row; rows without one are in no bin
  BinnedRows(const Eigen::VectorXd& variable, int bins) {
    const std::vector<double> edges = equal_count_edges(variable, bins);
    if (edges.size() < 3) return;
    bands_ = static_cast<Eigen::Index>(edges.size());
    band_.reserve(static_cast<std::size_t>(variable.size()));
    for (const double one : variable) {
      const auto band = std::upper_bound(edges.begin() + 1, edges.end() - 1, one) - edges.begin();
      band_.push_back(std::isfinite(one) ? static_cast<int>(band) : none_);
    }
  }

  /// Share of the variance of `value` that its mean over the bins explains, 0..1.
  /// @param value  one per row; those that are not finite are left out
  /// @param shift  rows by which it is moved against the variable, in a circle; 0 to the number of rows
  double correlation_ratio(const Eigen::VectorXd& value, Eigen::Index shift = 0) const {
    if (bands_ == 0) return 0.0;
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(bands_), count = Eigen::VectorXd::Zero(bands_);
    assert(shift >= 0 && shift <= value.size() && value.size() >= static_cast<Eigen::Index>(band_.size()));
    double total = 0.0, square = 0.0, n = 0.0;
    Eigen::Index at = shift;
    for (const int band : band_) {
      if (at == value.size()) at = 0;
      const double v = value[at++];
      if (band == none_ || !std::isfinite(v)) continue;
      sum[band] += v;
      count[band] += 1.0;
      total += v;
      square += v * v;
      n += 1.0;
    }
    if (n < 4.0) return 0.0;
    const double variance = square - total * total / n;
    double between = -total * total / n;
    for (Eigen::Index k = 0; k < bands_; ++k)
      if (count[k] > 0.0) between += sum[k] * sum[k] / count[k];
    return variance > 0.0 ? std::min(1.0, std::max(0.0, between / variance)) : 0.0;
  }

private:
  static constexpr int none_ = -1;
  Eigen::Index bands_ = 0;  ///< 0: the variable hardly varies
  std::vector<int> band_;   ///< of each row
};

/// The period in s above which half of a residual's power lies (from the cumulated periodogram of at most
/// 2048 block means).
inline double half_power_period(const Eigen::VectorXd& residual, double interval_s) {
  assert(interval_s > 0.0);
  const Eigen::Index block = std::max<Eigen::Index>(1, residual.size() / 1024);
  const Eigen::Index n = residual.size() / block;
  if (n < 8) return 0.0;
  Eigen::VectorXd x(n);
  for (Eigen::Index i = 0; i < n; ++i) x[i] = residual.segment(i * block, block).mean();
  x.array() -= x.mean();
  std::vector<double> power;
  double total = 0.0;
  for (Eigen::Index k = 1; k <= n / 2; ++k) {
    const double w = rad_per_turn * static_cast<double>(k) / static_cast<double>(n);
    double re = 0.0, im = 0.0;
    const double cw = std::cos(w), sw = std::sin(w);
    double c = 1.0, s = 0.0;
    for (Eigen::Index i = 0; i < n; ++i) {
      re += x[i] * c;
      im += x[i] * s;
      const double next = c * cw - s * sw;
      s = s * cw + c * sw;
      c = next;
    }
    power.push_back(re * re + im * im);
    total += power.back();
  }
  double sum = 0.0;
  for (std::size_t k = 0; k < power.size(); ++k) {
    sum += power[k];
    if (sum >= 0.5 * total)
      return interval_s * static_cast<double>(block) * static_cast<double>(n) / static_cast<double>(k + 1);
  }
  return 0.0;
}

/// Averages `stride` rows at a time inside each run, so that a million rows cost what ten thousand do.
class Thinning {
public:
  /// @param most  rows that are left, about; rows where `measured` has none do not count into an average
  Thinning(const std::vector<RunSpan>& runs, const Eigen::VectorXd& measured, Eigen::Index most) {
    Eigen::Index rows = 0;
    for (const RunSpan& run : runs) rows += run.size();
    stride_ = std::max<Eigen::Index>(1, (rows + most - 1) / most);
    for (const RunSpan& run : runs) {
      for (Eigen::Index i = run.begin; i < run.end; i += stride_) {
        const std::size_t before = kept_.size();
        for (Eigen::Index k = i; k < std::min(i + stride_, run.end); ++k) {
          if (std::isfinite(measured[k])) kept_.push_back(k);
        }
        if (kept_.size() > before) end_.push_back(kept_.size());
      }
    }
  }

  /// How many rows are left.
  Eigen::Index rows() const { return static_cast<Eigen::Index>(end_.size()); }
  /// How many rows an average is of, at most.
  Eigen::Index stride() const { return stride_; }

  /// The averages of columns of the full length: as many columns, rows() rows.
  Eigen::MatrixXd operator()(const Eigen::MatrixXd& full) const {
    assert(kept_.empty() || kept_.back() < full.rows());
    Eigen::MatrixXd out(rows(), full.cols());
    for (Eigen::Index column = 0; column < full.cols(); ++column) {
      std::size_t k = 0;
      for (Eigen::Index i = 0; i < rows(); ++i) {
        const std::size_t begin = k, end = end_[static_cast<std::size_t>(i)];
        double sum = 0.0;
        for (; k < end; ++k) sum += full(kept_[k], column);
        out(i, column) = sum / static_cast<double>(end - begin);
      }
    }
    return out;
  }

  /// Which of `count` contiguous stretches each row belongs to, 0 to count - 1.
  Eigen::VectorXi folds(int count) const {
    Eigen::VectorXi fold(rows());
    for (Eigen::Index i = 0; i < rows(); ++i)
      fold[i] = static_cast<int>(i * count / std::max<Eigen::Index>(1, rows()));
    return fold;
  }

private:
  Eigen::Index stride_ = 1;
  std::vector<Eigen::Index> kept_;  // those of the first average, then of the second
  std::vector<std::size_t> end_;    // of each average in them
};

}  // namespace thermopower::gap::engine
