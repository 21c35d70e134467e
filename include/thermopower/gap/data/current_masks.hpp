// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/robust.hpp>
#include <thermopower/gap/data/sample_masks.hpp>
#include <thermopower/gap/data/segments.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

/// @file current_masks.hpp
/// Samples of a current that are not to be believed at the power that drives it.

namespace thermopower::gap::engine {

/// The runs cut wherever the power steps.
inline std::vector<RunSpan> steady_runs(const Eigen::VectorXd& power, const std::vector<RunSpan>& runs) {
  RowMask starts(static_cast<std::size_t>(power.size()), 0);
  for (Eigen::Index i = 1; i < power.size(); ++i)
    starts[static_cast<std::size_t>(i)] = std::isfinite(power[i]) && power[i] != power[i - 1] ? 1 : 0;
  return cut_at(runs, starts, true);
}

/// Exact zeros of the current at a power at which current flows otherwise.
inline RowMask lost_current(const Eigen::VectorXd& current_A, const Eigen::VectorXd& power, double scale_A) {
  constexpr double clearly = 10.0, mostly = 0.5;  // noise scales of a current that flows; share of its rows
  constexpr int bands = 26;                       // of ten counts
  std::vector<std::vector<double>> flowing(bands);
  const auto band = [](double counts) {
    return static_cast<std::size_t>(std::clamp(counts / 10.0, 0.0, 25.0));
  };
  RowMask mask(static_cast<std::size_t>(current_A.size()), 0);
  for (Eigen::Index i = 0; i < current_A.size(); ++i)
    if (power[i] > 0.0 && std::isfinite(current_A[i])) flowing[band(power[i])].push_back(current_A[i]);
  std::vector<double> typical(bands, 0.0);
  for (std::size_t k = 0; k < flowing.size(); ++k) {
    const auto zeros = std::count(flowing[k].begin(), flowing[k].end(), 0.0);
    if (static_cast<double>(zeros) > mostly * static_cast<double>(flowing[k].size())) continue;
    typical[k] = std::abs(quantile_of(flowing[k], 0.25));
  }
  for (Eigen::Index i = 0; i < current_A.size(); ++i)
    if (power[i] > 0.0 && current_A[i] == 0.0 && typical[band(power[i])] > clearly * std::max(scale_A, 1e-12))
      mask[static_cast<std::size_t>(i)] = 1;
  return mask;
}

}  // namespace thermopower::gap::engine
