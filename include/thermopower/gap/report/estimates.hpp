// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/linear_solve.hpp>
#include <thermopower/gap/data/matrix_product.hpp>
#include <thermopower/gap/decide/evidence.hpp>
#include <thermopower/gap/diagnosis.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

/// @file estimates.hpp
/// What a fit says of its parameters: values, intervals, and how they hang together.

namespace thermopower::gap::engine {

/// Covariance of a fit's coordinates, and the quantile that makes 95 % intervals of it.
struct Covariance {
  Eigen::MatrixXd of;      ///< in the fit's coordinates
  double quantile = 1.96;  ///< two-sided, 95 %
};

/// The covariance that the data's blocks show (the sandwich of White 1982, clustered): how much the pull on the
/// parameters differs between contiguous blocks, whatever the reason, noise, its correlation, or a model that is a
/// little wrong. At least that of the noise alone. With few blocks the noise's, widened with the residuals' level
/// and correlation. Of a fit whose curvature nobody looked at nothing is known: `of` is 0 by 0.
inline Covariance covariance_of(const Candidate& candidate, const Weight& weight) {
  constexpr int fewest_blocks = 12;      // below, the blocks themselves say little
  constexpr double block_samples = 120;  // of a long run, as the fitter cuts it
  if (candidate.fit.information.size() == 0) return {};
  // Each coordinate in the unit that the data resolve it in: beside a parameter that is known to a millionth of its
  // unit, what only the prior knows would be taken for rounding, and its share of the intervals would be lost.
  Eigen::VectorXd unit = candidate.fit.information.diagonal();
  for (double& one : unit) one = one > 0.0 ? 1.0 / std::sqrt(one) : 1.0;
  const LeastSquares scaled(scaled_both_ways(candidate.fit.information, unit));
  Eigen::MatrixXd inverse(unit.size(), unit.size());
  for (Eigen::Index k = 0; k < unit.size(); ++k)
    inverse.col(k) = unit[k] * scaled.solve(Eigen::VectorXd::Unit(unit.size(), k)).cwiseProduct(unit);
  double inflation = 1.0, longest = 1.0;
  for (std::size_t i = 0; i < signal_count; ++i)
    if (candidate.train.samples[i] > 0.0) {
      inflation = std::max(inflation, candidate.train.mean(i) * weight.correlation[i]);
      longest = std::max(longest, weight.correlation[i]);
    }
  const double blocks = candidate.fit.blocks, free = blocks - static_cast<double>(candidate.list.size());
  Covariance covariance;
  if (candidate.fit.blocks < fewest_blocks || free < 0.5 * fewest_blocks) {
    covariance.of = inverse * inflation;
    return covariance;
  }
  // Neighbouring blocks of long correlation are alike: they count as one in part.
  covariance.of = transposed_product(inverse, transposed_product(candidate.fit.scatter, inverse)) *
                  (blocks / free * (1.0 + longest / block_samples));
  for (Eigen::Index i = 0; i < covariance.of.rows(); ++i)
    covariance.of(i, i) = std::max(covariance.of(i, i), inverse(i, i));
  const double z = 1.96;
  covariance.quantile = z + (z * z * z + z) / (4.0 * free);  // Student's t (Cornish & Fisher)
  return covariance;
}

/// Values and intervals of an explanation's own parameters. The intervals are those of the fit's coordinate
/// carried over.
inline std::vector<ParameterEstimate> estimates(const Candidate& candidate, const Model& model,
                                                const Weight& weight) {
  const Covariance covariance = covariance_of(candidate, weight);
  const std::size_t constants = model.calibrated().size();
  std::vector<ParameterEstimate> list;
  for (std::size_t i = 0; i < candidate.list.size(); ++i) {
    const Coordinate& one = candidate.list[i];
    const bool released =
        std::find(candidate.explanation.released.begin(), candidate.explanation.released.end(),
                  static_cast<int>(i)) != candidate.explanation.released.end();
    if ((i < constants && !released) || one.still) continue;
    const Eigen::Index at = static_cast<Eigen::Index>(i);
    const double value = candidate.fit.at[at],
                 reach = covariance.of.size() == 0
                             ? one.upper - one.lower
                             : covariance.quantile * std::sqrt(std::max(covariance.of(at, at), 0.0));
    ParameterEstimate estimate;
    estimate.name = i < constants ? one.name + ".scale" : one.name;
    estimate.value = one.value_of(value);
    estimate.ci95 = {one.value_of(std::max(value - reach, one.lower)),
                     one.value_of(std::min(value + reach, one.upper))};
    estimate.unit = one.unit;
    estimate.at_bound = candidate.fit.at_bound[i];
    list.push_back(std::move(estimate));
  }
  return list;
}

/// The coordinates of a candidate that its fit could move.
inline std::vector<Eigen::Index> moving(const Candidate& candidate) {
  std::vector<Eigen::Index> places;
  for (std::size_t i = 0; i < candidate.list.size(); ++i)
    if (!candidate.list[i].still) places.push_back(static_cast<Eigen::Index>(i));
  return places;
}

/// The covariance of the coordinates that the fit could move; 0 by 0 where nothing is known.
inline Eigen::MatrixXd covariance_of_moving(const Candidate& candidate, const Weight& weight) {
  const Eigen::MatrixXd all = covariance_of(candidate, weight).of;
  if (all.size() == 0) return all;
  const std::vector<Eigen::Index> places = moving(candidate);
  const Eigen::Index n = static_cast<Eigen::Index>(places.size());
  Eigen::MatrixXd some(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index k = 0; k < n; ++k)
      some(i, k) = all(places[static_cast<std::size_t>(i)], places[static_cast<std::size_t>(k)]);
  return some;
}

/// How the estimates of a fit hang together: its covariance, each coordinate in units of its own standard deviation.
inline ParameterCorrelation correlation_of_parameters(const Candidate& candidate, const Weight& weight,
                                                      std::size_t constants) {
  ParameterCorrelation correlation;
  const Eigen::MatrixXd covariance = covariance_of_moving(candidate, weight);
  const std::vector<Eigen::Index> places = moving(candidate);
  const Eigen::Index n = covariance.rows();
  if (n != static_cast<Eigen::Index>(places.size())) return correlation;
  correlation.of = Eigen::MatrixXd::Identity(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto place = static_cast<std::size_t>(places[static_cast<std::size_t>(i)]);
    correlation.names.push_back(candidate.list[place].name + (place < constants ? ".scale" : ""));
    for (Eigen::Index k = 0; k < n; ++k)
      if (k != i)
        correlation.of(i, k) =
            std::clamp(covariance(i, k) / std::sqrt(covariance(i, i) * covariance(k, k)), -1.0, 1.0);
  }
  return correlation;
}

}  // namespace thermopower::gap::engine
