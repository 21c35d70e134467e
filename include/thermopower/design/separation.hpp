// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/design/prediction.hpp>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <vector>

namespace thermopower::design {

/// How far apart two explanations are in an experiment, in standard deviations of everything that is uncertain:
/// \f$ T = d^T (I + V_1 V_1^T + V_2 V_2^T)^{-1} d \f$ with the difference d of their predictions in units of the noise, and
/// what their parameters leave open of them, V. This is the criterion of Buzzi-Ferraris, Forzatti, Emig and Hofmann (Chem. Eng.
/// Sci. 39 (1984) 81-85) for two models; a difference that other parameters make up for does not count.
/// @return the square root of T, 0 or more
inline double separation(const Prediction& one, const Prediction& other) {
  assert(one.middle.size() == other.middle.size());
  const Eigen::VectorXd difference = one.middle - other.middle;
  const Eigen::Index count = one.open.cols() + other.open.cols();
  double square = difference.squaredNorm();
  if (count > 0) {
    Eigen::MatrixXd open(difference.size(), count);
    open << one.open, other.open;
    // (I + V V')^-1 = I - V (I + V'V)^-1 V'
    Eigen::MatrixXd inner = open.transpose() * open;
    inner.diagonal().array() += 1.0;
    const Eigen::VectorXd along = open.transpose() * difference;
    square -= along.dot(inner.ldlt().solve(along));
  }
  return std::sqrt(std::max(square, 0.0));
}

/// The error of choosing between two normal distributions that are so far apart, each as likely as the other: the share of one beyond
/// the middle. @param separation  in standard deviations, 0 or more
inline double confusion(double separation) { return 0.5 * std::erfc(0.5 * separation / std::sqrt(2.0)); }

/// The separation at which choosing between two explanations fails in one of twenty experiments.
inline constexpr double told_apart = 3.29;

/// Separations of all pairs: symmetric, its diagonal is 0.
using Separations = Eigen::MatrixXd;

/// Separations of all pairs of predictions.
inline Separations separations_of(const std::vector<Prediction>& predictions) {
  const auto count = static_cast<Eigen::Index>(predictions.size());
  Separations all = Separations::Zero(count, count);
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index k = 0; k < i; ++k)
      all(i, k) = all(k, i) =
          separation(predictions[static_cast<std::size_t>(i)], predictions[static_cast<std::size_t>(k)]);
  return all;
}

/// Puts explanations that nothing tells apart into one class.
/// @param best  the largest separation of each pair that any experiment reached
/// @return the class of each explanation, numbered from 0 in the order of their first members
inline std::vector<std::size_t> classes_of(const Separations& best) {
  assert(best.rows() == best.cols());
  const auto count = static_cast<std::size_t>(best.rows());
  std::vector<std::size_t> label(count);
  for (std::size_t i = 0; i < count; ++i) label[i] = i;
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t k = 0; k < i; ++k)
      if (best(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) < told_apart) {
        const std::size_t from = std::max(label[i], label[k]), to = std::min(label[i], label[k]);
        for (std::size_t& one : label)
          if (one == from) one = to;
      }
  std::vector<std::size_t> order;
  for (std::size_t& one : label) {
    const auto found = std::find(order.begin(), order.end(), one);
    if (found == order.end()) order.push_back(one);
    one = static_cast<std::size_t>(std::find(order.begin(), order.end(), one) - order.begin());
  }
  return label;
}

/// How often the likeliest class after the experiment is the true one, at least: one less the expected confusions of every pair of
/// explanations of different classes. A pair is confused at most as often as its rarer one is true.
/// @param weights  of the explanations, they sum up to 1
/// @param label    class of each
inline double expected_right(const Separations& separations, const std::vector<double>& weights,
                             const std::vector<std::size_t>& label) {
  assert(label.size() == weights.size() && separations.rows() == static_cast<Eigen::Index>(weights.size()));
  double wrong = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      if (label[i] == label[k]) continue;
      const double often = (weights[i] + weights[k]) *
                           confusion(separations(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)));
      wrong += std::min(often, std::min(weights[i], weights[k]));
    }
  return std::max(0.0, 1.0 - wrong);
}

}  // namespace thermopower::design
