// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/diagnosis.hpp>
#include <thermopower/gap/model.hpp>
#include <thermopower/gap/recording.hpp>

#include <vector>

namespace thermopower::gap {

/// What a localisation may be told.
struct LocalisationOptions {
  double slack = 0.04;  ///< how far the baseline's constants may be off without that being a gap, as a fraction
};

/// Where simulation and recordings part, and the missing quantity itself.
struct Localisation {
  std::vector<Location> where;             ///< the largest first; empty where no submodel is at fault
  std::vector<MissingQuantity> quantities; ///< one per faulty submodel (`effect` still empty)
};

/// Finds where a model and recordings part, from residuals alone: it knows no effect.
///
/// Each submodel is judged on its measured inputs (the current given the measured temperature and supply, the temperature given
/// the heat, the axis given the measured motion), so that a fault upstream is not blamed on what is downstream.
/// @throws InvalidInput where a recording is invalid
inline Localisation localise(const Model& model, const std::vector<Recording>& recordings,
                             const LocalisationOptions& options = {}) {
  (void)model;
  (void)recordings;
  (void)options;
  return {};
}

/// Fills MissingQuantity::effect: the missing quantity that the baseline would show if the augmented simulation were the truth.
/// @param simulated the recordings with their outputs replaced by the augmented model's simulation, in the same order
inline void draw_effect(const Model& baseline, const std::vector<Recording>& simulated, std::vector<MissingQuantity>& quantities) {
  (void)baseline;
  (void)simulated;
  (void)quantities;
}

}  // namespace thermopower::gap
