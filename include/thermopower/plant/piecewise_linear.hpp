// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <vector>

/// @file piecewise_linear.hpp
/// Functions of a variable without a formula: piecewise linear ones on knots.

namespace thermopower::plant {

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

}  // namespace thermopower::plant
