// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/bell_regression.hpp>
#include <thermopower/gap/data/robust.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

/// @file heat_scale.hpp
/// How large the numbers of a bench's columns are against what its laws say of them, whatever effect a simulation lacks.

namespace thermopower::gap::engine {

/// Thresholds of what counts as told about the size of a bench's columns.
/// Held by tests/gap/data/scale_test.cpp.
struct HeatScaleThresholds {
  std::size_t shortest = 2;         ///< intervals of the shortest bell
  std::size_t longest = 2048;       ///< of the longest
  std::size_t least_windows = 24;   ///< of a regression
  double heating = 0.6;             ///< correlation of heat and rate of warming beside the loss
  double losing = 0.35;             ///< the same of the loss beside the heat
  double significance = 3.0;        ///< standard errors that each is from 0
  double of_largest = 0.1;          ///< of the largest expected current: smaller ones are not compared
  std::size_t least_currents = 20;  ///< that are compared
  double spread = 2.0;  ///< of the 90th by the 10th percentile: one factor fits all that differ by no more
};

/// By how much the warming follows heat and loss: 1 each where capacity and loss are the model's.
struct WarmingTold {
  ToldCoefficient heat;  ///< of what the heat warms the body by
  ToldCoefficient loss;  ///< of what the loss cools it by
  double offset_K =
      0.0;  ///< by how much warmer than the recorded one the air is to which the body cools down

  /// Whether both are told.
  bool is_told() const {
    constexpr HeatScaleThresholds limit;
    return heat.partial > limit.heating && loss.partial > limit.losing && heat.value > 0.0 &&
           loss.value > 0.0 && heat.significance() > limit.significance &&
           loss.significance() > limit.significance;
  }
};

/// A body's heat balance at the rows of a recording.
struct WarmingRows {
  const Eigen::VectorXd& t_s;        ///< stamps
  const std::vector<RunSpan>& runs;  ///< rows between which time passes
  const Eigen::VectorXd& body_C;     ///< measured
  Eigen::VectorXd heating_K_per_s;   ///< heat by capacity
  Eigen::VectorXd cooling_K_per_s;   ///< loss by capacity
  double relaxation_per_s = 0.0;     ///< conductance by capacity
};

/// The rate of warming regressed on what heat and loss should make it, by the bells that tell both best.
inline WarmingTold regress_warming(const WarmingRows& rows) {
  constexpr HeatScaleThresholds limit;
  WarmingTold best;
  const ReadRows read(rows.t_s, rows.runs, rows.body_C);
  for (std::size_t length = limit.shortest; length <= limit.longest; length *= 2) {
    KeptRegression regression;
    read.for_each_bell(length, [&](const std::vector<ReadRows::Part>& parts) {
      Eigen::VectorXd terms = Eigen::VectorXd::Zero(3);
      double response = 0.0;
      for (const ReadRows::Part& one : parts) {
        response += one.weight * (rows.body_C[one.next] - rows.body_C[one.row]);
        for (Eigen::Index row = one.row; row < one.next; ++row) {
          const double step_s = rows.t_s[row + 1] - rows.t_s[row];
          terms[0] += one.weight * step_s * rows.heating_K_per_s[row];
          terms[1] -= one.weight * step_s * rows.cooling_K_per_s[row];
        }
        terms[2] += one.weight * one.step_s;
      }
      regression.add(terms, response);
    });
    if (regression.rows() < limit.least_windows) continue;
    const std::vector<ToldCoefficient> told = regression.solve();
    if (told.empty()) continue;
    if (std::min(told[0].partial, told[1].partial) <= std::min(best.heat.partial, best.loss.partial))
      continue;
    best = {told[0], told[1], 0.0};
    const double by_air_per_s = told[1].value * rows.relaxation_per_s;
    best.offset_K = by_air_per_s != 0.0 ? told[2].value / by_air_per_s : 0.0;
  }
  return best;
}

/// Measured by expected: its median over the rows where something is expected, and how far single rows are from it.
struct FactorTold {
  double value = missing;  ///< NaN: too few rows
  double low = missing;    ///< 10th percentile
  double high = missing;   ///< 90th percentile

  /// Whether one factor fits all rows.
  bool is_one() const {
    const double least = std::min(std::abs(low), std::abs(high)),
                 most = std::max(std::abs(low), std::abs(high));
    return low * high > 0.0 && most < HeatScaleThresholds().spread * least;
  }
};

/// The factor between two columns of as many rows.
inline FactorTold factor_of(const Eigen::VectorXd& measured, const Eigen::VectorXd& expected) {
  constexpr HeatScaleThresholds limit;
  constexpr double low = 0.1, high = 0.9;
  double most = 0.0;
  for (const double value : expected)
    if (std::isfinite(value)) most = std::max(most, std::abs(value));
  std::vector<double> factors;
  for (Eigen::Index i = 0; i < expected.size(); ++i)
    if (std::isfinite(measured[i]) && std::abs(expected[i]) > limit.of_largest * most)
      factors.push_back(measured[i] / expected[i]);
  if (factors.size() < limit.least_currents) return {};
  FactorTold told;
  told.value = median_of(factors);
  told.low = quantile_of(factors, low);
  told.high = quantile_of(factors, high);
  return told;
}

}  // namespace thermopower::gap::engine
