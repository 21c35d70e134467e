// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/linear_solve.hpp>
#include <thermopower/gap/data/matrix_product.hpp>
#include <thermopower/gap/decide/evidence.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>

/// @file covariance.hpp
/// What the data leave open of a fit's parameters, and whether their parts agree about them.

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
  // A fit leans towards each of its blocks, which then pulls less than a new one would: as much less, on average, as there
  // are parameters for each block (the jackknife's correction, HC3 of MacKinnon & White 1985). Neighbouring blocks of
  // long correlation are alike: they count as one in part.
  const double leaning = blocks / free;
  covariance.of = transposed_product(inverse, transposed_product(candidate.fit.scatter, inverse)) *
                  (leaning * leaning * (1.0 + longest / block_samples));
  for (Eigen::Index i = 0; i < covariance.of.rows(); ++i)
    covariance.of(i, i) = std::max(covariance.of(i, i), inverse(i, i));
  const double z = 1.96;
  covariance.quantile = z + (z * z * z + z) / (4.0 * free);  // Student's t (Cornish & Fisher)
  return covariance;
}

/// Whether the blocks of the training data agree about what the effects of a candidate are like: the standard deviation of
/// each parameter that was looked for, by how much the blocks differ, is a small share of it (of the factor that it may be
/// off by, where it is known by its order of magnitude). A parameter on a bound is not asked about, nor is a detail of a
/// shape.
inline bool is_agreed_upon(const Candidate& candidate, const Model& model, const Weight& weight) {
  const Covariance covariance = covariance_of(candidate, weight);
  if (covariance.of.size() == 0) return true;
  std::size_t at = model.calibrated().size();
  for (const CatalogueEntry* entry : candidate.explanation.effects)
    for (const Parameter& parameter : entry->info.parameters) {
      const std::size_t place = at++;
      if (parameter.standard || candidate.list[place].still || candidate.fit.at_bound[place]) continue;
      const auto i = static_cast<Eigen::Index>(place);
      const double sd = std::sqrt(std::max(covariance.of(i, i), 0.0));
      const double value = candidate.list[place].logarithmic ? 1.0 : std::abs(candidate.fit.point[i]);
      if (sd > decision.size_known * value) return false;
    }
  return true;
}

}  // namespace thermopower::gap::engine
