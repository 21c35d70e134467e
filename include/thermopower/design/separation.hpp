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
  Eigen::MatrixXd open(difference.size(), one.open.cols() + other.open.cols());
  open << one.open, other.open;
  // (I + V V')^-1 = I - V (I + V'V)^-1 V'
  Eigen::MatrixXd inner = open.transpose() * open;
  inner.diagonal().array() += 1.0;
  const Eigen::VectorXd along = open.transpose() * difference;
  return std::sqrt(std::max(difference.squaredNorm() - along.dot(inner.ldlt().solve(along)), 0.0));
}

/// The error of choosing between two normal distributions that are so far apart, each as likely as the other: the share of one beyond
/// the middle. @param separation  in standard deviations, 0 or more
inline double confusion(double separation) { return 0.5 * std::erfc(0.5 * separation / std::sqrt(2.0)); }

/// The separation at which choosing between two explanations fails in one of four experiments: with less they are one class.
inline constexpr double told_apart = 1.35;

/// Separations of all pairs: symmetric, its diagonal is 0.
using Separations = Eigen::MatrixXd;

/// Separations of all pairs of predictions.
inline Separations separations_of(const std::vector<Prediction>& predictions) {
  const auto count = static_cast<Eigen::Index>(predictions.size());
  return Separations::NullaryExpr(count, count, [&](Eigen::Index i, Eigen::Index k) {
    const auto first = static_cast<std::size_t>(std::max(i, k)),
               second = static_cast<std::size_t>(std::min(i, k));
    return i == k ? 0.0 : separation(predictions[first], predictions[second]);
  });
}

/// Explanations and the classes that they make.
///
/// How to: @ref design_the_next_experiment.
struct Classes {
  std::vector<double> weights;     ///< of the explanations, they sum up to 1
  std::vector<std::size_t> label;  ///< class of each, numbered from 0 in the order of their first members
  std::size_t count = 0;           ///< of classes

  /// Puts explanations that nothing tells apart into one class, through others as well.
  /// @param best  the largest separation of each pair that any experiment reached
  Classes(std::vector<double> weights_of, const Separations& best) : weights(std::move(weights_of)) {
    assert(best.rows() == best.cols() && best.rows() == static_cast<Eigen::Index>(weights.size()));
    constexpr auto none = static_cast<std::size_t>(-1);
    label.assign(weights.size(), none);
    const auto take = [&](const auto& self, std::size_t i) -> void {
      label[i] = count;
      for (std::size_t k = 0; k < label.size(); ++k)
        if (label[k] == none && best(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) < told_apart)
          self(self, k);
    };
    for (std::size_t i = 0; i < label.size(); ++i)
      if (label[i] == none) {
        take(take, i);
        ++count;
      }
  }

  /// How often the likeliest class after an experiment is the true one, at least: one less the expected confusions of every pair of
  /// explanations of different classes. A pair is confused at most as often as its rarer one is true.
  double expected_right(const Separations& separations) const {
    assert(separations.rows() == static_cast<Eigen::Index>(weights.size()));
    double right = 1.0;
    for (std::size_t i = 0; i < weights.size(); ++i)
      for (std::size_t k = 0; k < i; ++k)
        if (label[i] != label[k])
          right -= std::min((weights[i] + weights[k]) * confusion(separations(static_cast<Eigen::Index>(i),
                                                                              static_cast<Eigen::Index>(k))),
                            std::min(weights[i], weights[k]));
    return std::max(0.0, right);
  }
};

}  // namespace thermopower::design
