// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/propose/inverse_score.hpp>
#include <thermopower/gap/propose/thresholds.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

/// @file weighed_score.hpp
/// Which of two scores of the inverse problem is the better one, and when the difference matters.

namespace thermopower::gap::engine {

/// How many parameters of its effects were fitted.
inline int parameter_count(const InverseScore& score) {
  return static_cast<int>(std::count_if(score.parameters.begin(), score.parameters.end(),
                                        [](const InverseEstimate& one) { return one.fitted; }));
}

/// The share of held-out effort that a score leaves, times a price for each parameter.
inline double weighed(const InverseScore& score) {
  return score.share * (1.0 + propose_thresholds.per_parameter * parameter_count(score));
}

/// Whether a set lowers held-out effort by a share that matters, and by more than chance over blocks.
inline bool is_material(const InverseScore& before, const InverseScore& after) {
  if (after.share > (1.0 - propose_thresholds.least_reduction) * before.share) return false;
  if (after.share > before.share - propose_thresholds.least_share) return false;
  const std::size_t n = after.block_gain.size();
  assert(before.block_gain.size() >= n);
  Eigen::VectorXd gain(static_cast<Eigen::Index>(n));
  for (std::size_t b = 0; b < n; ++b)
    gain[static_cast<Eigen::Index>(b)] = after.block_gain[b] - before.block_gain[b];
  if (n < 2) return gain.size() == 1 && gain[0] > 0.0;
  const double mean = gain.mean(),
               error = std::sqrt((gain.array() - mean).square().sum() / static_cast<double>(n * (n - 1)));
  return mean >= propose_thresholds.least_deviations * error && mean > 0.0;
}

}  // namespace thermopower::gap::engine
