// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/pool/statistics.hpp>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <vector>

namespace thermopower::gap::pool {

/// The parameters of one unit by its data: a normal distribution around an estimate.
struct Estimate {
  Eigen::VectorXd at;          ///< the estimate; k coordinates
  Eigen::MatrixXd covariance;  ///< of its error, k by k, positive semidefinite
};

/// Inverse of a symmetric positive definite matrix: information of a covariance, and back. @param matrix  k by k
inline Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& matrix) {
  assert(matrix.rows() == matrix.cols());
  return matrix.ldlt().solve(Eigen::MatrixXd::Identity(matrix.rows(), matrix.cols()));
}

/// How units spread: y_i ~ N(mean, between + V_i), V_i the covariance of unit i's estimate.
///
/// The spread between units by restricted maximum likelihood, with the EM iteration of Laird & Ware (1982). The mean is by
/// generalised least squares, and its covariance that of the inverse weights.
///
/// @snippet plant_examples.cpp fleet
/// How to: @ref diagnose_a_fleet.
struct MixedEffects {
  Eigen::VectorXd mean;             ///< of the units, k; empty where there were fewer than two
  Eigen::MatrixXd mean_covariance;  ///< of the mean's error
  Eigen::MatrixXd between;          ///< between units, k by k
  std::size_t units = 0;            ///< that it was made of
  Eigen::VectorXd
      heterogeneity_p;  ///< by coordinate: probability of such a spread were all units alike (Cochran's Q)
  Eigen::VectorXd information;  ///< by coordinate: 2 over the variance of the error of `between`'s diagonal
  Eigen::VectorXd degrees;      ///< by coordinate: degrees of freedom of the mean's error (Satterthwaite)
  /// By coordinate: those that the spread itself is known to, in units of the most precise estimate's variance. With few
  /// or imprecise units there are few, and what rests on the spread says so by being wide.
  Eigen::VectorXd between_degrees;

  /// How many coordinates there are.
  Eigen::Index size() const { return mean.size(); }
};

/// Fits the spread of units. Estimates must have one size and finite numbers.
inline MixedEffects fit_mixed_effects(const std::vector<Estimate>& units) {
  constexpr int most = 200;
  constexpr double settled = 1e-5;  // largest relative change of the spread in one iteration
  MixedEffects result;
  result.units = units.size();
  if (units.size() < 2) return result;
  const Eigen::Index k = units.front().at.size(), n = static_cast<Eigen::Index>(units.size());
  Eigen::MatrixXd at(k, n);
  Eigen::ArrayXXd variance(k, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    at.col(i) = units[static_cast<std::size_t>(i)].at;
    variance.col(i) = units[static_cast<std::size_t>(i)].covariance.diagonal();
  }
  // Begins at the spread of the estimates themselves. Where all are equal there is nothing to iterate on, and nothing to divide
  // by; nor does a spread fall below what numbers of that size resolve.
  Eigen::VectorXd& mean = result.mean = at.rowwise().mean();
  Eigen::MatrixXd& between = result.between;
  const Eigen::MatrixXd away = at.colwise() - mean;
  const Eigen::ArrayXd squared_size = 1.0 + mean.array().square();
  between = away * away.transpose() / static_cast<double>(n - 1);
  between.diagonal().array() += 1e-12 * squared_size;
  std::vector<Eigen::MatrixXd> weights(units.size());
  Eigen::MatrixXd& error = result.mean_covariance;
  const auto weigh = [&] {
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(k, k);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(k);
    for (std::size_t i = 0; i < units.size(); ++i) {
      weights[i] = inverse_of(units[i].covariance + between);
      sum += weights[i];
      right += weights[i] * units[i].at;
    }
    error = inverse_of(sum);
    mean = error * right;
  };
  for (int iteration = 0; iteration < most; ++iteration) {
    weigh();
    Eigen::MatrixXd push = Eigen::MatrixXd::Zero(k, k);
    for (std::size_t i = 0; i < units.size(); ++i) {
      const Eigen::VectorXd pull = weights[i] * (units[i].at - mean);
      push += pull * pull.transpose() - weights[i] + weights[i] * error * weights[i];
    }
    const Eigen::MatrixXd step = between * push * between / static_cast<double>(n);
    between += step;
    between = 0.5 * (between + between.transpose()).eval();
    between.diagonal() = between.diagonal().cwiseMax((1e-24 * squared_size).matrix()).eval();
    if ((step.diagonal().array().abs() < settled * between.diagonal().array()).all()) break;
  }
  weigh();
  assert(!(between.diagonal().array() < 0.0).any());
  const Eigen::ArrayXXd own = variance.max(1e-300).inverse(),
                        whole = (variance.colwise() + between.diagonal().array()).inverse();
  const Eigen::ArrayXd pooled = (own * at.array()).rowwise().sum() / own.rowwise().sum(),
                       q = (own * (at.array().colwise() - pooled).square()).rowwise().sum(),
                       squares = whole.square().rowwise().sum(), sum = whole.rowwise().sum(),
                       largest = whole.rowwise().maxCoeff();
  result.heterogeneity_p =
      q.unaryExpr([&](double one) { return chi2_tail(one, static_cast<double>(n - 1)); });
  result.information = squares;
  result.degrees = (sum.square() / squares - 1.0).max(1.0);
  result.between_degrees = (squares / largest.square() - 1.0).max(1.0);
  return result;
}

/// A unit's own values, given its estimate and the fleet it is one of: the less precise it is, the more it is drawn to the mean. The
/// covariance is that of the error, the mean's included. That the spread is an estimate, too, widens it (Morris 1983; here coordinate
/// by coordinate).
inline Estimate shrink(const MixedEffects& fleet, const Estimate& unit) {
  const Eigen::Index k = fleet.size();
  assert(unit.at.size() == k && unit.covariance.rows() == k && unit.covariance.cols() == k);
  const Eigen::VectorXd away = unit.at - fleet.mean;
  const Eigen::MatrixXd gain = fleet.between * inverse_of(unit.covariance + fleet.between);
  const Eigen::MatrixXd rest = Eigen::MatrixXd::Identity(k, k) - gain;
  Estimate result{fleet.mean + gain * away,
                  fleet.between - gain * fleet.between + rest * fleet.mean_covariance * rest.transpose()};
  const Eigen::ArrayXd own = unit.covariance.diagonal(), whole = own + fleet.between.diagonal().array();
  result.covariance.diagonal().array() +=
      (whole > 0.0)
          .select(2.0 * (own * away.array() / whole.square()).square() / fleet.information.array(), 0.0);
  return result;
}

/// Half the width of an interval that holds one coordinate of a unit with 95 % at least. @param unit  drawn to the fleet by shrink()
inline double reach95(const MixedEffects& fleet, const Estimate& unit, Eigen::Index coordinate) {
  assert(coordinate >= 0 && coordinate < fleet.size());
  return t_quantile(0.05, fleet.between_degrees[coordinate]) *
         std::sqrt(std::max(unit.covariance(coordinate, coordinate), 0.0));
}

/// A range of one coordinate.
struct Range {
  double low = 0.0;   ///< lower end, in the coordinate
  double high = 0.0;  ///< upper end
};

/// The range that a further unit of the fleet falls into with a probability, by Student's t.
inline Range prediction_range(const MixedEffects& fleet, Eigen::Index coordinate, double probability) {
  assert(coordinate >= 0 && coordinate < fleet.size());
  const double reach =
      t_quantile(1.0 - probability, fleet.between_degrees[coordinate]) *
      std::sqrt(fleet.between(coordinate, coordinate) + fleet.mean_covariance(coordinate, coordinate));
  return {fleet.mean[coordinate] - reach, fleet.mean[coordinate] + reach};
}

}  // namespace thermopower::gap::pool
