// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/compare/score.hpp>

#include <Eigen/Core>

#include <cassert>
#include <cmath>

namespace thermopower::gap::engine {

/// Probabilities of explanations from their log predictive densities of held-out blocks: pseudo-BMA+ with the Bayesian
/// bootstrap (Yao, Vehtari, Simpson & Gelman 2018). Few blocks, or blocks that disagree, leave the probabilities spread out.
/// @param density  one row an explanation, one column a block, in nats
/// @param prior    log prior weight of each explanation
/// @return         one an explanation; they sum to 1
inline Eigen::VectorXd bootstrap_weights(const Eigen::MatrixXd& density, const Eigen::VectorXd& prior) {
  constexpr int draws = 400;
  assert(density.rows() == prior.size() && density.cols() > 0);
  const Eigen::Index blocks = density.cols();
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(density.rows());
  Dice dice(3);
  for (int draw = 0; draw < draws; ++draw) {
    Eigen::VectorXd share(blocks);  // of a Dirichlet distribution, all parameters 1
    for (Eigen::Index k = 0; k < blocks; ++k) share[k] = -std::log(1.0 - dice.share());
    share *= static_cast<double>(blocks) / share.sum();
    Eigen::VectorXd total = density * share + prior;
    total = (total.array() - total.maxCoeff()).exp();
    sum += total / total.sum();
  }
  assert(!(std::abs(sum.sum() / draws - 1.0) > 1e-9));  // each draw's weights sum to 1
  return sum / draws;
}

}  // namespace thermopower::gap::engine
