// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>

#include <array>
#include <cstddef>

namespace thermopower::plant {

/// Heat that the nodes of a body exchange with each other and lose to what surrounds them: the stiff and linear part of
/// their equations, as a step of a Rosenbrock method takes it.
///
/// The method is ROS2 of Verwer, Spee, Blom and Hundsdorfer (1999), eq. 1.2, with gamma = 1 - 1/sqrt(2):
///
///     (1 - gamma h J) k1 = f(x)
///     (1 - gamma h J) k2 = f(x + h k1) - 2 k1
///     x(h) = x + h (3 k1 + k2) / 2
///
/// It is of second order with any J, so that what J does not know (a resistance that follows the temperature, radiation)
/// costs no accuracy; and with the right J an exchange as fast as one likes dies away in one step (L-stable).
/// @tparam most  nodes that a body may have
///
/// @snippet plant_examples.cpp network step
/// How to: @ref gap_method.
template <class Scalar, std::size_t most>
class NetworkStep {
public:
  /// A temperature, or a slope, of each node; those beyond the count are not used.
  using Nodes = std::array<Scalar, most>;

  /// Nodes that exchange nothing yet. @param count  of them, 1..most
  explicit NetworkStep(std::size_t count) : count_(count) {
    for (auto& row : matrix_)
      for (Scalar& one : row) one = constant<Scalar>(0.0);
  }

  /// Lets two nodes exchange heat.
  /// @param a_per_s  relative to the heat capacity of `a`, >= 0
  /// @param b_per_s  the same conductance, relative to that of `b`, >= 0
  void link(std::size_t a, std::size_t b, const Scalar& a_per_s, const Scalar& b_per_s) {
    matrix_[a][a] -= a_per_s;
    matrix_[a][b] += a_per_s;
    matrix_[b][b] -= b_per_s;
    matrix_[b][a] += b_per_s;
  }

  /// Lets a node lose heat to something whose temperature is given. @param per_s  relative to its heat capacity, >= 0
  void lose(std::size_t node, const Scalar& per_s) { matrix_[node][node] -= per_s; }

  /// Sets the length of the step, > 0. The matrix is dominated by its diagonal: it is eliminated without a search for
  /// pivots.
  void set_length(double h_s) {
    constexpr double gamma = 0.29289321881345247560;  // 1 - 1/sqrt(2)
    for (std::size_t i = 0; i < count_; ++i)
      for (std::size_t k = 0; k < count_; ++k) {
        eliminated_[i][k] = matrix_[i][k] * (-gamma * h_s);
        if (i == k) eliminated_[i][k] += 1.0;
      }
    for (std::size_t pivot = 0; pivot < count_; ++pivot) {
      per_pivot_[pivot] = 1.0 / eliminated_[pivot][pivot];
      for (std::size_t i = pivot + 1; i < count_; ++i) {
        eliminated_[i][pivot] *= per_pivot_[pivot];
        for (std::size_t k = pivot + 1; k < count_; ++k)
          eliminated_[i][k] -= eliminated_[i][pivot] * eliminated_[pivot][k];
      }
    }
  }

  /// Solves (1 - gamma h J) k = `right`, in whose place k is.
  void solve(Nodes& right) const {
    for (std::size_t i = 1; i < count_; ++i)
      for (std::size_t k = 0; k < i; ++k) right[i] -= eliminated_[i][k] * right[k];
    for (std::size_t i = count_; i-- > 0;) {
      for (std::size_t k = i + 1; k < count_; ++k) right[i] -= eliminated_[i][k] * right[k];
      right[i] *= per_pivot_[i];
    }
  }

  /// The same for who keeps `right`.
  Nodes solved(Nodes right) const {
    solve(right);
    return right;
  }

private:
  std::size_t count_;
  std::array<std::array<Scalar, most>, most> matrix_, eliminated_;
  Nodes per_pivot_;  ///< inverse pivots
};

}  // namespace thermopower::plant
