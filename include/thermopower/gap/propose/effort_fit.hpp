// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/fit/statistical_model.hpp>
#include <thermopower/gap/propose/effort_residual.hpp>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace thermopower::gap::engine {

/// A coordinate with its prior.
struct BoundedCoordinate {
  EffortCoordinate at;                                      ///< which number of the point moves
  double lower = -std::numeric_limits<double>::infinity();  ///< of the number
  double upper = std::numeric_limits<double>::infinity();   ///< of the number
  bool logarithmic = false;                                 ///< it moves by factors
  bool is_place = false;                                    ///< of a constant: it is off by a difference
  Prior prior;               ///< of a constant's logarithm or place; none of a parameter
  double first_reach = 0.0;  ///< of a constant: standard deviation of where the first step looks for it
};

/// A point fitted to training effort.
struct EffortFit {
  EffortPoint point;               ///< constants and parameters where the fit ended
  double mean_square = 0.0;        ///< of the residuals
  Eigen::VectorXd residual;        ///< at the compared rows
  Eigen::VectorXd standard_error;  ///< by coordinate, of the number itself
  bool found = false;              ///< the equations could be solved
};

/// Fits coordinates to effort: Gauss's and Newton's steps, Levenberg's and Marquardt's damping, constants under the same belief as
/// in every stage.
class EffortFitter {
public:
  /// @param samples_as_one  residuals that count as one
  EffortFitter(const EffortResidual& data, double samples_as_one)
      : data_(data), samples_as_one_(samples_as_one) {}

  /// The sum of squares that one linear step leaves, at some rows: to compare starts by.
  double promise(const EffortPoint& point, const std::vector<BoundedCoordinate>& list) const {
    const EffortResiduals now = data_.glance(point, places(list));
    if (!now.effort.allFinite() || !now.jacobian.allFinite()) return std::numeric_limits<double>::infinity();
    const Normal normal(now.effort, now.jacobian);
    const Eigen::Index n = static_cast<Eigen::Index>(list.size());
    Eigen::VectorXd ridge(n);
    for (Eigen::Index k = 0; k < n; ++k) ridge[k] = 1e-6 * normal.matrix(k, k) + 1e-300;
    const Eigen::VectorXd step = bounded_step(point, list, normal, ridge, Eigen::VectorXd::Zero(n));
    return (now.effort + now.jacobian * step).squaredNorm() *
           (1.0 + static_cast<double>(now.flat) / static_cast<double>(now.effort.size()));
  }

  /// @param loose  the first step may take constants anywhere: they start where nothing has been fitted yet
  EffortFit fit(EffortPoint point, const std::vector<BoundedCoordinate>& list, bool loose) const {
    constexpr int most_steps = 12;
    EffortFit best;
    best.point = point;
    EffortResiduals now = data_.evaluate(point, places(list));
    if (now.effort.size() == 0 || !now.effort.allFinite()) return best;
    const Eigen::Index n = static_cast<Eigen::Index>(list.size());
    best.standard_error = Eigen::VectorXd::Zero(n);
    double damping = 0.0;
    double variance = mean_square(now);
    for (int step = 0; step < most_steps && n > 0; ++step) {
      if (!now.jacobian.allFinite()) return best;
      const double per = 1.0 / variance;
      Normal normal(now.effort, now.jacobian);
      normal.matrix *= per;
      normal.gradient *= per;
      Eigen::VectorXd ridge(n), pull(n);
      for (Eigen::Index k = 0; k < n; ++k) {
        const BoundedCoordinate& one = list[static_cast<std::size_t>(k)];
        const double at = one.at.of(point);
        const double away = one.is_place || !one.at.is_constant ? at : std::log(at);
        const double weight = loose && step == 0 ? loose_weight(one) : one.prior.weight(away);
        const double by = per_number(one, at);
        ridge[k] = weight * by * by + damping * normal.matrix(k, k) + 1e-12 * normal.matrix(k, k) + 1e-300;
        pull[k] = weight * away * by;
      }
      const Eigen::VectorXd move = bounded_step(point, list, normal, ridge, pull);
      EffortPoint next = point;
      for (Eigen::Index k = 0; k < n; ++k) move_by(list[static_cast<std::size_t>(k)], move[k], next);
      EffortResiduals there = data_.evaluate(next, places(list));
      const double cost_now = cost(now, variance, point, list, loose && step == 0),
                   cost_there = cost(there, variance, next, list, loose && step == 0);
      if (!(cost_there <= cost_now + 1e-9)) {
        damping = damping == 0.0 ? 1e-2 : damping * 10.0;
        if (damping > 1e4) break;
        continue;
      }
      damping = damping < 1e-3 ? 0.0 : damping * 0.1;
      point = std::move(next);
      now = std::move(there);
      variance = mean_square(now);
      if (cost_now - cost_there < least_gain_ && step > 0) break;
    }
    best.found = now.effort.allFinite();
    best.point = point;
    best.residual = now.effort;
    best.mean_square = variance;
    if (n > 0 && now.jacobian.allFinite()) set_errors(list, now, best);
    return best;
  }

private:
  static constexpr double least_gain_ = 0.05;  ///< nats: steps that gain less end a fit

  /// J'J and J'e.
  struct Normal {
    Eigen::MatrixXd matrix;
    Eigen::VectorXd gradient;
    Normal(const Eigen::VectorXd& residual, const Eigen::MatrixXd& jacobian)
        : matrix(jacobian.transpose() * jacobian), gradient(jacobian.transpose() * residual) {}
  };

  static std::vector<EffortCoordinate> places(const std::vector<BoundedCoordinate>& list) {
    std::vector<EffortCoordinate> all;
    for (const BoundedCoordinate& one : list) all.push_back(one.at);
    return all;
  }

  /// Change of what the prior is on per change of the number; a factor near 0 is not held there.
  static double per_number(const BoundedCoordinate& one, double at) {
    constexpr double least = 0.1;
    return one.is_place || !one.at.is_constant ? 1.0 : 1.0 / std::max(at, least);
  }

  /// Of a constant in the first step.
  static double loose_weight(const BoundedCoordinate& one) {
    return one.at.is_constant ? 1.0 / (one.first_reach * one.first_reach) : 0.0;
  }

  double mean_square(const EffortResiduals& at) const {
    const double floor = propose_thresholds.least_effort * data_.compared().effort_rms;
    return at.effort.squaredNorm() / static_cast<double>(std::max<Eigen::Index>(1, at.effort.size())) +
           floor * floor;
  }

  double cost(const EffortResiduals& at, double variance, EffortPoint& point,
              const std::vector<BoundedCoordinate>& list, bool loose) const {
    if (!at.effort.allFinite()) return std::numeric_limits<double>::infinity();
    double sum = 0.5 * at.effort.squaredNorm() / variance;
    for (const BoundedCoordinate& one : list) {
      if (!one.at.is_constant) continue;
      const double number = one.at.of(point), away = one.is_place ? number : std::log(number);
      sum += loose ? 0.5 * loose_weight(one) * away * away : 0.5 * one.prior.cost(away);
    }
    // The lost information of a drive that has switched off: log of the spread of effort over that of the residual, a row.
    const double spread = 2.0 * data_.compared().effort_rms;
    sum += static_cast<double>(at.flat) * std::max(0.0, std::log(spread / std::sqrt(variance)));
    return sum;
  }

  /// The step of the damped equations; a number that would leave its bounds stays at the bound.
  static Eigen::VectorXd bounded_step(EffortPoint point, const std::vector<BoundedCoordinate>& list,
                                      const Normal& normal, const Eigen::VectorXd& ridge,
                                      const Eigen::VectorXd& pull) {
    const Eigen::Index n = static_cast<Eigen::Index>(list.size());
    assert(normal.matrix.rows() == n && normal.gradient.size() == n && ridge.size() == n && pull.size() == n);
    Eigen::VectorXd step = Eigen::VectorXd::Zero(n);
    std::vector<bool> held(static_cast<std::size_t>(n), false);
    for (Eigen::Index round = 0; round <= n; ++round) {
      std::vector<Eigen::Index> open;
      for (Eigen::Index k = 0; k < n; ++k)
        if (!held[static_cast<std::size_t>(k)]) open.push_back(k);
      if (open.empty()) break;
      const Eigen::Index m = static_cast<Eigen::Index>(open.size());
      Eigen::MatrixXd matrix(m, m);
      Eigen::VectorXd right(m), scale(m);
      for (Eigen::Index i = 0; i < m; ++i) {
        const Eigen::Index a = open[static_cast<std::size_t>(i)];
        right[i] = -normal.gradient[a] - pull[a];
        for (Eigen::Index k = 0; k < n; ++k)
          if (held[static_cast<std::size_t>(k)]) right[i] -= normal.matrix(a, k) * step[k];
        for (Eigen::Index j = 0; j < m; ++j)
          matrix(i, j) = normal.matrix(a, open[static_cast<std::size_t>(j)]);
        matrix(i, i) += ridge[a];
        scale[i] = 1.0 / std::sqrt(std::max(matrix(i, i), 1e-300));
      }
      matrix = scale.asDiagonal() * matrix * scale.asDiagonal();
      matrix.diagonal().array() += 1e-10;
      const Eigen::VectorXd solved =
          scale.asDiagonal() * Eigen::LDLT<Eigen::MatrixXd>(matrix).solve(scale.asDiagonal() * right);
      bool stays = true;
      for (Eigen::Index i = 0; i < m; ++i) {
        const Eigen::Index a = open[static_cast<std::size_t>(i)];
        const BoundedCoordinate& one = list[static_cast<std::size_t>(a)];
        const double at = one.at.of(point);
        assert(one.lower <= one.upper);
        step[a] = solved[i];
        const double bounded = std::clamp(at + step[a], one.lower, one.upper);
        if (bounded == at + step[a]) continue;
        step[a] = bounded - at;
        held[static_cast<std::size_t>(a)] = true;
        stays = false;
      }
      if (stays) break;
    }
    return step;
  }

  /// Moves a number; one that is known by order of magnitude by no more than a factor of e.
  static void move_by(const BoundedCoordinate& one, double step, EffortPoint& point) {
    double& number = one.at.of(point);
    if (one.logarithmic) {
      constexpr double farthest = 1.0;  // of the logarithm
      const double by = step > 0.0 ? std::min(step / number, farthest) : std::max(step / number, -farthest);
      number *= std::exp(by);
    } else {
      number += step;
    }
    number = std::clamp(number, one.lower, one.upper);
  }

  void set_errors(const std::vector<BoundedCoordinate>& list, const EffortResiduals& now,
                  EffortFit& best) const {
    const Eigen::Index n = static_cast<Eigen::Index>(list.size());
    Normal normal(now.effort, now.jacobian);
    normal.matrix *= 1.0 / (best.mean_square * samples_as_one_);
    for (Eigen::Index k = 0; k < n; ++k) {
      const BoundedCoordinate& one = list[static_cast<std::size_t>(k)];
      const double at = one.at.of(best.point), by = per_number(one, at);
      const double away = one.is_place || !one.at.is_constant ? at : std::log(at);
      normal.matrix(k, k) += one.prior.weight(away) * by * by + 1e-9 * normal.matrix(k, k) + 1e-300;
    }
    const Eigen::VectorXd scale = normal.matrix.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd scaled = scale.asDiagonal() * normal.matrix * scale.asDiagonal();
    const Eigen::MatrixXd inverse =
        Eigen::LDLT<Eigen::MatrixXd>(scaled).solve(Eigen::MatrixXd::Identity(n, n));
    for (Eigen::Index k = 0; k < n; ++k)
      best.standard_error[k] = scale[k] * std::sqrt(std::max(0.0, inverse(k, k)));
  }

  const EffortResidual& data_;
  const double samples_as_one_;
};

}  // namespace thermopower::gap::engine
