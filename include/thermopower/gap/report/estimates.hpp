// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/compare/covariance.hpp>
#include <thermopower/gap/diagnosis.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

/// @file estimates.hpp
/// The parameters of a fit: values, intervals, and correlations.

namespace thermopower::gap::engine {

/// The name of a constant's move in a report: a factor on it, or an addition to a place.
inline std::string name_of_move(const Coordinate& constant) {
  return constant.name + (constant.logarithmic ? ".scale" : ".shift");
}

/// Values and intervals of an explanation's own parameters. The intervals are those of the fit's coordinate
/// carried over.
inline std::vector<ParameterEstimate> estimates(const Candidate& candidate, const Model& model,
                                                const Weight& weight) {
  const Covariance covariance = covariance_of(candidate, weight);
  const std::size_t constants = model.calibrated().size();
  assert(constants <= candidate.list.size());
  std::vector<ParameterEstimate> list;
  for (std::size_t i = 0; i < candidate.list.size(); ++i) {
    const Coordinate& one = candidate.list[i];
    const bool released =
        std::find(candidate.explanation.released.begin(), candidate.explanation.released.end(),
                  static_cast<int>(i)) != candidate.explanation.released.end();
    if ((i < constants && !released) || one.still) continue;
    const Interval interval = interval_of(candidate, i, covariance);
    assert(i < candidate.fit.at_bound.size());
    ParameterEstimate estimate;
    estimate.name = i < constants ? name_of_move(one) : one.name;
    estimate.value = candidate.value(i);
    estimate.ci95 = {one.value_of(interval.low), one.value_of(interval.high)};
    estimate.unit = one.unit;
    estimate.at_bound = candidate.fit.at_bound[i];
    estimate.told = is_narrower(interval, one);
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
  assert(all.rows() == static_cast<Eigen::Index>(candidate.list.size()) && all.cols() == all.rows());
  const std::vector<Eigen::Index> places = moving(candidate);
  const Eigen::Index n = static_cast<Eigen::Index>(places.size());
  Eigen::MatrixXd some(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index k = 0; k < n; ++k)
      some(i, k) = all(places[static_cast<std::size_t>(i)], places[static_cast<std::size_t>(k)]);
  return some;
}

/// Correlation of the estimates of a fit: its covariance, each coordinate in units of its own standard deviation.
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
    correlation.names.push_back(place < constants ? name_of_move(candidate.list[place])
                                                  : candidate.list[place].name);
    for (Eigen::Index k = 0; k < n; ++k)
      if (k != i)
        correlation.of(i, k) =
            std::clamp(covariance(i, k) / std::sqrt(covariance(i, i) * covariance(k, k)), -1.0, 1.0);
  }
  return correlation;
}

}  // namespace thermopower::gap::engine
