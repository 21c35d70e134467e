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

/// The piecewise linear function of `values` that is 1 at a knot and 0 at the others; beyond the outermost knots it stays
/// what it is there, and 0 where a value is missing.
/// @param k  the knot's place, 0 to knots.size() - 1
inline Eigen::VectorXd hat(const Eigen::VectorXd& values, const std::vector<double>& knots, Eigen::Index k) {
  const auto at = static_cast<std::size_t>(k);
  const bool first = k == 0, last = at + 1 == knots.size();
  const auto rise = [&](double x, std::size_t to) {
    return (x - knots[to - 1]) / (knots[to] - knots[to - 1]);
  };
  Eigen::VectorXd out(values.size());
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    const double x = values[i];
    if (!std::isfinite(x)) out[i] = 0.0;
    else if (x < knots[at]) out[i] = first ? 1.0 : x < knots[at - 1] ? 0.0 : rise(x, at);
    else out[i] = last ? 1.0 : x >= knots[at + 1] ? 0.0 : 1.0 - rise(x, at + 1);
  }
  return out;
}

/// The hats of all knots, one column each: they sum to 1.
inline Eigen::MatrixXd hats(const Eigen::VectorXd& values, const std::vector<double>& knots) {
  Eigen::MatrixXd out(values.size(), static_cast<Eigen::Index>(knots.size()));
  for (Eigen::Index k = 0; k < out.cols(); ++k) out.col(k) = hat(values, knots, k);
  return out;
}

/// Hats on knots at equal counts.
inline Eigen::MatrixXd hats(const Eigen::VectorXd& values, int count) {
  return hats(values, equal_count_edges(values, count - 1));
}

/// Evenly spaced knots over the range of some values; none where they are all the same.
inline std::vector<double> even_knots(const Eigen::VectorXd& values, int count) {
  const double from = values.minCoeff(), to = values.maxCoeff();
  std::vector<double> knots;
  for (int k = 0; k < count && to > from; ++k) knots.push_back(from + (to - from) * k / (count - 1));
  return knots;
}

/// Hats on evenly spaced knots.
inline Eigen::MatrixXd even_hats(const Eigen::VectorXd& values, int count) {
  return hats(values, even_knots(values, count));
}

/// Each column of `columns` times `factor`, row by row.
inline Eigen::MatrixXd scaled(const Eigen::MatrixXd& columns, const Eigen::VectorXd& factor) {
  return (columns.array().colwise() * factor.array()).matrix();
}

}  // namespace thermopower::plant
