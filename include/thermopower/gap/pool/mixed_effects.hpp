// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/pool/distributions.hpp>

#include <Eigen/Cholesky>
#include <Eigen/Core>

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
  Eigen::VectorXd between_error;  ///< by coordinate: variance of the error of `between`'s diagonal
  Eigen::VectorXd degrees;        ///< by coordinate: degrees of freedom of the mean's error (Satterthwaite)
  /// By coordinate: those that the spread itself is known to, in units of the most precise estimate's variance. With few
  /// or imprecise units there are few, and what rests on the spread says so by being wide.
  Eigen::VectorXd between_degrees;

  /// How many coordinates there are.
  Eigen::Index size() const { return mean.size(); }
};

/// A unit's own value after the fleet was looked at: the less precise it is, the more it is drawn to the mean.
struct Shrunken {
  Eigen::VectorXd at;          ///< the best prediction of the unit's own values
  Eigen::MatrixXd covariance;  ///< of its error, that of the mean included
};

/// Fits the spread of units. Estimates must have one size and finite numbers.
inline MixedEffects fit_mixed_effects(const std::vector<Estimate>& units) {
  constexpr int most = 200;
  constexpr double settled = 1e-5;  // largest relative change of the spread in one iteration
  MixedEffects result;
  result.units = units.size();
  if (units.size() < 2) return result;
  const Eigen::Index k = units.front().at.size();
  const double count = static_cast<double>(units.size());
  assert(std::all_of(units.begin(), units.end(), [k](const Estimate& one) { return one.at.size() == k; }));
  // Begins at the spread of the estimates themselves.
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(k);
  for (const Estimate& one : units) mean += one.at / count;
  Eigen::MatrixXd between = Eigen::MatrixXd::Zero(k, k);
  for (const Estimate& one : units) between += (one.at - mean) * (one.at - mean).transpose() / (count - 1.0);
  // Where all are equal there is nothing to iterate on, and nothing to divide by.
  for (Eigen::Index i = 0; i < k; ++i) between(i, i) += 1e-12 * (1.0 + mean[i] * mean[i]);
  // Nor does a spread fall below what numbers of that size resolve.
  const Eigen::VectorXd rounding = (1e-24 * (1.0 + mean.array().square())).matrix();
  std::vector<Eigen::MatrixXd> weights(units.size());
  Eigen::MatrixXd error;
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
    const Eigen::MatrixXd step = between * push * between / count;
    between += step;
    between = 0.5 * (between + between.transpose()).eval();
    between.diagonal() = between.diagonal().cwiseMax(rounding).eval();
    double change = 0.0;
    for (Eigen::Index i = 0; i < k; ++i)
      change = std::max(change, std::abs(step(i, i)) / std::max(between(i, i), 1e-300));
    if (change < settled) break;
  }
  weigh();
  assert(!(between.diagonal().array() < 0.0).any());
  result.mean = mean;
  result.mean_covariance = error;
  result.between = between;
  result.heterogeneity_p = result.between_error = result.degrees = result.between_degrees =
      Eigen::VectorXd::Zero(k);
  for (Eigen::Index i = 0; i < k; ++i) {
    double weight = 0.0, weighted = 0.0, q = 0.0, squares = 0.0, sum = 0.0, largest = 0.0;
    for (const Estimate& one : units) {
      const double w = 1.0 / std::max(one.covariance(i, i), 1e-300);
      weight += w;
      weighted += w * one.at[i];
      const double whole = 1.0 / (one.covariance(i, i) + between(i, i));
      squares += whole * whole;
      sum += whole;
      largest = std::max(largest, whole);
    }
    for (const Estimate& one : units) {
      const double away = one.at[i] - weighted / weight;
      q += away * away / std::max(one.covariance(i, i), 1e-300);
    }
    result.heterogeneity_p[i] = chi2_tail(q, count - 1.0);
    result.between_error[i] = 2.0 / squares;
    result.degrees[i] = std::max(1.0, sum * sum / squares - 1.0);
    result.between_degrees[i] = std::max(1.0, squares / (largest * largest) - 1.0);
  }
  return result;
}

/// A unit's own values, given its estimate and the fleet it is one of. That the spread is an estimate, too, widens their
/// errors (Morris 1983; here coordinate by coordinate).
inline Shrunken shrink(const MixedEffects& fleet, const Estimate& unit) {
  const Eigen::Index k = fleet.size();
  assert(unit.at.size() == k && unit.covariance.rows() == k && unit.covariance.cols() == k);
  const Eigen::MatrixXd gain = fleet.between * inverse_of(unit.covariance + fleet.between);
  const Eigen::MatrixXd rest = Eigen::MatrixXd::Identity(k, k) - gain;
  Shrunken result;
  result.at = fleet.mean + gain * (unit.at - fleet.mean);
  result.covariance = fleet.between - gain * fleet.between + rest * fleet.mean_covariance * rest.transpose();
  for (Eigen::Index i = 0; i < k; ++i) {
    const double own = unit.covariance(i, i), whole = own + fleet.between(i, i);
    const double by_spread = own / (whole * whole) * (unit.at[i] - fleet.mean[i]);
    if (whole > 0.0) result.covariance(i, i) += by_spread * by_spread * fleet.between_error[i];
  }
  return result;
}

/// Half the width of an interval that holds one coordinate of a unit with 95 % at least.
inline double reach95(const MixedEffects& fleet, const Shrunken& unit, Eigen::Index coordinate) {
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
