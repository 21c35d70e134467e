// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

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
  double promise(const EffortPoint& point, const std::vector<EffortCoordinate>& list) const {
    const EffortResiduals now = data_.glance(point, list);
    if (!now.effort.allFinite() || !now.jacobian.allFinite()) return std::numeric_limits<double>::infinity();
    const Normal normal(now, 1.0);
    const Eigen::VectorXd ridge = (1e-6 * normal.matrix.diagonal()).array() + 1e-300;
    const Eigen::VectorXd step =
        bounded_step(point, list, normal, ridge, Eigen::VectorXd::Zero(ridge.size()));
    return (now.effort + now.jacobian * step).squaredNorm() *
           (1.0 + now.flat() / static_cast<double>(now.effort.size()));
  }

  /// @param loose  the first step may take constants anywhere: they start where nothing has been fitted yet
  EffortFit fit(EffortPoint point, const std::vector<EffortCoordinate>& list, bool loose) const {
    constexpr int most_steps = 12;
    constexpr double least_gain = 0.05;  // nats: steps that gain less end a fit
    EffortFit best;
    best.point = point;
    EffortResiduals now = data_.evaluate(point, list);
    if (now.effort.size() == 0 || !now.effort.allFinite()) return best;
    const Eigen::Index n = static_cast<Eigen::Index>(list.size());
    best.standard_error = Eigen::VectorXd::Zero(n);
    double damping = 0.0;
    double variance = mean_square(now);
    for (int step = 0; step < most_steps && n > 0; ++step) {
      if (!now.jacobian.allFinite()) return best;
      const bool is_loose = loose && step == 0;
      const Normal normal(now, 1.0 / variance);
      Eigen::VectorXd ridge(n), pull(n);
      for (Eigen::Index k = 0; k < n; ++k) {
        const EffortCoordinate& one = list[static_cast<std::size_t>(k)];
        const double at = one.of(point), away = one.away(at), by = one.away_per_number(at);
        const double weight = is_loose ? loose_weight(one) : one.prior.weight(away);
        ridge[k] = weight * by * by + damping * normal.matrix(k, k) + 1e-12 * normal.matrix(k, k) + 1e-300;
        pull[k] = weight * away * by;
      }
      const Eigen::VectorXd move = bounded_step(point, list, normal, ridge, pull);
      EffortPoint next = point;
      for (Eigen::Index k = 0; k < n; ++k) move_by(list[static_cast<std::size_t>(k)], move[k], next);
      EffortResiduals there = data_.evaluate(next, list);
      const double cost_now = cost(now, variance, point, list, is_loose),
                   cost_there = cost(there, variance, next, list, is_loose);
      if (!(cost_there <= cost_now + 1e-9)) {
        damping = damping == 0.0 ? 1e-2 : damping * 10.0;
        if (damping > 1e4) break;
        continue;
      }
      damping = damping < 1e-3 ? 0.0 : damping * 0.1;
      point = std::move(next);
      now = std::move(there);
      variance = mean_square(now);
      if (cost_now - cost_there < least_gain && step > 0) break;
    }
    best.found = now.effort.allFinite();
    best.point = point;
    best.residual = now.effort;
    best.mean_square = variance;
    if (n > 0 && now.jacobian.allFinite()) set_errors(list, now, best);
    return best;
  }

private:
  /// J'J and J'e, times a factor.
  struct Normal {
    Eigen::MatrixXd matrix;
    Eigen::VectorXd gradient;
    Normal(const EffortResiduals& of, double times)
        : matrix(of.jacobian.transpose() * of.jacobian), gradient(of.jacobian.transpose() * of.effort) {
      matrix *= times;
      gradient *= times;
    }
  };

  /// Of a coordinate in the first step.
  static double loose_weight(const EffortCoordinate& one) {
    return one.is_constant ? 1.0 / (one.first_reach * one.first_reach) : 0.0;
  }

  double mean_square(const EffortResiduals& at) const {
    const double floor = propose_thresholds.least_effort * data_.compared().effort_rms;
    return at.effort.squaredNorm() / static_cast<double>(at.effort.size()) + floor * floor;
  }

  double cost(const EffortResiduals& at, double variance, EffortPoint& point,
              const std::vector<EffortCoordinate>& list, bool loose) const {
    if (!at.effort.allFinite()) return std::numeric_limits<double>::infinity();
    double sum = 0.5 * at.effort.squaredNorm() / variance;
    for (const EffortCoordinate& one : list) {
      if (!one.is_constant) continue;
      const double away = one.away(one.of(point));
      sum += loose ? 0.5 * loose_weight(one) * away * away : 0.5 * one.prior.cost(away);
    }
    // The lost information of a drive that has switched off: log of the spread of effort over that of the residual, a row.
    const double spread = 2.0 * data_.compared().effort_rms;
    return sum + at.flat() * std::max(0.0, std::log(spread / std::sqrt(variance)));
  }

  /// The step of the damped equations; a number that would leave its bounds stays at the bound.
  static Eigen::VectorXd bounded_step(EffortPoint point, const std::vector<EffortCoordinate>& list,
                                      const Normal& normal, const Eigen::VectorXd& ridge,
                                      const Eigen::VectorXd& pull) {
    const Eigen::Index n = static_cast<Eigen::Index>(list.size());
    assert(normal.matrix.rows() == n && normal.gradient.size() == n && ridge.size() == n && pull.size() == n);
    Eigen::VectorXd step = Eigen::VectorXd::Zero(n);
    std::vector<Eigen::Index> open, held;
    for (Eigen::Index k = 0; k < n; ++k) open.push_back(k);
    for (bool stays = false; !stays && !open.empty();) {
      const Eigen::Index m = static_cast<Eigen::Index>(open.size());
      Eigen::MatrixXd matrix = normal.matrix(open, open);
      Eigen::VectorXd right(m);
      for (Eigen::Index i = 0; i < m; ++i) {
        const Eigen::Index a = open[static_cast<std::size_t>(i)];
        right[i] = -normal.gradient[a] - pull[a];
        for (const Eigen::Index k : held) right[i] -= normal.matrix(a, k) * step[k];
        matrix(i, i) += ridge[a];
      }
      const Eigen::VectorXd scale = inverse_roots(matrix.diagonal());
      matrix = scale.asDiagonal() * matrix * scale.asDiagonal();
      matrix.diagonal().array() += 1e-10;
      const Eigen::VectorXd solved =
          scale.asDiagonal() * Eigen::LDLT<Eigen::MatrixXd>(matrix).solve(scale.asDiagonal() * right);
      stays = true;
      std::vector<Eigen::Index> inside;
      for (Eigen::Index i = 0; i < m; ++i) {
        const Eigen::Index a = open[static_cast<std::size_t>(i)];
        const EffortCoordinate& one = list[static_cast<std::size_t>(a)];
        const double at = one.of(point);
        assert(one.lower <= one.upper);
        step[a] = solved[i];
        const double bounded = std::clamp(at + step[a], one.lower, one.upper);
        stays = stays && bounded == at + step[a];
        (bounded == at + step[a] ? inside : held).push_back(a);
        if (bounded != at + step[a]) step[a] = bounded - at;
      }
      open = std::move(inside);
      std::sort(held.begin(), held.end());
    }
    return step;
  }

  static Eigen::VectorXd inverse_roots(const Eigen::VectorXd& values) {
    return values.cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  }

  /// Moves a number; one that is known by order of magnitude by no more than a factor of e.
  static void move_by(const EffortCoordinate& one, double step, EffortPoint& point) {
    double& number = one.of(point);
    if (one.logarithmic) {
      constexpr double farthest = 1.0;  // of the logarithm
      const double by = step > 0.0 ? std::min(step / number, farthest) : std::max(step / number, -farthest);
      number *= std::exp(by);
    } else {
      number += step;
    }
    number = std::clamp(number, one.lower, one.upper);
  }

  void set_errors(const std::vector<EffortCoordinate>& list, const EffortResiduals& now,
                  EffortFit& best) const {
    const Eigen::Index n = static_cast<Eigen::Index>(list.size());
    Eigen::MatrixXd matrix = Normal(now, 1.0 / (best.mean_square * samples_as_one_)).matrix;
    for (Eigen::Index k = 0; k < n; ++k) {
      const EffortCoordinate& one = list[static_cast<std::size_t>(k)];
      const double at = one.of(best.point), by = one.away_per_number(at);
      matrix(k, k) += one.prior.weight(one.away(at)) * by * by + 1e-9 * matrix(k, k) + 1e-300;
    }
    const Eigen::VectorXd scale = inverse_roots(matrix.diagonal());
    const Eigen::MatrixXd scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
    const Eigen::MatrixXd inverse =
        Eigen::LDLT<Eigen::MatrixXd>(scaled).solve(Eigen::MatrixXd::Identity(n, n));
    for (Eigen::Index k = 0; k < n; ++k)
      best.standard_error[k] = scale[k] * std::sqrt(std::max(0.0, inverse(k, k)));
  }

  const EffortResidual& data_;
  const double samples_as_one_;
};

}  // namespace thermopower::gap::engine
