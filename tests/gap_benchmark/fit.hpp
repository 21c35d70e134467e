// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace gap_benchmark {

/// One number a fit may move, with its bounds and the values to start from.
struct Free {
  int index;
  double from, to;
  std::vector<double> starts;
};

/// Residuals of a model at given parameter values, in units of the noise.
using Residuals = std::function<Eigen::VectorXd(const std::vector<double>&)>;

struct Fit {
  std::vector<double> values;
  double sum_of_squares = 0.0;
};

/// Bounded Levenberg-Marquardt with one-sided differences, inside the unit box. Slow, plain, and good enough
/// to ask how well one cause can pass for another.
inline Fit fit(const Residuals& residuals, const std::vector<Free>& free, std::vector<double> values,
               int iterations, double enough = 0.0) {
  const auto n = static_cast<Eigen::Index>(free.size());
  Eigen::VectorXd r = residuals(values);
  Fit best{values, r.squaredNorm()};
  double damping = 1e-3;
  for (int round = 0; round < iterations && n > 0; ++round) {
    Eigen::MatrixXd jacobian(r.size(), n);
    for (Eigen::Index j = 0; j < n; ++j) {
      const Free& f = free[static_cast<std::size_t>(j)];
      const double h = 1e-4 * (f.to - f.from);
      auto aside = best.values;
      double& value = aside[static_cast<std::size_t>(j)];
      const double at = value;
      value = at + h <= f.to ? at + h : at - h;
      jacobian.col(j) = (residuals(aside) - r) * ((f.to - f.from) / (value - at));
    }
    const Eigen::MatrixXd normal = jacobian.transpose() * jacobian;
    const Eigen::VectorXd gradient = jacobian.transpose() * r;
    bool moved = false;
    const double before = best.sum_of_squares;
    for (int attempt = 0; attempt < 7 && !moved; ++attempt) {
      Eigen::MatrixXd damped = normal;
      damped.diagonal() +=
          damping * normal.diagonal() + Eigen::VectorXd::Constant(n, 1e-12 * normal.trace() + 1e-300);
      // A number that leans on its bound and wants to go further is held there, or it drags the others along.
      for (Eigen::Index j = 0; j < n; ++j) {
        const Free& f = free[static_cast<std::size_t>(j)];
        const double at = best.values[static_cast<std::size_t>(j)];
        if ((at <= f.from && gradient(j) > 0.0) || (at >= f.to && gradient(j) < 0.0)) {
          damped.row(j).setZero();
          damped.col(j).setZero();
          damped(j, j) = 1e300;
        }
      }
      const Eigen::VectorXd step = damped.ldlt().solve(-gradient);
      auto candidate = best.values;
      for (Eigen::Index j = 0; j < n; ++j) {
        const Free& f = free[static_cast<std::size_t>(j)];
        double& value = candidate[static_cast<std::size_t>(j)];
        value = std::clamp(value + step(j) * (f.to - f.from), f.from, f.to);
      }
      Eigen::VectorXd trial = residuals(candidate);
      const double sum = trial.squaredNorm();
      if (std::isfinite(sum) && sum < best.sum_of_squares) {
        best = {candidate, sum};
        r = std::move(trial);
        damping = std::max(1e-9, damping * 0.2);
        moved = true;
      } else {
        damping *= 8.0;
      }
    }
    if (!moved || best.sum_of_squares <= enough || before - best.sum_of_squares < 2e-3 * before) break;
  }
  return best;
}

/// The best fit from the two best combinations of the listed starting values.
/// @param seed a further start, or empty
inline Fit fit_from_best_starts(const Residuals& residuals, const std::vector<Free>& free,
                                const std::vector<double>& seed, int iterations, double enough = 0.0) {
  std::vector<std::pair<double, std::vector<double>>> starts;
  std::vector<std::size_t> choice(free.size(), 0);
  for (std::size_t j = 0; j <= free.size();) {
    std::vector<double> values;
    for (std::size_t i = 0; i < free.size(); ++i)
      values.push_back(std::clamp(free[i].starts[choice[i]], free[i].from, free[i].to));
    starts.emplace_back(0.0, values);
    j = 0;
    while (j < free.size() && ++choice[j] == free[j].starts.size()) choice[j++] = 0;
    if (j == free.size()) break;
  }
  if (!seed.empty()) starts.emplace_back(0.0, seed);
  if (starts.size() > 2)
    for (auto& start : starts) start.first = residuals(start.second).squaredNorm();
  std::sort(starts.begin(), starts.end());
  starts.resize(std::min<std::size_t>(2, starts.size()));
  Fit best;
  for (std::size_t i = 0; i < starts.size(); ++i) {
    const Fit candidate = fit(residuals, free, starts[i].second, iterations, enough);
    if (i == 0 || candidate.sum_of_squares < best.sum_of_squares) best = candidate;
    if (best.sum_of_squares <= enough) break;
  }
  return best;
}

}  // namespace gap_benchmark
