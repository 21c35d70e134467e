// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/recording.hpp>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

/// @file rows.hpp
/// Columns as a localisation needs them: without holes, ordered into bins, thinned.

namespace thermopower::gap::detail {

/// Missing values take the last one before them (the next one at the beginning); all missing: `otherwise`.
inline Eigen::VectorXd held(const Eigen::VectorXd* values, const std::vector<RunSpan>& runs,
                            Eigen::Index rows, double otherwise) {
  if (values == nullptr) return Eigen::VectorXd::Constant(rows, otherwise);
  Eigen::VectorXd out = *values;
  for (const RunSpan& run : runs) {
    double last = otherwise;
    for (Eigen::Index i = run.begin; i < run.end; ++i) {
      if (std::isfinite(out[i])) {
        last = out[i];
        break;
      }
    }
    for (Eigen::Index i = run.begin; i < run.end; ++i) {
      if (std::isfinite(out[i])) {
        last = out[i];
      } else {
        out[i] = last;
      }
    }
  }
  return out;
}

/// Standard deviation of the noise on a smooth signal: from second or fourth differences, whichever see less
/// of the signal, and no less than the quantum allows.
inline double noise_of(const Eigen::VectorXd& values, const std::vector<RunSpan>& runs) {
  std::vector<double> second, fourth;
  double quantum = 0.0;
  for (const RunSpan& run : runs) {
    for (Eigen::Index i = run.begin + 2; i + 2 < run.end; ++i) {
      const double two = values[i - 1] - 2.0 * values[i] + values[i + 1];
      const double four =
          values[i - 2] - 4.0 * values[i - 1] + 6.0 * values[i] - 4.0 * values[i + 1] + values[i + 2];
      if (!std::isfinite(four)) continue;
      second.push_back(two * two / 6.0);
      fourth.push_back(four * four / 70.0);
      const double step = std::fabs(values[i + 1] - values[i]);
      if (step > 1e-12 && (quantum == 0.0 || step < quantum)) quantum = step;
    }
  }
  if (second.empty()) return 0.0;
  // A trimmed mean: steps of the input are no noise. The divisor is what the tail takes from a normal
  // sample's variance.
  const auto trimmed = [](std::vector<double>& squares) {
    const std::size_t kept = std::max<std::size_t>(1, squares.size() * 95 / 100);
    std::nth_element(squares.begin(), squares.begin() + static_cast<std::ptrdiff_t>(kept - 1), squares.end());
    double sum = 0.0;
    for (std::size_t i = 0; i < kept; ++i) sum += squares[i];
    return std::sqrt(sum / static_cast<double>(kept) / 0.79);
  };
  return std::max(std::min(trimmed(second), trimmed(fourth)), quantum / std::sqrt(12.0));
}

/// Values that split a sample into `count` parts of equal size: count + 1 of them, distinct.
inline std::vector<double> equal_count_edges(const Eigen::VectorXd& values, int count) {
  std::vector<double> sorted;
  const Eigen::Index stride = values.size() / 20000 + 1;
  for (Eigen::Index i = 0; i < values.size(); i += stride) {
    if (std::isfinite(values[i])) sorted.push_back(values[i]);
  }
  std::sort(sorted.begin(), sorted.end());
  std::vector<double> edges;
  if (sorted.empty()) return edges;
  for (int k = 0; k <= count; ++k) {
    const std::size_t at = static_cast<std::size_t>(static_cast<double>(sorted.size() - 1) * k / count);
    if (edges.empty() || sorted[at] > edges.back() + 1e-12 * std::max(1.0, std::fabs(edges.back())))
      edges.push_back(sorted[at]);
  }
  return edges;
}

/// Piecewise linear functions of `values`, one per knot, that sum to 1 inside the knots' range.
inline Eigen::MatrixXd hats(const Eigen::VectorXd& values, const std::vector<double>& knots) {
  const Eigen::Index n = static_cast<Eigen::Index>(knots.size());
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(values.size(), n);
  if (n == 0) return out;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    const double x = values[i];
    if (!std::isfinite(x)) continue;
    const auto above = std::upper_bound(knots.begin(), knots.end(), x);
    if (above == knots.begin()) {
      out(i, 0) = 1.0;
    } else if (above == knots.end()) {
      out(i, n - 1) = 1.0;
    } else {
      const Eigen::Index k = above - knots.begin();
      const double from = knots[static_cast<std::size_t>(k - 1)], to = knots[static_cast<std::size_t>(k)];
      out(i, k) = (x - from) / (to - from);
      out(i, k - 1) = 1.0 - out(i, k);
    }
  }
  return out;
}

/// Hats on knots at equal counts.
inline Eigen::MatrixXd hats(const Eigen::VectorXd& values, int count) {
  return hats(values, equal_count_edges(values, count - 1));
}

/// Hats on evenly spaced knots.
inline Eigen::MatrixXd even_hats(const Eigen::VectorXd& values, int count) {
  const double from = values.minCoeff(), to = values.maxCoeff();
  std::vector<double> knots;
  for (int k = 0; k < count && to > from; ++k) knots.push_back(from + (to - from) * k / (count - 1));
  return hats(values, knots);
}

/// Each column of `columns` times `factor`, row by row.
inline Eigen::MatrixXd scaled(const Eigen::MatrixXd& columns, const Eigen::VectorXd& factor) {
  return (columns.array().colwise() * factor.array()).matrix();
}

/// Share of the variance of `value` that the mean over bins of `variable` explains, 0..1.
inline double correlation_ratio(const Eigen::VectorXd& value, const Eigen::VectorXd& variable, int bins,
                                Eigen::Index shift = 0) {
  const std::vector<double> edges = equal_count_edges(variable, bins);
  if (edges.size() < 3) return 0.0;
  const Eigen::Index bands = static_cast<Eigen::Index>(edges.size());
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(bands), count = Eigen::VectorXd::Zero(bands);
  double total = 0.0, square = 0.0, n = 0.0;
  for (Eigen::Index i = 0; i < value.size(); ++i) {
    const double v = value[(i + shift) % value.size()];
    if (!std::isfinite(v) || !std::isfinite(variable[i])) continue;
    const Eigen::Index k = std::upper_bound(edges.begin() + 1, edges.end() - 1, variable[i]) - edges.begin();
    sum[k] += v;
    count[k] += 1.0;
    total += v;
    square += v * v;
    n += 1.0;
  }
  if (n < 4.0) return 0.0;
  const double variance = square - total * total / n;
  double between = -total * total / n;
  for (Eigen::Index k = 0; k < bands; ++k) {
    if (count[k] > 0.0) between += sum[k] * sum[k] / count[k];
  }
  return variance > 0.0 ? std::min(1.0, std::max(0.0, between / variance)) : 0.0;
}

/// The period in s above which half of a residual's power lies (from the cumulated periodogram of at most
/// 2048 block means).
inline double half_power_period(const Eigen::VectorXd& residual, double interval_s) {
  const Eigen::Index block = std::max<Eigen::Index>(1, residual.size() / 1024);
  const Eigen::Index n = residual.size() / block;
  if (n < 8) return 0.0;
  Eigen::VectorXd x(n);
  for (Eigen::Index i = 0; i < n; ++i) x[i] = residual.segment(i * block, block).mean();
  x.array() -= x.mean();
  std::vector<double> power;
  double total = 0.0;
  for (Eigen::Index k = 1; k <= n / 2; ++k) {
    const double w = 2.0 * 3.14159265358979323846 * static_cast<double>(k) / static_cast<double>(n);
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

constexpr Eigen::Index localisation_rows = 8000;

/// Averages `stride` rows at a time inside each run, so that a million rows cost what ten thousand do.
class Thinning {
public:
  Thinning(const std::vector<RunSpan>& runs, const Eigen::VectorXd& measured, Eigen::Index most) {
    Eigen::Index rows = 0;
    for (const RunSpan& run : runs) rows += run.size();
    stride_ = std::max<Eigen::Index>(1, (rows + most - 1) / most);
    for (const RunSpan& run : runs) {
      for (Eigen::Index i = run.begin; i < run.end; i += stride_) {
        std::vector<Eigen::Index> list;
        for (Eigen::Index k = i; k < std::min(i + stride_, run.end); ++k) {
          if (std::isfinite(measured[k])) list.push_back(k);
        }
        if (!list.empty()) rows_.push_back(std::move(list));
      }
    }
  }

  Eigen::Index rows() const { return static_cast<Eigen::Index>(rows_.size()); }
  Eigen::Index stride() const { return stride_; }

  Eigen::MatrixXd operator()(const Eigen::MatrixXd& full) const {
    Eigen::MatrixXd out(rows(), full.cols());
    for (Eigen::Index i = 0; i < rows(); ++i) {
      const auto& list = rows_[static_cast<std::size_t>(i)];
      Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(full.cols());
      for (const Eigen::Index k : list) sum += full.row(k);
      out.row(i) = sum / static_cast<double>(list.size());
    }
    return out;
  }

  Eigen::VectorXi folds(int count) const {
    Eigen::VectorXi fold(rows());
    for (Eigen::Index i = 0; i < rows(); ++i)
      fold[i] = static_cast<int>(i * count / std::max<Eigen::Index>(1, rows()));
    return fold;
  }

private:
  Eigen::Index stride_ = 1;
  std::vector<std::vector<Eigen::Index>> rows_;
};

}  // namespace thermopower::gap::detail
