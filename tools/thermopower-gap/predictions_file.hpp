// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/model.hpp>
#include <thermopower/gap/recording.hpp>

#include <string>
#include <vector>

namespace thermopower::gap::files {

/// @brief Predictions as CSV: `t_s`, `run` where there is more than one run, then `<signal>_baseline` and
/// `<signal>_augmented` for each signal that could be simulated, one row per row of the recordings, in their
/// order. Empty cells are values that could not be simulated (before the first measured start, for instance).
/// Numbers read back bit by bit.
///
/// @param horizon_s length of the windows in which the axis runs freely, in s
std::string predictions_csv(const Model& baseline, const Model& augmented,
                            const std::vector<Recording>& recordings, double horizon_s);

}  // namespace thermopower::gap::files
