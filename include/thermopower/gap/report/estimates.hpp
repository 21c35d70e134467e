// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/compare/covariance.hpp>
#include <thermopower/gap/diagnosis.hpp>
#include <thermopower/gap/fit/statistical_model.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

/// @file estimates.hpp
/// The parameters of a fit, and the constants of its model: values, intervals, and correlations.

namespace thermopower::gap::engine {

/// The name of a coordinate in a report: a constant moves by a factor on it, or by an addition to a place.
inline std::string reported_name(const Coordinate& one, bool is_constant) {
  return is_constant ? one.name + (one.logarithmic ? ".scale" : ".shift") : one.name;
}

/// Whether a coordinate of a fit ended on a bound.
inline bool is_at_bound(const Candidate& candidate, std::size_t place) {
  return place < candidate.fit.at_bound.size() && candidate.fit.at_bound[place];
}

/// Values and intervals of an explanation's own parameters. The intervals are those of the fit's coordinate
/// carried over.
inline std::vector<ParameterEstimate> estimates(const Candidate& candidate, const Model& model,
                                                const Covariance& covariance) {
  const std::size_t constants = model.calibrated().size();
  const std::vector<int>& released = candidate.explanation.released;
  assert(constants <= candidate.list.size());
  std::vector<ParameterEstimate> list;
  for (std::size_t i = 0; i < candidate.list.size(); ++i) {
    const Coordinate& one = candidate.list[i];
    const bool is_own =
        i >= constants || std::find(released.begin(), released.end(), static_cast<int>(i)) != released.end();
    if (!is_own || one.still) continue;
    const Interval interval = interval_of(candidate, i, covariance);
    ParameterEstimate& estimate = list.emplace_back();
    estimate.name = reported_name(one, i < constants);
    estimate.value = candidate.value(i);
    estimate.ci95 = {one.value_of(interval.low), one.value_of(interval.high)};
    estimate.unit = one.unit;
    estimate.at_bound = is_at_bound(candidate, i);
    estimate.told = is_narrower(interval, one);
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
inline Eigen::MatrixXd covariance_of_moving(const Candidate& candidate, const Covariance& covariance) {
  if (covariance.of.size() == 0) return {};
  const std::vector<Eigen::Index> places = moving(candidate);
  return covariance.of(places, places);
}

/// Correlation of the estimates of a fit: its covariance, each coordinate in units of its own standard deviation.
inline ParameterCorrelation correlation_of_parameters(const Candidate& candidate,
                                                      const Covariance& covariance, std::size_t constants) {
  ParameterCorrelation correlation;
  const Eigen::MatrixXd of = covariance_of_moving(candidate, covariance);
  if (of.size() == 0) return correlation;
  for (const Eigen::Index at : moving(candidate)) {
    const auto place = static_cast<std::size_t>(at);
    correlation.names.push_back(reported_name(candidate.list[place], place < constants));
  }
  correlation.of = Eigen::MatrixXd::Identity(of.rows(), of.cols());
  for (Eigen::Index i = 0; i < of.rows(); ++i)
    for (Eigen::Index k = 0; k < of.cols(); ++k)
      if (k != i) correlation.of(i, k) = std::clamp(of(i, k) / std::sqrt(of(i, i) * of(k, k)), -1.0, 1.0);
  return correlation;
}

/// The parameters of an explanation's fit.
inline void describe_fit(RankedExplanation& entry, const Candidate& one, const Model& model,
                         const Weight& weight) {
  const Covariance covariance = covariance_of(one, weight);
  entry.parameters = estimates(one, model, covariance);
  entry.covariance = covariance_of_moving(one, covariance);
  entry.fitted.clear();
  entry.fixed.clear();
  for (std::size_t k = 0; k < one.list.size(); ++k) {
    const bool still = one.list[k].still;
    (still ? entry.fixed : entry.fitted)
        .push_back({one.list[k].name, one.fit.point[static_cast<Eigen::Index>(k)], one.list[k].logarithmic,
                    !still && is_at_bound(one, k)});
  }
}

/// Every constant that a fit may move, as configured and as an explanation has it.
inline std::vector<ConstantEstimate> constants_of(const Candidate& candidate, const Model& model,
                                                  const Weight& weight) {
  constexpr double hardly = 0.9;  // of what the file says is known: then the data say nothing of it
  assert(candidate.list.size() >= model.calibrated().size());
  const Covariance covariance = covariance_of(candidate, weight);
  std::vector<ConstantEstimate> list;
  for (const CalibratedConstant& constant : model.calibrated()) {
    const std::size_t place = list.size();
    const Coordinate& one = candidate.list[place];
    ConstantEstimate& entry = list.emplace_back();
    entry.name = constant.id;
    entry.is_place = constant.is_place;
    entry.uncertainty = model.uncertainty_of(constant);
    entry.configured = model.get(constant.block + "." + constant.fields.front());
    const auto moved = [&](double by) { return constant.moved(entry.configured, one.value_of(by)); };
    const double by = candidate.fit.point[static_cast<Eigen::Index>(place)];
    entry.fitted = moved(by);
    entry.ci95 = {entry.fitted, entry.fitted};
    entry.determined = one.upper > one.lower;
    if (!entry.determined) continue;  // it was not fitted
    const Interval interval = interval_of(candidate, place, covariance);
    const auto [low, high] = std::minmax({moved(interval.low), moved(interval.high)});
    entry.ci95 = {low, high};
    entry.determined = interval.high - interval.low < hardly * 2.0 * covariance.quantile * entry.uncertainty;
    entry.on_bound = is_at_bound(candidate, place);
    entry.within_known = std::abs(by) <= known_constants.within * entry.uncertainty * (1.0 + 1e-9);
  }
  return list;
}

}  // namespace thermopower::gap::engine
