// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/diagnosis.hpp>
#include <thermopower/gap/model.hpp>
#include <thermopower/gap/recording.hpp>
#include <thermopower/plant/standard_catalogue.hpp>
#include <thermopower/io/names.hpp>

#include <map>
#include <string>
#include <vector>

namespace thermopower::io {

/// @brief A recording whose runs have a start for everything that the model can predict from its inputs.
///
/// What was not measured starts at the air's temperature and at rest, what `starts` names (by column, in the
/// column's unit) at that value; rows other than a run's first stay missing.
Recording with_starts(Recording recording, const Model& model, const std::map<std::string, double>& starts);

/// @brief Predictions as CSV: `t_s`, `run` where there is more than one run, then `<signal>_baseline` and
/// `<signal>_augmented` for each signal that could be simulated, one row per row of the recordings, in their
/// order. Empty cells are values that could not be simulated (before the first measured start, for instance).
/// Numbers read back bit by bit.
///
/// @param horizon_s length of the windows in which the axis runs freely, in s
/// @param catalogue  knows the effects of both models
/// @throws InputError where no recording has what any law of the models needs
std::string predictions_csv(const Model& baseline, const Model& augmented,
                            const std::vector<Recording>& recordings, double horizon_s,
                            const Catalogue& catalogue = standard_catalogue());

/// The predictions of a diagnosis, as its gap was measured: restarted where the check cut the recordings, from the states
/// that it believes. A cell is empty at a row that it left out.
/// @param model      that was diagnosed
/// @param diagnosis  where it simulated nothing, as the data cannot be believed, the recordings are taken as they are
/// @param held_out   as they were given to the diagnosis, one after the other
/// @param horizon_s  length of an axis' windows
/// @param catalogue  knows the effects
/// @throws InputError where no signal can be predicted
std::string predictions_csv(const Model& model, const Diagnosis& diagnosis,
                            const std::vector<Recording>& held_out, double horizon_s,
                            const Catalogue& catalogue = standard_catalogue());

}  // namespace thermopower::io
