// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/actuator/duty.hpp>
#include <thermopower/gap/data/robust.hpp>
#include <thermopower/gap/data/sample_masks.hpp>
#include <thermopower/gap/data/segments.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
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

}  // namespace thermopower::gap::engine
