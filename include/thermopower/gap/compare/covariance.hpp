// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/linear_solve.hpp>
#include <thermopower/gap/data/matrix_product.hpp>
#include <thermopower/gap/compare/evidence.hpp>
#include <thermopower/gap/diagnosis.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

/// @file covariance.hpp
/// The uncertainty of a fit's parameters, and whether the parts of the data agree about them.

namespace thermopower::gap::engine {

/// Covariance of a fit's coordinates, and the quantile that makes 95 % intervals of it.
struct Covariance {
  Eigen::MatrixXd of;      ///< in the fit's coordinates
  double quantile = 1.96;  ///< two-sided, 95 %
};

/// The factor by which noise with memory enlarges the standard deviation of a sum of blocks. For a process of first order
/// it is sqrt((1 + r) / (1 - r)), with the correlation r of neighbours. Blocks that pull against their neighbours are
/// chance.
/// @param pulls  on one coordinate, block after block
inline double remembered_by_blocks(const Eigen::VectorXd& pulls) {
  constexpr double most = 0.9;  // beyond, the blocks say no more than that they are all one
  const Eigen::Index count = pulls.size();
  const double square = pulls.squaredNorm();
  if (count < 5 || !(square > 0.0)) return 1.0;
  const double seen = pulls.head(count - 1).dot(pulls.tail(count - 1)) / square;
  // Of pulls that add up to nothing it comes out smaller by (1 + 4 r) / n (Marriott & Pope 1954).
  const double n = static_cast<double>(count), r = std::clamp((seen * n + 1.0) / (n - 4.0), 0.0, most);
  return std::sqrt((1.0 + r) / (1.0 - r));
}

/// The covariance that the data's blocks show (the sandwich of White 1982, clustered). It measures how much the pull on the
/// parameters differs between contiguous blocks. The reason may be noise, its correlation, or a model that is a little
/// wrong. At least that of the noise alone. With few blocks the noise's, widened with the residuals' level and correlation.
/// Of a fit whose curvature nobody looked at nothing is known: `of` is 0 by 0.
///
/// A wrong prior pulls, too. The fit lets a prior count for as many samples as make one, which adds no knowledge of the
/// constant. If only the prior knows a direction, its own standard deviation remains.
inline Covariance covariance_of(const Candidate& candidate, const Weight& weight) {
  constexpr int fewest_blocks = 12;  // below, the blocks themselves say little
  const FitResult& fit = candidate.fit;
  if (fit.information.size() == 0) return {};
  assert(fit.information.rows() == static_cast<Eigen::Index>(candidate.list.size()) &&
         fit.information.cols() == fit.information.rows());
  // Each coordinate is in the unit in which the data resolve it. Otherwise a direction that only the prior knows would be
  // taken for rounding beside a parameter that is known to a millionth of its unit.
  Eigen::VectorXd unit = fit.information.diagonal();
  for (double& one : unit) one = one > 0.0 ? 1.0 / std::sqrt(one) : 1.0;
  const LeastSquares scaled(scaled_both_ways(fit.information, unit));
  Eigen::MatrixXd inverse(unit.size(), unit.size());
  for (Eigen::Index k = 0; k < unit.size(); ++k)
    inverse.col(k) = unit[k] * scaled.solve(Eigen::VectorXd::Unit(unit.size(), k)).cwiseProduct(unit);
  // H^-1 of the whole is that of the data's curvature and of the priors', both between the same inverses.
  assert((fit.priors.size() == 0 || fit.priors.rows() == unit.size()) &&
         (fit.pulls.cols() == 0 || fit.pulls.rows() == unit.size()));
  Eigen::MatrixXd by_priors = Eigen::MatrixXd::Zero(unit.size(), unit.size());
  if (fit.priors.size() > 0) by_priors = inverse * fit.priors * inverse.transpose();
  const Eigen::MatrixXd by_noise = inverse - by_priors;
  by_priors *= fit.per_prior;
  const double inflation = inflation_of(candidate, weight);
  const double blocks = static_cast<double>(fit.pulls.cols()),
               free = blocks - static_cast<double>(candidate.list.size());
  Covariance covariance;
  if (blocks < fewest_blocks || free < 0.5 * fewest_blocks) {
    covariance.of = by_noise * inflation + by_priors;
    return covariance;
  }
  // A fit leans towards each of its blocks, which then pulls less than a new one would. The correction is that of the
  // jackknife (HC3 of MacKinnon & White 1985): as many parameters as there are for each block.
  const double leaning = blocks / free;
  Eigen::MatrixXd moves(unit.size(), fit.pulls.cols());  // of the coordinates, by each block
  for (Eigen::Index k = 0; k < moves.rows(); ++k) {
    moves.row(k) = (inverse.row(k) * fit.pulls);
    moves.row(k) *= leaning * remembered_by_blocks(moves.row(k).transpose());
  }
  covariance.of = moves * moves.transpose() + by_priors;
  for (Eigen::Index i = 0; i < covariance.of.rows(); ++i)
    covariance.of(i, i) = std::max(covariance.of(i, i), by_noise(i, i) + by_priors(i, i));
  const double z = 1.96;
  covariance.quantile = z + (z * z * z + z) / (4.0 * free);  // Student's t (Cornish & Fisher)
  return covariance;
}

/// The 95 % interval of a coordinate, in its own numbers and within its range. It is the whole range if moving the
/// coordinate so far changes nothing, such as a friction's transition that no sample fell into.
inline Interval interval_of(const Candidate& candidate, std::size_t place, const Covariance& covariance) {
  assert(place < candidate.list.size());
  const Coordinate& one = candidate.list[place];
  assert(one.lower <= one.upper);
  const double range = one.upper - one.lower;
  const auto at = static_cast<Eigen::Index>(place);
  const bool says_nothing =
      covariance.of.size() == 0 || candidate.fit.information(at, at) * range * range < 1.0;
  const double value = candidate.fit.point[at],
               reach = says_nothing ? range
                                    : covariance.quantile * std::sqrt(std::max(covariance.of(at, at), 0.0));
  return {std::max(value - reach, one.lower), std::min(value + reach, one.upper)};
}

/// Whether the data narrow the range of a coordinate by a tenth at least. @param interval  its interval_of()
inline bool is_narrower(const Interval& interval, const Coordinate& one) {
  constexpr double hardly = 0.9;
  return interval.high - interval.low < hardly * (one.upper - one.lower);
}

/// Whether a fit looked for a parameter as an effect's own: it is not a detail of a shape, and moved.
inline bool was_looked_for(const Parameter& parameter, const Coordinate& one) {
  return !parameter.standard && !one.still;
}

/// Marks explanations with a cause of which the data leave a size open, so that it stands for something simpler; the order of
/// magnitude of a length or a time counts where it has no size. And those of which a cause may be absent: the 95 % intervals of all
/// its sizes hold the value without it, or it is no more than a constant that moved. Two that do the same from opposite sides (a
/// friction that differs by direction, and a constant torque) are told by their sum alone. Details of a shape are not asked. An
/// interval is one of a valley that is straight. If the set without the cause was fitted and is far behind, the cause is there,
/// whatever the length of the valley along which it trades with a constant.
inline void mark_doubtful(std::vector<Candidate>& candidates, const Model& model, const Weight& weight) {
  const auto is_far_behind = [&](const Candidate& part, const Candidate& set) {
    double behind = misfit_of(part.train, weight.correlation) - misfit_of(set.train, weight.correlation);
    // On held-out data a start that nobody measures may do what a cause does not.
    if (part.hidden_starts == 0 && set.hidden_starts == 0)
      behind += misfit_of(part.held_out, weight.held_out) - misfit_of(set.held_out, weight.held_out);
    return behind > decision.missed_from;
  };
  const auto is_missed = [&](const Candidate& set, const CatalogueEntry* entry) {
    return std::any_of(candidates.begin(), candidates.end(), [&](const Candidate& part) {
      return part.held_out.any() && part.explanation.size() + 1 == set.explanation.size() &&
             set.explanation.includes(part.explanation) &&
             std::find(part.explanation.effects.begin(), part.explanation.effects.end(), entry) ==
                 part.explanation.effects.end() &&
             is_far_behind(part, set);
    });
  };
  for (Candidate& one : candidates) {
    one.open = one.doubtful = false;
    if (one.explanation.effects.empty() || !one.held_out.any()) continue;
    const Covariance covariance = covariance_of(one, weight);
    if (covariance.of.size() == 0) continue;
    std::size_t at = model.calibrated().size();
    for (const CatalogueEntry* entry : one.explanation.effects) {
      const SpecialCase in_fact = special_case(one, entry->info, at);
      bool has_a_size = false, is_there = false, are_sizes_told = true, are_orders_told = true;
      for (const Parameter& parameter : entry->info.parameters) {
        const std::size_t place = at++;
        if (!was_looked_for(parameter, one.list[place])) continue;
        const Interval interval = interval_of(one, place, covariance);
        bool& are_told = parameter.logarithmic ? are_orders_told : are_sizes_told;
        are_told = are_told && is_narrower(interval, one.list[place]);
        if (parameter.logarithmic) continue;
        has_a_size = true;
        is_there = is_there || parameter.absent_at < interval.low || parameter.absent_at > interval.high;
      }
      const bool is_a_constant = in_fact.the_same && plant::is_calibration(in_fact.cause);
      one.open = one.open || !(has_a_size ? are_sizes_told : are_orders_told);
      one.doubtful = one.doubtful || is_a_constant || (has_a_size && !is_there && !is_missed(one, entry));
    }
  }
}

}  // namespace thermopower::gap::engine
